//! Summary of all values of a heat map for its colour scale, gathered in one pass and little memory.

/// Fraction of the positive values below the start of a logarithmic scale: small values may span many powers of ten.
const BELOW_START: f64 = 0.01;

/// Bits of an `f32` below those that choose its bin: the ends of a bin differ by less than 1 %.
const WITHIN_BIN: u32 = 16;

/// Extent and distribution of the values of a heat map. [`Extend`] adds values.
#[derive(Clone, Debug)]
pub struct ValueSummary {
    /// Smallest and largest finite value of the heat map, in the unit of the values; `None` without finite values.
    pub(super) extent: Option<[f64; 2]>,
    /// Smallest and largest finite value above 0 of the heat map; `None` without positive values.
    pub(super) positive: Option<[f64; 2]>,
    /// Number of finite values of the heat map that are at most 0.
    pub(super) not_positive: u64,
    /// True if the heat map has values that are not finite.
    pub(super) has_blanks: bool,
    /// Positive values by their leading bits.
    bins: Vec<u64>,
}

impl Default for ValueSummary {
    fn default() -> Self {
        Self {
            extent: None,
            positive: None,
            not_positive: 0,
            has_blanks: false,
            bins: vec![0; 1 << (u32::BITS - 1 - WITHIN_BIN)],
        }
    }
}

impl Extend<f64> for ValueSummary {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, values: I) {
        for value in values {
            if !value.is_finite() {
                self.has_blanks = true;
                continue;
            }
            widen(&mut self.extent, value);
            if value > 0.0 {
                widen(&mut self.positive, value);
                // The bits of positive numbers grow with them.
                let bin = (value as f32).to_bits() >> WITHIN_BIN;
                self.bins[bin as usize] += 1;
            } else {
                self.not_positive += 1;
            }
        }
    }
}

fn widen(extent: &mut Option<[f64; 2]>, value: f64) {
    let [low, high] = extent.unwrap_or([value; 2]);
    *extent = Some([low.min(value), high.max(value)]);
}

impl ValueSummary {
    /// Returns the 1st percentile of the positive values, rounded down by less than 1 %, and how many values are below it; 0 if there are
    /// none.
    pub(super) fn positive_start(&self) -> (f64, u64) {
        let all: u64 = self.bins.iter().sum();
        let most = BELOW_START * all as f64;
        let mut below = 0;
        let bin = self.bins.iter().position(|count| {
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
    use super::ValueSummary;

    #[test]
    fn a_hundredth_of_the_positive_values_lies_below_the_start() {
        assert_eq!(ValueSummary::default().positive_start(), (0.0, 0));
        for (count, expected) in [(3, 1.0), (100, 1.0), (1000, 10.0), (100_000, 1000.0)] {
            let mut summary = ValueSummary::default();
            summary.extend((-5..=count).map(f64::from));
            let (start, below) = summary.positive_start();
            assert!(start <= expected && start > 0.99 * expected, "{count}: {start}");
            assert!(below as f64 <= 0.01 * f64::from(count), "{count}: {below}");
        }
        let mut outlier = ValueSummary::default();
        outlier.extend(std::iter::once(1e-32).chain([2.0; 100]));
        assert_eq!(outlier.positive_start(), (2.0, 1));
    }
}
