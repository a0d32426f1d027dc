//! Text of the shaders: whole pieces in order, after one that Rust writes.

use super::Precision;
use super::base_point::QUADS;
use super::cells::OUTCOMES;
use super::packing::WORKGROUP;
use crate::plan::STATE_CHANNELS;
use crate::rod::Effects;
use crate::shooting::{Nystrom8, REST_TANGENT, REST_TERMS};

/// Pieces of the shader that solves cells of rows as differences from base points.
const CELLS: [&str; 7] = [
    include_str!("../../../shaders/numbers.wgsl"),
    include_str!("../../../shaders/difference.wgsl"),
    include_str!("../../../shaders/path.wgsl"),
    include_str!("../../../shaders/intrinsic.wgsl"),
    include_str!("../../../shaders/nystrom8.wgsl"),
    include_str!("../../../shaders/row.wgsl"),
    include_str!("../../../shaders/cells.wgsl"),
];

/// The numbers and names that the pieces share with Rust.
fn constants(precision: Precision) -> String {
    let channels = STATE_CHANNELS.len();
    let most_steps = precision.most_steps();
    let mut text = format!(
        "alias real = {precision};\n\
         const DOUBLE = {};\n\
         const WORKGROUP = {WORKGROUP}u;\n\
         const MOST_STEPS = {most_steps};\n\
         const REST_TERMS = {REST_TERMS};\n\
         const CHANNELS = {channels};\n",
        precision == Precision::F64,
    );
    for (name, quad) in QUADS {
        text += &format!("const {name} = {quad}u;\n");
    }
    for (name, value) in precision.limits() {
        text += &format!("const {name} = real({value:e});\n");
    }
    for (name, _) in overrides(Effects::default()) {
        text += &format!("override {name}: bool;\n");
    }
    for (code, (name, _)) in OUTCOMES.iter().enumerate() {
        text += &format!("const {name} = {code}u;\n");
    }
    text + &tableau() + &rest_terms()
}

/// The coefficients of [`Nystrom8`] that are not 0: `NODE_i`, `STAGE_i_j`, `POSITION_j` and `SPEED_j`, counted from 1.
fn tableau() -> String {
    let mut text = String::new();
    let mut define = |name: String, value: f64| {
        if value != 0.0 {
            text += &format!("const {name} = real({value:e});\n");
        }
    };
    for (i, row) in (1..).zip(Nystrom8::STAGE_WEIGHTS) {
        define(format!("NODE_{i}"), Nystrom8::NODES[i - 1]);
        define(format!("POSITION_{i}"), Nystrom8::POSITION_WEIGHTS[i - 1]);
        define(format!("SPEED_{i}"), Nystrom8::SPEED_WEIGHTS[i - 1]);
        for (j, value) in (1..).zip(row) {
            define(format!("STAGE_{i}_{j}"), value);
        }
    }
    text
}

/// A function for the terms of the tangent's Taylor series along a parabola.
fn rest_terms() -> String {
    // In the square of the sine; every other coefficient is 0.
    let term = |(n, row): (usize, &[f64; REST_TERMS])| {
        let powers = row[..=n].iter().skip(n % 2).step_by(2).rev();
        let sum = powers.map(|term| format!("real({term:e})"));
        let sum = sum.reduce(|sum, term| format!("({sum} * y + {term})"));
        let odd = if n % 2 == 1 { "sin * " } else { "" };
        format!("{odd}{}", sum.unwrap_or_default())
    };
    let terms: Vec<String> = REST_TANGENT.iter().enumerate().map(term).collect();
    format!(
        "fn rest_terms_at(sin: real) -> array<real, REST_TERMS> {{\n\
         let y = sin * sin;\n\
         return array<real, REST_TERMS>({});\n}}\n",
        terms.join(",\n")
    )
}

/// Returns the text of the engine's shader; its entry point is `solve_cells`.
#[must_use]
pub fn cells(precision: Precision) -> String {
    constants(precision) + &CELLS.concat()
}

/// Returns the text of kernels that only multiply and add; their entry points are `peak_of_8` and `peak_of_16`, by accumulators.
#[must_use]
pub fn peak(precision: Precision) -> String {
    format!("alias real = {precision};\nconst WORKGROUP = {WORKGROUP}u;\n")
        + include_str!("../../../shaders/peak.wgsl")
}

/// Returns the values of the shaders' `override` constants, by name.
#[must_use]
pub fn overrides(effects: Effects) -> [(&'static str, f64); 4] {
    let flag = |on: bool| f64::from(u8::from(on));
    [
        ("TAPER", flag(effects.taper)),
        ("CURVATURE", flag(effects.curvature)),
        ("SPIRAL", flag(effects.spiral)),
        ("POLYNOMIAL", flag(effects.polynomial)),
    ]
}
