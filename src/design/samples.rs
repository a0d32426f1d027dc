//! Sample values of the range of a design's parameter.

/// Number of sample values of the range of the only parameter of a design.
pub const SAMPLES: usize = 128;

/// Ratio of the ends of a range of positive numbers above which half of the samples are logarithmic.
const WIDE: f64 = 10.0;

/// Returns `count` sample values of a parameter in growing order, `[sample]`, in its unit, with both ends of the range. The samples are evenly
/// spaced; in a wide range of positive numbers, half of the samples are evenly spaced in the logarithm.
pub fn samples([low, high]: [f64; 2], count: usize) -> Vec<f64> {
    let even = |count: usize| {
        (0..count).map(move |i| match i {
            0 => low,
            _ if i == count - 1 => high,
            _ => low + (high - low) * (i as f64 / (count - 1) as f64),
        })
    };
    if !is_wide([low, high]) {
        return even(count).collect();
    }
    let half = count / 2;
    // The even samples have the ends.
    let inner = (1..=half).map(|i| low * libm::pow(high / low, i as f64 / (half + 1) as f64));
    let mut values: Vec<f64> = even(count - half).chain(inner).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// Returns true for a range `[low, high]` of positive numbers that spans more than a factor of 10.
#[must_use]
pub fn is_wide([low, high]: [f64; 2]) -> bool {
    low > 0.0 && high > WIDE * low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_grow_from_end_to_end() {
        for range in [[0.0, 1.0], [-200.0, 35.0], [1e-6, 1e4], [5e-11, 0.5], [1.0, 2.0]] {
            let values = samples(range, SAMPLES);
            assert_eq!([values[0], values[SAMPLES - 1]], range);
            assert!(values.is_sorted_by(|a, b| a < b), "{range:?}");
        }
        let wide = samples([1e-3, 1e3], SAMPLES);
        let steps = wide.windows(2).map(|pair| pair[1] / pair[0]);
        assert!(steps.fold(0.0, f64::max) < 1.25);
    }
}
