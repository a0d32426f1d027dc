//! The shaders' text: whole pieces in order, after one that Rust writes.

use super::Precision;
use super::layout::OUTCOMES;
use super::reference::{JACOBIAN_TERMS, ROW_POWERS};
use crate::plan::STATE_CHANNELS;
use crate::rod::Effects;
use crate::shooting::REST_TERMS;

/// Invocations per workgroup; every device allows this many.
pub const WORKGROUP: u32 = 64;

/// Cells of rows as differences from references.
const CELLS: [&str; 4] = [
    include_str!("../../../shaders/numbers.wgsl"),
    include_str!("../../../shaders/difference.wgsl"),
    include_str!("../../../shaders/nystrom8.wgsl"),
    include_str!("../../../shaders/cells.wgsl"),
];

/// The numbers and names that the pieces share with Rust.
fn constants(precision: Precision) -> String {
    let channels = STATE_CHANNELS.len();
    let mut text = format!(
        "alias real = {precision};\n\
         const WORKGROUP = {WORKGROUP}u;\n\
         const REST_TERMS = {REST_TERMS};\n\
         const POWERS = {ROW_POWERS};\n\
         const JACOBIAN_TERMS = {JACOBIAN_TERMS};\n\
         const CHANNELS = {channels};\n"
    );
    for (name, value) in precision.limits() {
        text += &format!("const {name} = real({value:e});\n");
    }
    for (name, _) in overrides(Effects::default()) {
        text += &format!("override {name}: bool;\n");
    }
    for (code, (name, _)) in OUTCOMES.iter().enumerate() {
        text += &format!("const {name} = {code}u;\n");
    }
    text
}

/// The engine's shader; its entry point is `solve_cells`.
#[must_use]
pub fn cells(precision: Precision) -> String {
    constants(precision) + &CELLS.concat()
}

/// Kernels that only multiply and add; their entry points are `peak_of_8` and `peak_of_16`, by accumulators.
#[must_use]
pub fn peak(precision: Precision) -> String {
    format!("alias real = {precision};\nconst WORKGROUP = {WORKGROUP}u;\n")
        + include_str!("../../../shaders/peak.wgsl")
}

/// The values of the `override` constants.
#[must_use]
pub fn overrides(effects: Effects) -> [(&'static str, f64); 3] {
    let flag = |on: bool| f64::from(u8::from(on));
    [
        ("TAPER", flag(effects.taper)),
        ("CURVATURE", flag(effects.curvature)),
        ("SPIRAL", flag(effects.spiral)),
    ]
}
