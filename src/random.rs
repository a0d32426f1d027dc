//! Reproducible random numbers: equal on every machine and for any number of threads.
//!
//! ```
//! use whiskmap::random::RandomStream;
//!
//! let mut drawn = RandomStream::new(1, 0);
//! let mut again = RandomStream::new(1, 0);
//! assert_eq!(drawn.normal(), again.normal());
//! ```

use std::f64::consts::TAU;

/// Stream of random numbers, made by SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
#[derive(Clone, Debug)]
pub struct RandomStream {
    state: u64,
}

impl RandomStream {
    /// Creates the stream of random numbers of a `seed` and a `sample`.
    #[must_use]
    pub const fn new(seed: u64, sample: u64) -> Self {
        Self::of_state(mixed(mixed(seed).wrapping_add(sample)))
    }

    /// Creates the stream of random numbers that SplitMix64 makes from a state.
    #[must_use]
    pub const fn of_state(state: u64) -> Self {
        Self { state }
    }

    /// Returns a uniform random number of at least 0 and less than 1.
    pub fn uniform(&mut self) -> f64 {
        self.bits() as f64 / STEPS
    }

    /// Returns a normal random number of mean 0 and standard deviation 1, by the method of Box and Muller (Ann. Math. Stat. 29, 610,
    /// 1958).
    pub fn normal(&mut self) -> f64 {
        // The first is in (0, 1], whose logarithm is finite.
        let [radius, turn] = [1.0, 0.0].map(|shift| (self.bits() as f64 + shift) / STEPS);
        (-2.0 * libm::log(radius)).sqrt() * libm::cos(TAU * turn)
    }

    /// 53 random bits.
    fn bits(&mut self) -> u64 {
        let bits = hash(self.state);
        self.state = self.state.wrapping_add(INCREMENT);
        bits >> 11
    }
}

/// Increment of the state of SplitMix64: 2^64 over the golden ratio.
const INCREMENT: u64 = 0x9e37_79b9_7f4a_7c15;

/// Number of values of 53 bits.
const STEPS: f64 = (1_u64 << 53) as f64;

/// Returns the hash of a number: the bits that SplitMix64 makes from this state.
pub(crate) const fn hash(state: u64) -> u64 {
    mixed(state.wrapping_add(INCREMENT))
}

/// Mixes bits, so that each depends on all others.
const fn mixed(bits: u64) -> u64 {
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the published generator with the state 1234567.
    #[test]
    fn the_bits_are_those_of_splitmix64() {
        let mut stream = RandomStream::of_state(1_234_567);
        let expected = [6_457_827_717_110_365_317_u64, 3_203_168_211_198_807_973];
        assert_eq!(expected.map(|bits| bits >> 11), [stream.bits(), stream.bits()]);
    }

    /// Moments of 100,000 numbers, within five of their standard errors.
    #[test]
    fn the_numbers_are_normal() {
        const COUNT: u64 = 100_000;
        let numbers: Vec<f64> = (0..COUNT).map(|i| RandomStream::new(1, i).normal()).collect();
        for (power, expected, variance) in
            [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)]
        {
            let moment = numbers.iter().map(|x| x.powi(power)).sum::<f64>() / COUNT as f64;
            let error = (variance / COUNT as f64).sqrt();
            assert!((moment - expected).abs() < 5.0 * error, "{power}: {moment}");
        }
    }
}
