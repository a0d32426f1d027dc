//! Reproducible random whiskers on small grids.
#![allow(dead_code, reason = "each test program uses a part of this module")]

use super::case::Case;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

/// Strategy for numbers that are uniform in the logarithm.
pub fn even_in_log(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from.ln()..to.ln()).prop_map(f64::exp)
}

/// Strategy for push angles in degrees, from 1e-12 to almost a whole turn, on both sides.
fn pushes_deg() -> impl Strategy<Value = Vec<f64>> {
    let side = || (even_in_log(1e-12, 0.5), 1.0..60.0_f64, 61.0..180.0_f64, 181.0..360.0_f64);
    (side(), side()).prop_map(|(cf, cb)| vec![-cf.3, -cf.2, -cf.1, -cf.0, cb.0, cb.1, cb.2, cb.3])
}

/// Strategy for whiskers, with a grid from next to the pole or the base to beyond the reach.
pub fn cases() -> impl Strategy<Value = Case> {
    let taper = prop_oneof![
        1 => Just(0.0),
        1 => Just(1e-12),
        24 => 0.0..1.0_f64,
        1 => Just(1.0 - 1e-3),
        1 => Just(1.0 - 1e-6),
        1 => Just(1.0),
    ];
    let bend = prop_oneof![Just(0.0), Just(1e-9), even_in_log(1e-9, 1.5), 0.0..1.5_f64, Just(1.5)];
    let pole = prop_oneof![Just(0.0), even_in_log(1e-9, 0.1), 0.0..0.1_f64, Just(0.1)];
    let friction = prop_oneof![2 => Just(0.0), 2 => 0.0..1.0_f64, 1 => Just(1.0)];
    let tip_to_base =
        prop_oneof![2 => Just(1.0), 2 => even_in_log(0.1, 10.0), 1 => Just(0.1), 1 => Just(10.0)];
    let length_mm = even_in_log(0.1, 1000.0);
    let distances = (0.02..0.1_f64, 0.11..0.9_f64, 0.91..1.0_f64, 1.01..1.4_f64);
    let whisker = (length_mm, taper, bend, pole, friction, tip_to_base);
    (whisker, pushes_deg(), distances).prop_map(
        |((length_mm, taper, bend, pole, friction, tip_to_base), pushes_deg, distances)| {
            let nearest = f64::max(distances.0, 1.01 * pole);
            let distances = vec![nearest, distances.1, distances.2, distances.3];
            Case {
                length_mm,
                taper,
                bend,
                pole,
                friction,
                tip_to_base,
                stretch: 1.0,
                compliance: 0.0,
                rows: Vec::new(),
                pushes_deg,
                distances,
            }
        },
    )
}

/// Strategy for radii that differ from a cone by a factor of up to 1.33. Deeper waists are excluded: a waist is a hinge, and
/// the part beyond it rotates rigidly and never slips off.
fn rows() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let inner = prop::collection::vec((0.05..1.0_f64, even_in_log(0.75, 1.33)), 0..8);
    (inner, even_in_log(1e-3, 1.0), 0.1..1.0_f64).prop_map(|(inner, tip, end)| {
        let whole = inner.iter().map(|(gap, _)| gap).sum::<f64>() + end;
        let mut s = 0.0;
        let mut rows = vec![[0.0, 1.0]];
        for (gap, factor) in inner {
            s += gap / whole;
            let cone = 1.0 - (1.0 - tip) * s;
            rows.push([s, (cone * factor).max(tip)]);
        }
        rows.push([1.0, tip]);
        rows
    })
}

/// Strategy for whiskers with measured radii.
pub fn measured() -> impl Strategy<Value = Case> {
    let stretch = prop_oneof![2 => Just(1.0), 1 => 1.0..1.3_f64];
    (cases(), rows(), stretch).prop_map(|(case, rows, stretch)| {
        let taper = 1.0 - rows[rows.len() - 1][1];
        // The modulus ratio of tip and base must be between 1/20 and 20.
        let change = case.tip_to_base - 1.0;
        let softest = if change < 0.0 { -0.95 / change } else { 19.0 / change };
        Case {
            stretch: stretch.min(0.999 / taper).min(0.999 * softest).max(1.0),
            rows,
            // Scenes with radii of less than a nanometre are invalid.
            length_mm: case.length_mm.max(1.0),
            ..case
        }
    })
}

/// Runner of `count` cases with a fixed seed.
pub fn always_the_same(count: u32) -> TestRunner {
    TestRunner::new(Config {
        cases: count,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(7),
        ..Config::default()
    })
}
