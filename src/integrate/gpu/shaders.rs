//! The shaders' text: whole pieces in order, after one that Rust writes.

use super::Precision;
use super::layout::OUTCOMES;
use crate::integrate::MOST_STEPS;
use crate::model::{Effects, LONGEST_STEP, Resolution, Rod};
use std::fmt::Write;

/// Invocations per workgroup; every device allows this many.
pub const WORKGROUP: u32 = 64;

/// A trajectory and Newton's step from it.
const MODEL: [&str; 5] = [
    include_str!("../../../shaders/numbers.wgsl"),
    include_str!("../../../shaders/rod.wgsl"),
    include_str!("../../../shaders/rhs.wgsl"),
    include_str!("../../../shaders/rk4.wgsl"),
    include_str!("../../../shaders/landing.wgsl"),
];

/// The material, and the way along it.
const LINEAR: &str = include_str!("../../../shaders/linear.wgsl");
const MEASURED: &str = include_str!("../../../shaders/measured.wgsl");

impl Precision {
    /// Steps of [`Rk4`](crate::model::Rk4) per trajectory.
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

    /// Steps of a trajectory from `tau`; on a rod `measured`, steps for every piece of its profile.
    #[must_use]
    pub fn steps(self, measured: Option<&Rod>, tau: f64, load: f64) -> u32 {
        measured.map_or(self.least_steps(), |rod| {
            self.resolution().steps(rod, tau, load)
        })
    }

    /// The resolution of whiskers with a profile, which take steps piece by piece: no coarser than that of a cone of
    /// taper 0.99 in as many steps as the others.
    #[must_use]
    fn resolution(self) -> Resolution {
        Resolution {
            least: self.least_steps() / 2,
            longest: LARGEST_TAPER_TAU / f64::from(self.least_steps()),
        }
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

/// The numbers and names that the pieces share with Rust.
fn constants(precision: Precision) -> String {
    let tolerance = precision.tolerance();
    let mut text = format!(
        "alias real = {precision};\n\
         const WORKGROUP = {WORKGROUP}u;\n\
         const MOST_STEPS = {MOST_STEPS}u;\n\
         const LONGEST_STEP = real({LONGEST_STEP:e});\n\
         const TOLERANCE = real({tolerance:e});\n\
         override TAPER: bool;\n\
         override CURVATURE: bool;\n\
         override SPIRAL: bool;\n\
         override GRADIENT: bool;\n"
    );
    for (code, (name, _)) in OUTCOMES.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "const {name} = {code}u;");
    }
    text
}

/// The pieces that compute a trajectory with these effects, without an entry point.
#[must_use]
pub fn model(precision: Precision, effects: Effects) -> String {
    let material = if effects.profile { MEASURED } else { LINEAR };
    constants(precision) + &MODEL.concat() + material
}

/// The engine's shader; its entry point is `shoot`.
#[must_use]
pub fn shoot(precision: Precision, effects: Effects) -> String {
    model(precision, effects) + include_str!("../../../shaders/shoot.wgsl")
}

/// A kernel that only multiplies and adds; its entry point is `peak`.
#[must_use]
pub fn peak(precision: Precision) -> String {
    format!("alias real = {precision};\nconst WORKGROUP = {WORKGROUP}u;\n")
        + include_str!("../../../shaders/peak.wgsl")
}

/// The values of the `override` constants.
#[must_use]
pub fn overrides(effects: Effects) -> [(&'static str, f64); 4] {
    let flag = |on: bool| f64::from(u8::from(on));
    [
        ("TAPER", flag(effects.advances())),
        ("CURVATURE", flag(effects.curvature)),
        ("SPIRAL", flag(effects.spiral)),
        ("GRADIENT", flag(effects.gradient)),
    ]
}
