//! What the processor could do at best: nothing but fused multiply-adds, in as many chains as hide their latency and fit
//! into the registers.

use super::{Lanes, SimdTask, WIDTH};
use std::hint::black_box;

/// Multiplies and adds `rounds` times in every chain, and tells how many operations that were: with a clock, the peak of one
/// thread.
#[derive(Clone, Copy, Debug)]
pub struct MultiplyAndAdd {
    /// How often.
    pub rounds: u32,
}

impl SimdTask for MultiplyAndAdd {
    type Output = u64;

    #[inline(always)]
    fn run<T: Lanes>(self) -> u64 {
        match T::LANES {
            16 => chains::<T, 8>(self.rounds),
            1 => chains::<T, 16>(self.rounds),
            _ => chains::<T, 6>(self.rounds),
        }
    }
}

#[inline(always)]
fn chains<T: Lanes, const CHAINS: usize>(rounds: u32) -> u64 {
    let start = black_box([1.0; WIDTH]);
    let (factor, term) = (T::of(black_box(0.999_999)), T::of(black_box(1e-6)));
    let mut chains: [T; CHAINS] = std::array::from_fn(|_| T::pack(start));
    for _ in 0..rounds {
        for chain in &mut chains {
            *chain = chain.mul_add(factor, term);
        }
    }
    for chain in chains {
        black_box(chain.unpack());
    }
    2 * (CHAINS * T::LANES) as u64 * u64::from(rounds)
}
