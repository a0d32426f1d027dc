//! The integrator: order and exactness.

use glam::DVec2;
use whiskmap_mechanics::rod::{Effects, Rod};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{
    NoSensitivity, Resolution, RodSystem, Scales, Section, ShootingMap, Straight, Uniform,
    integrate,
};

const EFFECTS: Effects = Effects {
    taper: true,
    curvature: true,
    spiral: false,
    polynomial: false,
    gradient: true,
    profile: false,
};

pub(super) fn steps(least: u32) -> Method {
    Method::new(Resolution { least, longest: 0.4, fewest: 1 }).with_effects(EFFECTS)
}

pub(super) fn rods() -> Vec<InitialCondition<'static>> {
    let mut conditions = Vec::new();
    for taper in [0.0, 0.3, 0.95, 0.99] {
        for bend in [0.0, 0.4, 0.8] {
            for (pole, load) in [(0.0125, 5.0), (-0.0125, -5.0)] {
                let rod = Rod {
                    taper,
                    bend,
                    slope: -0.1 * bend,
                    pole,
                    gradient: 0.4 + 50.0 * pole,
                    friction: 10.0 * pole,
                    ..Rod::default()
                };
                let tau = rod.tau(0.9);
                conditions.push(InitialCondition { rod: Box::leak(Box::new(rod)), tau, load });
            }
        }
    }
    conditions
}

/// Position of the base of a straight cylinder without friction under `load`.
fn end(load: f64, steps: u32) -> DVec2 {
    let system = RodSystem { force: load, intrinsic: Straight, material: Uniform };
    let h = 0.9 / f64::from(steps);
    let section = Section { rho: 1.0, inverse_cube: 1.0, arclength: 0.9 };
    let contact = ((), ([1.0, 0.0, 0.0, 0.0, 0.0], ((), ((), ()))));
    let scales = Scales::cylinder(h);
    let (_, ([_, _, x, y, _], _)) =
        integrate::<f64, _, _, NoSensitivity>(&system, &scales, section, steps, contact, &mut ());
    DVec2::new(x, y)
}

/// Halving the step divides the error by `2^order`. The factor is measured between the errors of coarse steps and rounding.
#[test]
fn the_integrator_has_its_order() {
    let error = |steps| end(5.0, steps).distance(end(5.0, 2048));
    let order = (error(3) / error(6)).log2();
    assert!((7.3..9.0).contains(&order), "{order}");
}

/// The order of the largest error in a batch whose rods have all compatible effects. (With fewer steps the remainder of the rest
/// shape's series falls faster; with more steps rounding dominates.)
#[test]
fn batches_have_the_order() {
    let conditions = rods();
    let poles = |least: u32| Batch::new(steps(least)).shoot::<ShootingMap>(&conditions);
    let [rough, half, exact] = [10, 20, 128].map(poles);
    let error = |found: &[ShootingMap], i: usize| found[i].pole.distance(exact[i].pole);
    let worst = (0..conditions.len())
        .max_by(|&i, &j| error(&rough, i).total_cmp(&error(&rough, j)))
        .unwrap();
    let InitialCondition { rod, tau, load } = &conditions[worst];
    let taken = |least| f64::from(steps(least).resolution.steps(rod, *tau, *load));
    let order = (error(&rough, worst) / error(&half, worst)).ln() / (taken(20) / taken(10)).ln();
    assert!((7.3..9.0).contains(&order), "{order}");
}

/// Errors of the finest resolution in use are below 1e-11 up to taper 0.99.
#[test]
fn the_fine_resolution_is_exact() {
    let fine = Method::fine().with_effects(EFFECTS);
    let exact = Batch::new(steps(512)).shoot::<ShootingMap>(&rods());
    for (a, b) in exact.iter().zip(Batch::new(fine).shoot::<ShootingMap>(&rods())) {
        assert!(a.pole.distance(b.pole) < 1e-11, "{} {}", a.pole, b.pole);
    }
}
