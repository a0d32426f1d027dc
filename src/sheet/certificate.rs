//! Whether the samples of a sheet show all of it: what it takes that no sign change hides between two of them.
//!
//! Samples are evenly spaced in coordinates in which what they sample is smooth. So differences of samples bound how far it can
//! stray between two of them. A bound from differences is no proof; it has a margin, and fails long before the samples do.

/// Second difference of a logarithm that is still no sign of a dip: a parabola that touches 0 between two samples has at least 2.2.
const DIP: f64 = 1.0;

/// Whether a function that is positive at `count` samples is positive between them, too. Its ends are taken to be those of a function
/// that is even or constant there.
pub fn stays_positive(count: usize, sample: impl Fn(usize) -> f64) -> bool {
    let dips = |i: usize| sample(i - 1) * sample(i + 1) > libm::exp(DIP) * sample(i).powi(2);
    (0..count).all(|i| sample(i) > 0.0) && !(1..count.max(1) - 1).any(dips)
}

/// How far a change between two samples may be from the slopes at them.
const SLOPE_TOLERANCE: f64 = 0.25;

/// Whether a function does between two samples, between which it changes by `change`, what its `slopes` there say.
pub fn is_as_steep_as(change: f64, slopes: [f64; 2]) -> bool {
    slopes
        .iter()
        .all(|slope| (change - slope).abs() < SLOPE_TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No sample sees where a parabola is lowest; how wide it is does not matter.
    #[test]
    fn a_dip_between_samples_is_suspected() {
        let parabola =
            |lowest: f64, at: f64| stays_positive(12, |i| lowest + (i as f64 - at).powi(2));
        for at in [3.0, 3.25, 3.5, 3.75] {
            assert!(!parabola(0.0, at) && !parabola(-0.01, at), "{at}");
            assert!(parabola(2.0, at), "{at}");
        }
        // Toward a zero at the end, and past one.
        assert!(stays_positive(10, |i| (10.0 - i as f64).powi(2)));
        assert!(!stays_positive(10, |i| 8.5 - i as f64));
    }
}
