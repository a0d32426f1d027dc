//! Limits of the shaders by precision.

use crate::engine::Precision;
use crate::sheet::net::NET_RESIDUAL;

impl Precision {
    /// Returns the largest residual bound that the shaders certify, in whisker lengths.
    #[must_use]
    pub const fn goal(self) -> f64 {
        match self {
            Self::F32 => 1e-6,
            Self::F64 => NET_RESIDUAL,
        }
    }

    /// Returns the maximum residual of the rows that the shaders evaluate, in whisker lengths. In `f32`, rounding is a hundred times larger.
    #[must_use]
    pub const fn row_residual(self) -> f64 {
        match self {
            Self::F32 => 1e-8,
            Self::F64 => NET_RESIDUAL,
        }
    }

    /// Returns the part of the push angle at a row's end up to which the host evaluates cells. Shaders compute differences from the end. In `f32` these
    /// have errors of up to 7e-7 of the values there, and values near first touch are small.
    #[must_use]
    pub const fn near_touch(self) -> f64 {
        match self {
            Self::F32 => 1.0 / 16.0,
            Self::F64 => 0.0,
        }
    }

    /// Returns the limits of the shaders' certificate as pairs of the name in WGSL and the value.
    ///
    /// `ROUNDING` bounds what rounding adds to the residual, in whisker lengths: measured at most 3.4e-7 in `f32` on whiskers of every kind
    /// (`tests/machine/bound.rs`), and below 1e-13 in `f64`. Contacts within the part `CLEAR_OF_TIP` of the tip's `tau` are left to the CPU.
    /// `OUTSIDE` is the argument beyond the ends of a row that rounding explains, and `TINY` keeps a quotient of zeros 0.
    #[must_use]
    pub(super) const fn limits(self) -> [(&'static str, f64); 5] {
        let [rounding, clear_of_tip, outside] = match self {
            Self::F32 => [5e-7, 1e-6, 1e-5],
            Self::F64 => [1e-13, 1e-9, 1e-6],
        };
        [
            ("GOAL", self.goal()),
            ("ROUNDING", rounding),
            ("CLEAR_OF_TIP", clear_of_tip),
            ("OUTSIDE", outside),
            ("TINY", 1e-37),
        ]
    }
}
