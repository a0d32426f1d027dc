//! Medians and quantiles.

/// Returns the median, 0 without values; of an even number of values, the larger one of the two in the middle.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

/// Returns the quantile by linear interpolation between neighbours of the `sorted` values: the first value is the quantile of 0, the last
/// value the quantile of 1 (definition 7 of Hyndman and Fan, Am. Stat. 50, 361, 1996).
pub fn quantile(sorted: &[f64], part: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = part * last as f64;
    let below = (place as usize).min(last);
    let above = sorted[(below + 1).min(last)];
    Some(sorted[below] + (place - below as f64) * (above - sorted[below]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values that `numpy.quantile` gives.
    #[test]
    fn quantiles_are_linear_between_neighbours() {
        let values = [1.0, 2.0, 4.0, 8.0, 16.0];
        let parts = [0.05, 0.25, 0.5, 0.75, 0.95];
        let expected = [1.2, 2.0, 4.0, 8.0, 14.4].map(Some);
        for (part, expected) in parts.into_iter().zip(expected) {
            let both = quantile(&values, part).zip(expected);
            assert!(both.is_some_and(|(a, b)| (a - b).abs() < 1e-14));
        }
        assert_eq!(quantile(&[3.0], 0.95), Some(3.0));
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn the_median_is_a_value() {
        assert_eq!(median([3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median([4.0, 1.0, 3.0, 2.0]), 3.0);
        assert_eq!(median([]), 0.0);
    }
}
