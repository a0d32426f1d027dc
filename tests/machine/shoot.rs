//! Trajectories of the device beside those of the CPU.

use crate::compute::open;
use crate::effect_sets;
use crate::random_rods::conditions;
use whiskmap::engine::EngineError;
use whiskmap::engine::gpu::{Precision, shoots};
use whiskmap::mechanics::rod::Effects;
use whiskmap::mechanics::shooting::PlainState;
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};

tests! {
    Precision:
        trajectories_are_those_of_the_cpu,
        effects_that_a_whisker_lacks_change_rounding_alone,
        measured_radii_are_refused,
        fans_are_those_of_the_cpu,
        states_of_several_submissions_are_in_order;
}

/// Largest differences of base and pole in whisker lengths, of the tangent, and of the energy over force times length.
fn apart(one: &PlainState, other: &PlainState) -> [f64; 4] {
    let lever = other.force.abs().max(1.0);
    [
        one.position.distance(other.position),
        one.tangent.distance(other.tangent),
        one.pole.distance(other.pole),
        (one.energy - other.energy).abs() / lever,
    ]
}

/// Differences that rounding explains: measured 6e-14 in `f64` and 9.3e-6 in `f32`.
const fn allowed(precision: Precision) -> f64 {
    match precision {
        Precision::F32 => 2e-5,
        _ => 1e-12,
    }
}

fn assert_near(found: &[PlainState], wanted: &[PlainState], precision: Precision) {
    assert_eq!(found.len(), wanted.len());
    for (found, wanted) in found.iter().zip(wanted) {
        let apart = apart(found, wanted);
        assert!(apart.iter().all(|part| *part < allowed(precision)), "{apart:?}");
    }
}

/// Every effect that the shader has, by the method and by the rods alone.
fn trajectories_are_those_of_the_cpu(precision: Precision) {
    let mut gpu = open(precision);
    for effects in effect_sets::all().filter(|set| shoots(*set).is_ok()) {
        let method = Method::fine().with_effects(effects);
        let conditions = conditions(effects, 2000, 6.0, 7);
        let found = gpu.shoot(method, &conditions).unwrap();
        let by_rods = gpu.shoot(Method::fine(), &conditions).unwrap();
        let wanted = Batch::new(method).shoot::<PlainState>(&conditions);
        for found in [&found, &by_rods] {
            assert_near(found, &wanted, precision);
        }
    }
    assert!(gpu.shoot(Method::fine(), &[]).unwrap().is_empty());
}

/// Sweeps share kernels: a cylinder is integrated as a cone that does not taper, a straight whisker as one that does not bend.
fn effects_that_a_whisker_lacks_change_rounding_alone(precision: Precision) {
    let mut gpu = open(precision);
    let all = Effects { taper: true, curvature: true, ..Effects::default() };
    let conditions = conditions(Effects::default(), 100, 6.0, 9);
    let [alone, with_all] = [Effects::default(), all]
        .map(|effects| gpu.shoot(Method::fine().with_effects(effects), &conditions).unwrap());
    assert_near(&alone, &with_all, precision);
}

/// The effects of any rod count, also beside others.
fn measured_radii_are_refused(precision: Precision) {
    let profile = Effects { profile: true, ..Effects::default() };
    let mut mixed = conditions(Effects::default(), 8, 6.0, 3);
    let mut gpu = open(precision);
    assert!(gpu.shoot(Method::fine(), &mixed).is_ok());
    mixed.extend(conditions(profile, 8, 6.0, 3));
    let refused = gpu.shoot(Method::fine(), &mixed);
    assert!(matches!(refused, Err(EngineError::Unsupported { .. })));
}

/// Neighbours at one contact share its numbers, and have the states of single trajectories.
fn fans_are_those_of_the_cpu(precision: Precision) {
    let mut gpu = open(precision);
    let all = conditions(Effects::default(), 300, 6.0, 5);
    let fans = all.iter().enumerate().flat_map(|(i, condition)| {
        (0..=i % 5).map(|part| InitialCondition {
            load: condition.load * (1.0 - 0.2 * part as f64),
            ..*condition
        })
    });
    let fans: Vec<InitialCondition> = fans.collect();
    let found = gpu.shoot(Method::fine(), &fans).unwrap();
    let wanted = Batch::new(Method::fine()).shoot::<PlainState>(&fans);
    assert_near(&found, &wanted, precision);
}

/// Two kinds of rods take turns, and each kind takes several submissions. A thread of a pool reads their states with the others, this one alone.
fn states_of_several_submissions_are_in_order(precision: Precision) {
    let mut gpu = open(precision);
    let curved = Effects { curvature: true, ..Effects::default() };
    let kinds = [Effects::default(), curved].map(|effects| conditions(effects, 9000, 6.0, 11));
    let [straight, curved] = &kinds;
    let list: Vec<InitialCondition> =
        straight.iter().zip(curved).flat_map(|(one, other)| [*one, *other]).collect();
    let wanted = Batch::new(Method::fine()).shoot::<PlainState>(&list);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3);
    let pool = pool.build().unwrap();
    let alone = gpu.shoot(Method::fine(), &list).unwrap();
    let together = pool.install(|| gpu.shoot(Method::fine(), &list).unwrap());
    assert_eq!(alone, together);
    assert_near(&alone, &wanted, precision);
}
