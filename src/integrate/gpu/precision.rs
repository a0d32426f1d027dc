//! `f32` or `f64` in the shaders, and what follows from it.

use crate::rod::Rod;
use crate::shooting::Resolution;
use std::fmt;

/// The shaders' scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Precision {
    /// Every adapter.
    F32,
    /// Vulkan adapters with shaderFloat64.
    F64,
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        })
    }
}

impl Precision {
    /// Steps of [`Rk4`](crate::shooting::Rk4) per trajectory.
    ///
    /// Measured over taper up to 0.99, `A*` up to 0.8, both sides and `q` up to 6.5, worst distance of the
    /// pole from where `f64` finds it: in `f32` 3.6e-5, 7e-6, 4e-6 and 9e-6 whisker lengths for 32, 48, 64 and
    /// 128 steps (beyond 64 rounding grows); in `f64` 2.4e-6, 4.8e-7 and 1.5e-7 for 64, 96 and 128.
    #[must_use]
    pub const fn least_steps(self) -> u32 {
        match self {
            Self::F32 => 64,
            Self::F64 => 96,
        }
    }

    /// Steps of a trajectory from `tau`; on a rod `measured`, steps for every piece of its profile: no coarser than those of
    /// a cone of taper 0.99 without one.
    #[must_use]
    pub fn steps(self, measured: Option<&Rod>, tau: f64, load: f64) -> u32 {
        let least = self.least_steps();
        let pieces = Resolution {
            least: least / 2,
            longest: LARGEST_TAPER_TAU / f64::from(least),
        };
        measured.map_or(least, |rod| pieces.steps(rod, tau, load))
    }

    /// Residual, in whisker lengths, at which a shot has converged.
    ///
    /// In `f32` iterating on ends between 0 and 3.6e-6 (median 1e-7, worst of 800,000 shots), so that a
    /// smaller tolerance would call rounding a failure; in `f64` it is that of the CPU engine, above the
    /// error of the integration.
    #[must_use]
    pub const fn tolerance(self) -> f64 {
        match self {
            Self::F32 => 5e-6,
            Self::F64 => 1e-6,
        }
    }
}

/// `beta tau` at the tip of a cone of taper 0.99, `ln 100`.
const LARGEST_TAPER_TAU: f64 = 4.605;
