//! Certificates: tests that no sign change is hidden between two samples of a sheet.
//!
//! Samples are evenly spaced in coordinates in which the sampled function is smooth. Differences of samples then bound the function
//! between them. A bound from differences is no proof; it has a margin, and fails long before the samples miss anything.

/// Largest second difference of a logarithm that is no sign of a dip. A parabola that touches 0 between two samples has at least 2.2.
const DIP: f64 = 1.0;

/// Returns true if a function that is positive at `count` samples is positive between them, too. At its ends, the function is assumed to
/// be even or constant.
pub fn stays_positive(count: usize, sample: impl Fn(usize) -> f64) -> bool {
    let dips = |i: usize| sample(i - 1) * sample(i + 1) > libm::exp(DIP) * sample(i).powi(2);
    (0..count).all(|i| sample(i) > 0.0) && !(1..count.max(1) - 1).any(dips)
}

/// Largest difference between the change from one sample to the next and the slope at either of them.
const SLOPE_TOLERANCE: f64 = 0.25;

/// Returns true if the `change` of a function between two samples agrees with its `slopes` there.
pub fn is_as_steep_as(change: f64, slopes: [f64; 2]) -> bool {
    slopes
        .iter()
        .all(|slope| (change - slope).abs() < SLOPE_TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lowest point of a parabola lies between samples; the width of the parabola does not matter.
    #[test]
    fn a_dip_between_samples_is_suspected() {
        let parabola =
            |lowest: f64, at: f64| stays_positive(12, |i| lowest + (i as f64 - at).powi(2));
        for at in [3.0, 3.25, 3.5, 3.75] {
            assert!(!parabola(0.0, at) && !parabola(-0.01, at), "{at}");
            assert!(parabola(2.0, at), "{at}");
        }
        // A function with a zero at its end, and one with a zero before it.
        assert!(stays_positive(10, |i| (10.0 - i as f64).powi(2)));
        assert!(!stays_positive(10, |i| 8.5 - i as f64));
    }
}
