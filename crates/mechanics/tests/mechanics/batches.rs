//! Batches of trajectories that want different numbers of steps: alone, or padded.

use std::sync::Arc;
use whiskmap_mechanics::rod::{RadiusProfile, Rod};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{Resolution, SecondVariation, ShootingMap};

/// A test ends soon: its rods may stay until then.
fn kept(rod: Rod) -> &'static Rod {
    Box::leak(Box::new(rod))
}

/// Contacts from next to the base to the tip, from no load to that of the fold, on slender and blunt whiskers.
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
        InitialCondition {
            rod: kept(rod.clone()),
            tau: rod.tau(s),
            load: 9.0 * load / (s * s),
        }
    };
    (0..count).map(condition).collect()
}

fn method(least: u32) -> Method {
    Method::new(Resolution::of(least))
}

/// The same on whiskers with measured radii, in contact on every piece of them.
fn measured(count: usize) -> Vec<InitialCondition<'static>> {
    let rows = [0.0, 0.2, 0.5, 0.7, 1.0].map(|s| [s, 1.0 - 0.8 * s - 0.1 * s * s]);
    let profile = Arc::new(RadiusProfile::new(&rows, 1.0));
    let condition = |InitialCondition { rod, tau, load }: InitialCondition<'static>| {
        let s = rod.radius(tau);
        let rod = kept(Rod {
            profile: Some(profile.clone()),
            taper: 0.9,
            ..rod.clone()
        });
        InitialCondition {
            rod,
            tau: rod.tau(0.1 + 0.8 * s),
            load: 0.2 * load,
        }
    };
    conditions(count).into_iter().map(condition).collect()
}

/// One after the other, every condition gets the answer that it gets in a batch, once.
#[test]
fn each_gets_its_own_answer() {
    for conditions in [0, 1, 16, 100, 3000]
        .map(conditions)
        .into_iter()
        .chain([measured(300)])
    {
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

/// Who shares a block takes at least the steps that it would take alone: nobody's answer is worse than the worst
/// alone, but for rounding (4.7e-14 in 20 steps).
#[test]
fn padding_does_no_harm() {
    let few = [1, 15, 16, 17, 300, 3000].map(conditions);
    for conditions in few.into_iter().chain([17, 300].map(measured)) {
        let count = conditions.len();
        let exact = Batch::new(method(128)).shoot::<ShootingMap>(&conditions);
        let worst = |found: &[ShootingMap]| {
            let pairs = found.iter().zip(&exact);
            pairs.fold(0.0, |worst, (a, b)| {
                f64::max(worst, a.pole.distance(b.pole))
            })
        };
        for least in [5, 20] {
            let method = method(least);
            let alone = worst(&Batch::new(method).shoot::<ShootingMap>(&conditions));
            let padded = worst(
                &Batch::new(method)
                    .padded()
                    .shoot::<ShootingMap>(&conditions),
            );
            assert!(
                padded <= alone.max(1e-13),
                "{count} in {least}: {padded:.1e}, alone {alone:.1e}"
            );
        }
    }
}

/// One number of steps for all: then padding is no different at all.
#[test]
fn equals_padded_are_as_if_alone() {
    let one = conditions(7)[6];
    let conditions = vec![one; 37];
    let method = method(20);
    let alone = Batch::new(method).shoot::<SecondVariation>(&conditions);
    assert_eq!(
        Batch::new(method)
            .padded()
            .shoot::<SecondVariation>(&conditions),
        alone
    );
}

/// Batches of more than a thread's share, whose blocks are spread over the threads.
#[test]
fn threads_change_nothing() {
    let conditions = conditions(5000);
    let method = method(7);
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| {
            Batch::new(method)
                .padded()
                .shoot::<ShootingMap>(&conditions)
        })
    });
    assert_eq!(one, three);
}

/// A condition that cannot be computed shares a block, too.
#[test]
fn no_number_hurts_only_itself() {
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

/// So many rows that a step for each piece is enough: an estimate of the error must still see twice as many.
#[test]
fn doubling_shows_the_error_of_many_rows() {
    let wave = |s: f64| (1.0 - 0.9 * s) * (1.0 + 0.1 * (150.0 * s).sin());
    let rows: Vec<[f64; 2]> = (0..=200)
        .map(|i| f64::from(i) / 200.0)
        .map(|s| [s, wave(s) / wave(0.0)])
        .collect();
    let rod = kept(Rod {
        taper: 1.0 - rows[200][1],
        profile: Some(Arc::new(RadiusProfile::new(&rows, 1.0))),
        ..Rod::default()
    });
    let at = |load| InitialCondition {
        rod,
        tau: rod.tau(0.7),
        load,
    };
    let conditions = [0.5, 2.0, 4.0].map(at);
    let coarse = Resolution::of(3);
    let poles = |resolution| Batch::new(Method::new(resolution)).shoot::<ShootingMap>(&conditions);
    let [once, twice, exact] = [coarse, coarse.doubled(), coarse.doubled().doubled()].map(poles);
    for ((once, twice), exact) in once.iter().zip(&twice).zip(&exact) {
        let error = once.pole.distance(exact.pole);
        let estimate = once.pole.distance(twice.pole);
        assert!(
            error > 0.0 && estimate > 0.9 * error,
            "{estimate:e} {error:e}"
        );
    }
}
