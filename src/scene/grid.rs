//! The axes of a sweep, and where a whisker stands in it.

use serde::Serialize;

/// The nearest first touch is the whisker's length over this.
pub(crate) const NEAREST: f64 = 1000.0;

/// The farthest is the whisker's length times this.
pub(super) const FARTHEST: f64 = 10.0;

/// The axes of the sweep; every list is strictly increasing and not empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Rotation of the base since first touch: negative CF, positive CB.
    pub push_angle_deg: Vec<f64>,
    /// Distance from the base to the contact at first touch.
    pub distance_mm: Vec<f64>,
    /// `1 - tip/base radius`, in place of the whisker's own.
    pub taper: Option<Vec<f64>>,
    /// Parabola coefficient `A`, in place of the whisker's own.
    pub curvature_per_mm: Option<Vec<f64>>,
}

/// Where a whisker stands in a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Morphology {
    /// `1 - tip/base radius`.
    pub taper: f64,
    /// Parabola coefficient `A`.
    pub curvature_per_mm: f64,
}
