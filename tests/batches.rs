//! Batches of trajectories that want different numbers of steps: alone, or in company.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use whiskmap::rod::{Effects, RadiusProfile, Rod};
use whiskmap::shooting::batch::{InitialCondition, Method, shoot, shoot_each, shoot_padded};
use whiskmap::shooting::{First, Nystrom8, Resolution, Second, ShootingMap};

/// Contacts from next to the base to the tip, from no load to that of the fold, on slender and blunt whiskers.
fn conditions(count: usize) -> Vec<InitialCondition> {
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
            rod,
            tau: rod.tau(s),
            load: 9.0 * load / (s * s),
        }
    };
    (0..count).map(condition).collect()
}

fn method(least: u32, conditions: &[InitialCondition]) -> Method {
    Method {
        effects: Effects::of(conditions.iter().map(|condition| &condition.rod)),
        resolution: Resolution::of(least),
    }
}

/// The same on whiskers with measured radii, in contact on every piece of them.
fn measured(count: usize) -> Vec<InitialCondition> {
    let rows = [0.0, 0.2, 0.5, 0.7, 1.0].map(|s| [s, 1.0 - 0.8 * s - 0.1 * s * s]);
    let profile = Some(RadiusProfile::of(&rows, 1.0));
    let condition = |InitialCondition { rod, tau, load }: InitialCondition| {
        let s = rod.radius(tau);
        let rod = Rod {
            profile,
            taper: 0.9,
            ..rod
        };
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
        let method = method(20, &conditions);
        let together = shoot::<Nystrom8, First>(method, &conditions);
        let mut each = vec![None; conditions.len()];
        shoot_each::<Nystrom8, First>(method, conditions.iter().copied(), |i, map| {
            assert_eq!(each[i].replace(*map), None);
        });
        let together: Vec<Option<ShootingMap>> = together.into_iter().map(Some).collect();
        assert_eq!(each, together);
    }
}

/// Who shares a block takes at least the steps that it would take alone: nobody's answer is worse than the worst
/// alone, but for rounding (4.7e-14 in 20 steps).
#[test]
fn company_does_no_harm() {
    let few = [1, 15, 16, 17, 300, 3000].map(conditions);
    for conditions in few.into_iter().chain([17, 300].map(measured)) {
        let count = conditions.len();
        let exact = shoot::<Nystrom8, First>(method(128, &conditions), &conditions);
        let worst = |found: &[ShootingMap]| {
            let pairs = found.iter().zip(&exact);
            pairs.fold(0.0, |worst, (a, b)| {
                f64::max(worst, a.pole.distance(b.pole))
            })
        };
        for least in [5, 20] {
            let method = method(least, &conditions);
            let alone = worst(&shoot::<Nystrom8, First>(method, &conditions));
            let company = worst(&shoot_padded::<Nystrom8, First>(method, &conditions));
            assert!(
                company <= alone.max(1e-13),
                "{count} in {least}: {company:.1e}, alone {alone:.1e}"
            );
        }
    }
}

/// One number of steps for all: then company is no different at all.
#[test]
fn equals_in_company_are_as_if_alone() {
    let one = conditions(7)[6];
    let conditions = vec![one; 37];
    let method = method(20, &conditions);
    let alone = shoot::<Nystrom8, Second>(method, &conditions);
    assert_eq!(shoot_padded::<Nystrom8, Second>(method, &conditions), alone);
}

/// Batches of more than a thread's share, whose blocks are spread over the threads.
#[test]
fn threads_change_nothing() {
    let conditions = conditions(5000);
    let method = method(7, &conditions);
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| shoot_padded::<Nystrom8, First>(method, &conditions))
    });
    assert_eq!(one, three);
}

/// A condition that cannot be computed has company, too.
#[test]
fn no_number_hurts_only_itself() {
    let sound = conditions(100);
    let method = method(7, &sound);
    let expected = shoot_padded::<Nystrom8, First>(method, &sound);
    let mut spoilt = sound.clone();
    spoilt[40].tau = f64::NAN;
    spoilt[41].load = f64::INFINITY;
    let found = shoot_padded::<Nystrom8, First>(method, &spoilt);
    for (i, (a, b)) in found.iter().zip(&expected).enumerate() {
        let is_spoilt = [40, 41].contains(&i);
        assert_eq!(a.pole.is_finite(), !is_spoilt, "{i}: {a:?}");
        assert!(is_spoilt || a.pole.distance(b.pole) < 1e-7, "{i}: {a:?}");
    }
}
