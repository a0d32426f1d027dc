//! Random whiskers of every kind.

use crate::cells::RandomRows;
use crate::effect_sets;
use crate::random_rods::Random;
use whiskmap::mechanics::rod::{Effects, Rod};

/// What is made of random whiskers, and the set of effects that it is made with.
type Kind = (&'static str, Effects, fn(&mut Rod, &mut Random));

/// Every set of effects that the GPU has kernels for, and the ends of some ranges.
fn kinds() -> Vec<Kind> {
    let tapered = Effects { taper: true, ..Effects::default() };
    let bent = Effects { curvature: true, ..tapered };
    let as_they_are = |_: &mut Rod, _: &mut Random| ();
    let sets = effect_sets::on_gpu();
    let any = sets.map(|effects| ("any", effects, as_they_are as fn(&mut Rod, &mut Random)));
    // A kind's place is its seed: these came last.
    let (polynomial, mut kinds): (Vec<Kind>, Vec<Kind>) =
        any.partition(|(_, effects, _)| effects.polynomial);
    kinds.extend([
        ("slender", tapered, slender as fn(&mut Rod, &mut Random)),
        ("slender", bent, slender),
        ("almost a cylinder", bent, |rod, random| {
            rod.taper = 10_f64.powf(random.between(-12.0, -3.0));
        }),
        ("point pole", bent, |rod, _| rod.pole = 0.0_f64.copysign(rod.pole)),
        ("thick pole", bent, |rod, _| rod.pole = 0.1_f64.copysign(rod.pole)),
        ("friction 1", bent, |rod, _| rod.friction = rod.pole.signum()),
        ("no friction", bent, |rod, _| rod.friction = 0.0),
        ("strongly curved", bent, |rod, random| rod.bend = random.between(0.8, 1.5)),
    ]);
    kinds.extend(polynomial);
    kinds
}

/// Cones down to the thousandth, and the millionth, part of the radius at the base.
fn slender(rod: &mut Rod, random: &mut Random) {
    rod.taper = 1.0 - 10_f64.powf(random.between(-6.0, -2.0));
}

/// So many rows of each of `count` whiskers of every kind.
pub fn rows_of_every_kind(rows: usize, count: usize) -> impl Iterator<Item = (String, RandomRows)> {
    (1..).zip(kinds()).map(move |(seed, (name, effects, changed))| {
        let rows = RandomRows::many(rows, effects, count, seed, changed);
        let Effects { taper, curvature, spiral, polynomial, .. } = effects;
        let name = format!(
            "{name}: taper {taper}, parabola {curvature}, spiral {spiral}, polynomial {polynomial}"
        );
        (name, rows)
    })
}
