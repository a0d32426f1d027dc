//! Samples from all over a film.

/// Returns at most `most` of all, evenly spaced.
pub(super) fn evenly<T: Copy>(all: &[T], most: usize) -> Vec<T> {
    let count = all.len().min(most);
    let chosen = (0..count).map(|i| (2 * i + 1) * all.len() / (2 * count));
    chosen.map(|i| all[i]).collect()
}
