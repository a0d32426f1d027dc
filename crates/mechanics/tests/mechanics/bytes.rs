//! Bits of trajectories are equal on all units of one arithmetic class, on every processor and operating system.

use crate::effects::{conditions, rods};
use whiskmap_mechanics::numerics::{ArithmeticClass, Unit};
use whiskmap_mechanics::rod::{Rest, Rod, arclength};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method, OutputSet};
use whiskmap_mechanics::shooting::{FirstVariation, Resolution, SecondVariation, ShootingMap};

/// FNV-1a of a text. The text of an `f64` in Rust has all of its bits, except those of NaN.
fn fnv(hash: u64, text: &str) -> u64 {
    text.bytes().fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The hash of the outputs of all conditions, each alone in its block and in padded blocks.
fn hashed<O: OutputSet + std::fmt::Debug>(
    hash: u64,
    batch: Batch,
    conditions: &[InitialCondition],
) -> u64 {
    [batch, batch.padded()]
        .iter()
        .flat_map(|batch| batch.shoot::<O>(conditions))
        .fold(hash, |hash, output| fnv(hash, &format!("{output:?}")))
}

/// The hash of numbers of the rods at rest, which are computed without lanes.
fn at_rest(hash: u64, rods: &[Rod]) -> u64 {
    let places = (1..200).map(|i| f64::from(i) / 200.0);
    let pairs = rods.iter().flat_map(|rod| places.clone().map(move |s| (rod, s)));
    pairs.fold(hash, |hash, (rod, s)| {
        let tau = rod.tau(s);
        let (radius, back) = (rod.radius(tau), arclength(rod, tau));
        let angle = Rest::new(rod).at_arclength(s).0.to_angle();
        fnv(hash, &format!("{tau:?} {radius:?} {back:?} {angle:?}"))
    })
}

#[test]
fn units_of_a_class_have_equal_bits() {
    let rods = rods();
    let conditions = conditions(&rods);
    for unit in Unit::all() {
        let mut hash = at_rest(0xcbf2_9ce4_8422_2325, &rods);
        for resolution in [Resolution::of(7), Resolution::FINE] {
            let batch = Batch::new(Method::new(resolution)).on(unit);
            hash = hashed::<ShootingMap>(hash, batch, &conditions);
            hash = hashed::<FirstVariation>(hash, batch, &conditions);
            hash = hashed::<SecondVariation>(hash, batch, &conditions);
        }
        let class = unit.arithmetic();
        let expected: u64 = match class {
            ArithmeticClass::Fma => 0x5aed_9c34_df89_a5fe,
            ArithmeticClass::NoFma => 0x9dc0_fcd6_b5e1_0710,
        };
        assert_eq!(hash, expected, "{unit} ({class}): {hash:#x}");
    }
}
