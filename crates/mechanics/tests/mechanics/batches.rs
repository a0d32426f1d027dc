//! Batches of trajectories with different numbers of steps, padded or not.

use std::sync::Arc;
use whiskmap_mechanics::rod::{RadiusProfile, Rod};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{
    FirstVariation, PlainState, Resolution, SecondVariation, ShootingMap,
};

/// A rod that lives until the test program ends.
fn kept(rod: Rod) -> &'static Rod {
    Box::leak(Box::new(rod))
}

/// Conditions with contacts from the base to the tip, loads from 0 to the fold, on slender and blunt whiskers.
fn conditions(count: usize) -> Vec<InitialCondition<'static>> {
    let condition = |i: usize| {
        let [along, load, shape] = [0.618, 0.755, 0.570].map(|step| (i as f64 * step).fract());
        let rod = Rod {
            taper: 0.97 * shape,
            bend: if i.is_multiple_of(2) { 0.4 } else { 0.0 },
            pole: 0.0125,
            ..Rod::default()
        };
        let s = 0.05 + 0.94 * along;
        InitialCondition { rod: kept(rod.clone()), tau: rod.tau(s), load: 9.0 * load / (s * s) }
    };
    (0..count).map(condition).collect()
}

fn method(least: u32) -> Method {
    Method::new(Resolution::of(least))
}

/// Conditions on whiskers with measured radii, with contacts on each piece.
fn measured(count: usize) -> Vec<InitialCondition<'static>> {
    let rows = [0.0, 0.2, 0.5, 0.7, 1.0].map(|s| [s, 1.0 - 0.8 * s - 0.1 * s * s]);
    let profile = Arc::new(RadiusProfile::new(&rows, 1.0));
    let condition = |InitialCondition { rod, tau, load }: InitialCondition<'static>| {
        let s = rod.radius(tau);
        let rod = kept(Rod { profile: Some(profile.clone()), taper: 0.9, ..rod.clone() });
        InitialCondition { rod, tau: rod.tau(0.1 + 0.8 * s), load: 0.2 * load }
    };
    conditions(count).into_iter().map(condition).collect()
}

/// A batch has the outputs of its conditions alone, in their order, each once.
#[test]
fn outputs_keep_the_order_of_conditions() {
    for conditions in [0, 1, 16, 100, 3000].map(conditions).into_iter().chain([measured(300)]) {
        let method = method(20);
        let all: Vec<ShootingMap> = Batch::new(method).shoot(&conditions);
        let mut each = vec![None; conditions.len()];
        Batch::new(method).for_each::<ShootingMap>(conditions.iter().copied(), |i, map| {
            assert_eq!(each[i].replace(*map), None);
        });
        let all: Vec<Option<ShootingMap>> = all.into_iter().map(Some).collect();
        assert_eq!(each, all);
    }
}

/// Trajectories without derivatives reach the states of those with derivatives, up to rounding.
#[test]
fn plain_states_are_those_with_derivatives() {
    for conditions in [conditions(300), measured(300)] {
        let batch = Batch::new(method(20));
        let (plain, full) = (batch.shoot(&conditions), batch.shoot(&conditions));
        let pairs: Vec<(PlainState, FirstVariation)> = plain.into_iter().zip(full).collect();
        for (plain, full) in pairs {
            let full = full.full.plain();
            let apart = [
                plain.pole.distance(full.pole),
                plain.tangent.distance(full.tangent),
                plain.position.distance(full.position),
                (plain.force - full.force).abs() / (1.0 + full.force.abs()),
                (plain.energy - full.energy).abs() / (1.0 + full.energy),
            ];
            assert!(apart.iter().all(|part| *part < 1e-13), "{apart:?}");
        }
    }
}

/// A padded trajectory takes at least as many steps as alone. Its error is at most the largest error alone, but for rounding
/// (4.7e-14 in 20 steps).
#[test]
fn padding_keeps_the_accuracy() {
    let few = [1, 15, 16, 17, 300, 3000].map(conditions);
    for conditions in few.into_iter().chain([17, 300].map(measured)) {
        let count = conditions.len();
        let exact = Batch::new(method(128)).shoot::<ShootingMap>(&conditions);
        let worst = |found: &[ShootingMap]| {
            let pairs = found.iter().zip(&exact);
            pairs.fold(0.0, |worst, (a, b)| f64::max(worst, a.pole.distance(b.pole)))
        };
        for least in [5, 20] {
            let method = method(least);
            let alone = worst(&Batch::new(method).shoot::<ShootingMap>(&conditions));
            let padded = worst(&Batch::new(method).padded().shoot::<ShootingMap>(&conditions));
            assert!(
                padded <= alone.max(1e-13),
                "{count} in {least}: {padded:.1e}, alone {alone:.1e}"
            );
        }
    }
}

/// With equal numbers of steps, padding changes no bit.
#[test]
fn equals_padded_are_as_if_alone() {
    let one = conditions(7)[6];
    let conditions = vec![one; 37];
    let method = method(20);
    let alone = Batch::new(method).shoot::<SecondVariation>(&conditions);
    assert_eq!(Batch::new(method).padded().shoot::<SecondVariation>(&conditions), alone);
}

/// The batches are larger than a chunk, so that several threads compute their blocks.
#[test]
fn threads_change_nothing() {
    let conditions = conditions(5000);
    let method = method(7);
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| Batch::new(method).padded().shoot::<ShootingMap>(&conditions))
    });
    assert_eq!(one, three);
}

/// A condition with NaN shares a block with others.
#[test]
fn nan_stays_in_its_lane() {
    let sound = conditions(100);
    let method = method(7);
    let expected = Batch::new(method).padded().shoot::<ShootingMap>(&sound);
    let mut spoilt = sound.clone();
    spoilt[40].tau = f64::NAN;
    spoilt[41].load = f64::INFINITY;
    let found = Batch::new(method).padded().shoot::<ShootingMap>(&spoilt);
    for (i, (a, b)) in found.iter().zip(&expected).enumerate() {
        let is_spoilt = [40, 41].contains(&i);
        assert_eq!(a.pole.is_finite(), !is_spoilt, "{i}: {a:?}");
        assert!(is_spoilt || a.pole.distance(b.pole) < 1e-7, "{i}: {a:?}");
    }
}

/// With many rows one step for each piece suffices. Doubling must still double the steps.
#[test]
fn doubling_shows_the_error_of_many_rows() {
    let wave = |s: f64| (1.0 - 0.9 * s) * (1.0 + 0.1 * (150.0 * s).sin());
    let rows: Vec<[f64; 2]> =
        (0..=200).map(|i| f64::from(i) / 200.0).map(|s| [s, wave(s) / wave(0.0)]).collect();
    let rod = kept(Rod {
        taper: 1.0 - rows[200][1],
        profile: Some(Arc::new(RadiusProfile::new(&rows, 1.0))),
        ..Rod::default()
    });
    let at = |load| InitialCondition { rod, tau: rod.tau(0.7), load };
    let conditions = [0.5, 2.0, 4.0].map(at);
    let coarse = Resolution::of(3);
    let poles = |resolution| Batch::new(Method::new(resolution)).shoot::<ShootingMap>(&conditions);
    let [once, twice, exact] = [coarse, coarse.doubled(), coarse.doubled().doubled()].map(poles);
    for ((once, twice), exact) in once.iter().zip(&twice).zip(&exact) {
        let error = once.pole.distance(exact.pole);
        let estimate = once.pole.distance(twice.pole);
        assert!(error > 0.0 && estimate > 0.9 * error, "{estimate:e} {error:e}");
    }
}
