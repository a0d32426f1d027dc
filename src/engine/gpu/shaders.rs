//! Text of the shaders, after constants that Rust writes.

use super::Precision;
use super::cells::OUTCOMES;
use super::packing::WORKGROUP;
use crate::engine::row::FUNCTIONS;
use crate::plan::{Channels, STATE_CHANNELS};
use whiskmap_mechanics::numerics::inverse::TOGETHER;
use whiskmap_mechanics::rod::{CURVATURE_TERMS, Effects};
use whiskmap_mechanics::shooting::contact::ARC_TERMS;
use whiskmap_mechanics::shooting::{Nystrom8, REST_TANGENT, REST_TERMS, StepRule};

const _: () =
    assert!(CURVATURE_TERMS == 7 && REST_TERMS == 12, "shaders/shoot.wgsl writes them out");

const CHANNELS: usize = STATE_CHANNELS.len();

/// Names and types of the `override` constants of the shader of cells.
const OVERRIDES: [(&str, &str); 2] = [("CHANNELS_WANTED", "u32"), ("HAS_POINTS", "bool")];

const _: () = assert!(
    FUNCTIONS == 12 && CHANNELS == 9 && TOGETHER == 4,
    "shaders/cells.wgsl writes them out"
);

/// The numbers and names that the shader of cells shares with Rust.
fn constants(precision: Precision) -> String {
    let mut text = format!(
        "alias real = {precision};\n\
         const WORKGROUP = {WORKGROUP}u;\n",
    );
    for (name, value) in precision.limits() {
        text += &format!("const {name} = real({value:e});\n");
    }
    for (name, code, _) in OUTCOMES {
        text += &format!("const {name} = f32({code:e});\n");
    }
    // Each channel is a bit. The first group of functions has push angle, contact and load.
    for (name, group) in [("MIDDLE_CHANNELS", 1), ("LAST_CHANNELS", 2)] {
        let functions = group * TOGETHER..(group + 1) * TOGETHER;
        let bits: u32 = functions.map(|i| 1 << (i + CHANNELS - FUNCTIONS)).sum();
        text += &format!("const {name} = {bits}u;\n");
    }
    text += &format!("const CHANNELS = {CHANNELS}u;\n");
    for (name, kind) in OVERRIDES {
        text += &format!("override {name}: {kind};\n");
    }
    text
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

/// A function for the series of `atanh(w)/w` in the square of `w`.
fn arc_series() -> String {
    let terms = (0..ARC_TERMS).map(|k| format!("real({:e})", 1.0 / f64::from(2 * k + 1)));
    let sum = terms.rev().reduce(|sum, term| format!("({term} + square * {sum})"));
    format!("fn arc_series(square: real) -> real {{\nreturn {};\n}}\n", sum.unwrap_or_default())
}

/// Returns the text of the engine's shader; its entry point is `solve_cells`.
#[must_use]
pub fn cells(precision: Precision) -> String {
    constants(precision) + include_str!("../../../shaders/cells.wgsl")
}

/// Returns the values of the `override` constants of [`cells`] for a map with these `channels`, by name. Each channel of a state is a bit.
#[must_use]
pub fn overrides(channels: Channels) -> [(&'static str, f64); 2] {
    let bit = |(channel, is_wanted)| u32::from(is_wanted) << channel;
    let states: u32 = channels.states().into_iter().enumerate().map(bit).sum();
    let values = [states.into(), u8::from(channels.has_strain()).into()];
    [0, 1].map(|i| (OVERRIDES[i].0, values[i]))
}

/// Returns the text of the shader of trajectories; its entry point is `shoot`.
#[must_use]
pub fn shoot(precision: Precision) -> String {
    let mut text = format!(
        "alias real = {precision};\n\
         const DOUBLE = {};\n\
         const WORKGROUP = {WORKGROUP}u;\n\
         const REST_TERMS = {REST_TERMS};\n",
        precision == Precision::F64,
    );
    for (name, _) in effects(Effects::default()) {
        text += &format!("override {name}: bool;\n");
    }
    for (name, value) in StepRule::WEIGHTS {
        text += &format!("const {name} = {value:?}f;\n");
    }
    text + &tableau() + &rest_terms() + &arc_series() + include_str!("../../../shaders/shoot.wgsl")
}

/// Returns the values of the `override` constants of [`shoot`], by name.
#[must_use]
pub fn effects(effects: Effects) -> [(&'static str, f64); 5] {
    let flag = |on: bool| f64::from(u8::from(on));
    [
        ("TAPER", flag(effects.taper)),
        ("CURVATURE", flag(effects.curvature)),
        ("SPIRAL", flag(effects.spiral)),
        ("POLYNOMIAL", flag(effects.polynomial)),
        ("GRADIENT", flag(effects.gradient)),
    ]
}
