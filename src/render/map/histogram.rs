//! Positive values counted by size, to find a percentile of many values in little memory.

/// Part of the positive values below the start of a logarithmic scale: values next to first touch span many powers of ten.
const BELOW_START: f64 = 0.01;

/// Bits of an `f32` below those that choose its bin: the ends of a bin differ by less than 1 %.
const WITHIN_BIN: u32 = 16;

/// Counts of positive values, in bins of equal leading bits.
pub(super) struct Histogram(Vec<u64>);

impl Default for Histogram {
    fn default() -> Self {
        Self(vec![0; 1 << (u32::BITS - 1 - WITHIN_BIN)])
    }
}

impl Histogram {
    /// Counts a value, which is above 0.
    pub(super) fn add(&mut self, value: f64) {
        // The bits of positive numbers grow with them.
        let bin = (value as f32).to_bits() >> WITHIN_BIN;
        self.0[bin as usize] += 1;
    }

    /// The 1st percentile, rounded down by less than 1 %, and how many values are below it; 0 if no value is counted.
    pub(super) fn start(&self) -> (f64, u64) {
        let all: u64 = self.0.iter().sum();
        let most = BELOW_START * all as f64;
        let mut below = 0;
        let bin = self.0.iter().position(|count| {
            let is_reached = *count > 0 && (below + count) as f64 >= most;
            below += if is_reached { 0 } else { *count };
            is_reached
        });
        let bits = bin.unwrap_or_default() << WITHIN_BIN;
        (f64::from(f32::from_bits(bits as u32)), below)
    }
}

#[cfg(test)]
mod tests {
    use super::Histogram;

    #[test]
    fn a_hundredth_of_the_values_lies_below_the_start() {
        assert_eq!(Histogram::default().start(), (0.0, 0));
        for (count, expected) in [(3, 1.0), (100, 1.0), (1000, 10.0), (100_000, 1000.0)] {
            let mut histogram = Histogram::default();
            (1..=count).for_each(|value| histogram.add(f64::from(value)));
            let (start, below) = histogram.start();
            assert!(
                start <= expected && start > 0.99 * expected,
                "{count}: {start}"
            );
            assert!(below as f64 <= 0.01 * f64::from(count), "{count}: {below}");
        }
        let mut outlier = Histogram::default();
        outlier.add(1e-32);
        (0..100).for_each(|_| outlier.add(2.0));
        assert_eq!(outlier.start(), (2.0, 1));
    }
}
