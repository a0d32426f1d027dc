//! Limits of the shaders by precision.

use super::base_point::GpuStart;
use crate::engine::Precision;
use crate::refine::{LARGEST_Q, LEFT_BY_STEP, ROUNDING};
use crate::shooting::Resolution;

/// Largest uniform buffer that every device allows, in bytes.
const UNIFORM_BYTES: usize = 1 << 16;

impl Precision {
    /// Returns the resolution of the differences where the CPU integrates with `resolution`. Differences have a small part of the
    /// integrator's error: in `f32` more steps only add rounding, and with fewer the derivatives are too inexact for a Newton step.
    #[must_use]
    pub fn resolution(self, resolution: Resolution) -> Resolution {
        match self {
            Self::F64 if resolution.least > Resolution::COARSE.least => resolution,
            _ => Resolution::COARSE,
        }
    }

    /// Returns the maximum number of steps of all base points of a dispatch: as many as every device allows as uniforms.
    #[must_use]
    pub(super) const fn most_steps(self) -> usize {
        UNIFORM_BYTES
            / match self {
                Self::F32 => size_of::<GpuStart<f32>>(),
                Self::F64 => size_of::<GpuStart<f64>>(),
            }
    }

    /// Returns the largest residual bound that the shaders certify, in whisker lengths. At a contact with an arclength `s` below 0.5
    /// whisker lengths, they certify at most `2 s` times this bound.
    #[must_use]
    pub const fn goal(self) -> f64 {
        match self {
            Self::F32 => 1e-7,
            Self::F64 => 1e-12,
        }
    }

    /// Returns the limits of the shaders' certificate as pairs of the name in WGSL and the value.
    ///
    /// `LEFT_BY_STEP` and `LARGEST_Q` have the values of the refinement in `f64`. `JACOBIAN_ERROR` bounds the relative error of the
    /// Jacobian, a polynomial through 16 states of the row. With 6e-6, a cell in `f64` of one random whisker
    /// with friction 1 missed the pole by 1.23 times its bound, and no other one did (`tests/machine/bound.rs`).
    /// `ROUNDING_OF_MOTION` bounds the residual over the motion of base and pole from the base point to the cell: on random whiskers at
    /// most 5.8e-7 in `f32`, in the median 5e-8. `FARTHEST_REST` keeps the remainder of the resting parabola's series, some 100 times
    /// its 9th power, below rounding.
    #[must_use]
    pub const fn limits(self) -> [(&'static str, f64); 10] {
        let [clear_of_fold, clear_of_tip, longest, of_motion, rest] = match self {
            Self::F32 => [0.05, 1e-6, 1e-5, 8e-7, 0.06],
            Self::F64 => [1e-3, 1e-9, 1.5e-7, 2e-15, 0.02],
        };
        [
            ("GOAL", self.goal()),
            ("LEFT_BY_STEP", LEFT_BY_STEP),
            ("LARGEST_Q", LARGEST_Q),
            ("JACOBIAN_ERROR", 8e-6),
            ("ROUNDING_OF_MOTION", of_motion),
            ("ROUNDING", ROUNDING),
            ("LONGEST_STEP", longest),
            ("CLEAR_OF_FOLD", clear_of_fold),
            ("CLEAR_OF_TIP", clear_of_tip),
            ("FARTHEST_REST", rest),
        ]
    }
}
