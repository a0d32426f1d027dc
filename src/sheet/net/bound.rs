//! Bounds on errors: the margin, the weight of values, and largest errors in which NaN stays.

/// Factor by which a bound exceeds the largest error seen: the error between a few places may be larger than there.
pub const MARGIN: f64 = 4.0;

/// Error in whisker lengths that an error as large as the value's size along the row counts as: values may be ten times less accurate
/// than states.
pub const VALUE_WEIGHT: f64 = 0.1;

/// Smallest bound on the residual that trajectories of the finest steps allow, in whisker lengths: the residual of refined states.
pub const SMALLEST_RESIDUAL: f64 = 1e-12;

/// Returns the larger of two errors in one unit; NaN if either is.
#[must_use]
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// Returns the largest of the weighted `errors`, in whisker lengths; NaN if one is.
#[must_use]
pub fn largest<const N: usize>(errors: &[f64; N], weights: &[f64; N]) -> f64 {
    let weighted = errors.iter().zip(weights);
    let weighted = weighted.map(|(error, weight)| error.abs() * weight);
    weighted.fold(0.0, larger)
}
