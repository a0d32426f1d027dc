//! The shaders' text: whole pieces in order, after one that Rust writes.

use super::Precision;
use super::layout::OUTCOMES;
use crate::integrate::MOST_STEPS;
use crate::rod::Effects;
use crate::shooting::LONGEST_STEP;

/// Invocations per workgroup; every device allows this many.
pub const WORKGROUP: u32 = 64;

/// A trajectory and Newton's step from it.
const MODEL: [&str; 5] = [
    include_str!("../../../shaders/numbers.wgsl"),
    include_str!("../../../shaders/rod.wgsl"),
    include_str!("../../../shaders/rhs.wgsl"),
    include_str!("../../../shaders/rk4.wgsl"),
    include_str!("../../../shaders/shooting_map.wgsl"),
];

/// The material, and the way along it.
const LINEAR: &str = include_str!("../../../shaders/linear.wgsl");
const MEASURED: &str = include_str!("../../../shaders/measured.wgsl");

/// The numbers and names that the pieces share with Rust.
fn constants(precision: Precision) -> String {
    let tolerance = precision.tolerance();
    let mut text = format!(
        "alias real = {precision};\n\
         const WORKGROUP = {WORKGROUP}u;\n\
         const MOST_STEPS = {MOST_STEPS}u;\n\
         const LONGEST_STEP = real({LONGEST_STEP:e});\n\
         const TOLERANCE = real({tolerance:e});\n"
    );
    for (name, _) in overrides(Effects::default()) {
        text += &format!("override {name}: bool;\n");
    }
    for (code, (name, _)) in OUTCOMES.iter().enumerate() {
        text += &format!("const {name} = {code}u;\n");
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
pub fn overrides(effects: Effects) -> [(&'static str, f64); 5] {
    let flag = |on: bool| f64::from(u8::from(on));
    [
        ("TAPER", flag(effects.advances())),
        ("CURVATURE", flag(effects.curvature)),
        ("SPIRAL", flag(effects.spiral)),
        ("GRADIENT", flag(effects.gradient)),
        ("SIMILAR", flag(effects.similar())),
    ]
}
