//! The integrators: order and exactness.

use glam::DVec2;
use whiskmap_mechanics::numerics::{Real, Vector};
use whiskmap_mechanics::rod::{Effects, Rod};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{
    Integrator, Intrinsic, Material, NoSensitivity, Nystrom8, Resolution, RodSystem, STAGES,
    Scales, Section, Sensitivity, ShootingMap, Straight, TrajectoryState, Uniform, integrate,
};

const EFFECTS: Effects = Effects {
    taper: true,
    curvature: true,
    spiral: false,
    polynomial: false,
    gradient: true,
    profile: false,
};

/// The classical Runge-Kutta method of order 4, directly from the right-hand sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rk4;

impl Integrator for Rk4 {
    // The two middle stages share a node.
    const NODES: [f64; STAGES] = [0.0, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];

    #[inline(always)]
    fn step<T: Real, I: Intrinsic<T>, C: Material<T>, S: Sensitivity<T>>(
        system: &RodSystem<T, I, C>,
        scales: &Scales<T>,
        from: Section<T>,
        y: TrajectoryState<T, I, S>,
    ) -> TrajectoryState<T, I, S> {
        let h = scales.end().sigma;
        let half = T::of(0.5) * h;
        let (middle, end) = (from.at(scales.stage(1)), from.at(scales.end()));
        let k1 = system.rhs::<S>(from, y);
        let k2 = system.rhs::<S>(middle, y.plus(half, k1));
        let k3 = system.rhs::<S>(middle, y.plus(half, k2));
        let k4 = system.rhs::<S>(end, y.plus(h, k3));
        let sixth = T::of(1.0 / 6.0) * h;
        let third = T::of(1.0 / 3.0) * h;
        y.plus(sixth, k1)
            .plus(third, k2)
            .plus(third, k3)
            .plus(sixth, k4)
    }
}

pub(super) fn steps(least: u32) -> Method {
    Method::new(Resolution {
        least,
        longest: 0.4,
        fewest: 1,
    })
    .with_effects(EFFECTS)
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
                conditions.push(InitialCondition {
                    rod: Box::leak(Box::new(rod)),
                    tau,
                    load,
                });
            }
        }
    }
    conditions
}

/// Carried derivatives of a shape.
pub(super) const NOTHING: ((), ((), ())) = ((), ((), ()));

/// Position of the base of a straight cylinder without friction under `load`.
fn end<M: Integrator>(load: f64, steps: u32) -> DVec2 {
    let system = RodSystem {
        force: load,
        intrinsic: Straight,
        material: Uniform,
    };
    let h = 0.9 / f64::from(steps);
    let section = Section {
        rho: 1.0,
        inverse_cube: 1.0,
        arclength: 0.9,
    };
    let contact = ((), ([1.0, 0.0, 0.0, 0.0, 0.0], NOTHING));
    let scales = Scales::cylinder::<M>(h);
    let (_, ([_, _, x, y, _], _)) = integrate::<M, f64, _, _, NoSensitivity>(
        &system,
        &scales,
        section,
        steps,
        contact,
        &mut (),
    );
    DVec2::new(x, y)
}

/// Halving the step divides the error by `2^order`. The factor is measured between the errors of coarse steps and rounding.
#[test]
fn integrators_have_their_order() {
    fn order<M: Integrator>(steps: u32) -> f64 {
        let error = |steps| end::<M>(5.0, steps).distance(end::<M>(5.0, 2048));
        (error(steps) / error(2 * steps)).log2()
    }
    let (rk4, nystrom8) = (order::<Rk4>(32), order::<Nystrom8>(3));
    assert!((3.7..4.8).contains(&rk4), "RK4 has order {rk4}");
    assert!(
        (7.3..9.0).contains(&nystrom8),
        "Nystrom8 has order {nystrom8}"
    );
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
    for (a, b) in exact
        .iter()
        .zip(Batch::new(fine).shoot::<ShootingMap>(&rods()))
    {
        assert!(a.pole.distance(b.pole) < 1e-11, "{} {}", a.pole, b.pole);
    }
}
