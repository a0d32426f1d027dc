//! Medians, and samples from all over a film.

/// Median of numbers, 0 without any.
pub(super) fn median(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = numbers.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

/// Returns at most `most` of all, evenly spaced.
pub(super) fn evenly<T: Copy>(all: &[T], most: usize) -> Vec<T> {
    let count = all.len().min(most);
    let chosen = (0..count).map(|i| (2 * i + 1) * all.len() / (2 * count));
    chosen.map(|i| all[i]).collect()
}
