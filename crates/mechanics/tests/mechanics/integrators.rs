//! The integrators and the derivatives that they carry.

use glam::DVec2;
use num_dual::{DualNum, HyperDual64, second_partial_derivative};
use std::ops::{Add, Div, Mul, Neg, Sub};
use whiskmap_mechanics::numerics::{Real, Vector};
use whiskmap_mechanics::rod::{Effects, Rod, RodDerivative};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{
    Graded, Integrator, Intrinsic, Material, NoSensitivity, Nystrom8, Planar, Resolution,
    RodSystem, STAGES, Scales, SecondVariation, Section, Sensitivity, ShootingMap, Straight,
    TrajectoryState, TrajectoryVariable, Uniform, differentiate, integrate,
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
struct Rk4;

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

fn steps(least: u32) -> Method {
    Method::new(Resolution {
        least,
        longest: 0.4,
        fewest: 1,
    })
    .with_effects(EFFECTS)
}

fn rods() -> Vec<InitialCondition<'static>> {
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
const NOTHING: ((), ((), ())) = ((), ((), ()));

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
    let (_, ([_, _, x, y, _], _)) =
        integrate::<M, f64, _, _, NoSensitivity>(&system, &scales, section, steps, contact);
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

/// A hyper-dual number as the scalar.
#[derive(Clone, Copy, Debug)]
struct Dual(HyperDual64);

macro_rules! operator {
    ($op:ident, $method:ident) => {
        impl $op for Dual {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for Dual {
    fn of(x: f64) -> Self {
        Self(HyperDual64::from(x))
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
}

/// `(ln D, phi)` of a straight, tapered, graded rod on a rough pole, differentiated by num-dual through the whole integration.
fn ln_pole(rod: &Rod, tau: HyperDual64, load: HyperDual64) -> [HyperDual64; 2] {
    let [taper, gradient] = [rod.taper, rod.gradient].map(HyperDual64::from);
    ln_pole_of(rod, [taper, gradient], [tau, load])
}

/// `(ln D, phi)` as [`ln_pole`], for another taper and gradient.
fn ln_pole_of(
    rod: &Rod,
    [taper, gradient]: [HyperDual64; 2],
    [tau, load]: [HyperDual64; 2],
) -> [HyperDual64; 2] {
    let rho = (-tau * taper).exp();
    let steps = 256;
    let h = Dual(tau / f64::from(steps));
    let system = RodSystem {
        force: Dual(load * rho * rho),
        intrinsic: Straight,
        material: Graded {
            gradient: Dual(gradient),
        },
    };
    let from = Section {
        rho: Dual(rho),
        inverse_cube: Dual((rho * rho * rho).recip()),
        arclength: Dual((rho * -1.0 + 1.0) / taper),
    };
    let scales = Scales::tapered::<Rk4>(Dual(taper), h);
    let DVec2 { x, y } = rod.contact_tangent();
    let contact: Planar<Dual> = [x, y, 0.0, 0.0, 0.0].map(Dual::of);
    let (_, (end, _)) = integrate::<Rk4, _, _, _, NoSensitivity>(
        &system,
        &scales,
        from,
        steps,
        ((), (contact, NOTHING)),
    );
    let [c, s, x, y, _] = end.map(|dual| dual.0);
    let (wx, wy) = (-x + rod.to_pole().x, -y + rod.to_pole().y);
    let ln_distance = (wx * wx + wy * wy).ln() * 0.5;
    [ln_distance, wy.atan2(wx) - s.atan2(c)]
}

/// First and second derivatives against automatic differentiation of 256 RK4 steps (measured difference: 2e-8, relative). With a
/// gradient the kernel carries all derivatives. Without, it carries those by the load, and near the tip (a contact at 0.98 of the
/// steepest cone) all of them.
#[test]
fn sensitivities_agree_with_num_dual() {
    let poles = [(0.0, 3.0), (0.0125, 6.0), (-0.05, -6.0)];
    let contacts = [(0.1, 0.8), (0.7, 0.8), (0.95, 0.8), (0.95, 0.98)];
    for (taper, s) in contacts {
        for ((pole, load), is_graded) in poles.into_iter().flat_map(|p| [(p, true), (p, false)]) {
            let rod = Rod {
                taper,
                bend: 0.0,
                slope: 0.0,
                pole,
                gradient: if is_graded { 0.6 - 10.0 * pole } else { 0.0 },
                friction: -6.0 * pole,
                ..Rod::default()
            };
            let tau = rod.tau(s);
            let method = Method::new(steps(128).resolution);
            let hand = Batch::new(method).shoot::<SecondVariation>(&[InitialCondition {
                rod: &rod,
                tau,
                load,
            }])[0];
            for (i, (name, pick)) in PICKS.iter().enumerate() {
                for axis in 0..2 {
                    let dual = second(&rod, tau, load, axis, i);
                    let own = pick(&hand)[axis];
                    let scale = pick(&hand).length();
                    assert!(
                        (dual - own).abs() < 1e-6 * scale,
                        "{name}[{axis}] at taper {taper}, load {load}: {own}, num-dual {dual}"
                    );
                }
            }
        }
    }
}

/// Derivatives of the shooting map by taper and modulus, and those of its derivative by the load, against automatic differentiation of 256
/// RK4 steps (measured difference: 3e-9, relative).
#[test]
fn derivatives_by_the_rod_agree_with_num_dual() {
    for (taper, pole, load) in [(0.1, 0.0, 3.0), (0.7, 0.0125, 6.0), (0.95, -0.05, -6.0)] {
        let rod = Rod {
            taper,
            pole,
            gradient: 0.6 - 10.0 * pole,
            friction: -6.0 * pole,
            ..Rod::default()
        };
        let tau = rod.tau(0.8);
        let condition = InitialCondition {
            rod: &rod,
            tau,
            load,
        };
        let by_taper = RodDerivative {
            taper: 1.0,
            ..RodDerivative::default()
        };
        let by_gradient = RodDerivative {
            gradient: 1.0,
            ..RodDerivative::default()
        };
        let variables = [&by_taper, &by_gradient].map(TrajectoryVariable::Rod);
        let (_, own) = differentiate(Resolution::of(128), &condition, &variables);
        for (i, value) in [rod.taper, rod.gradient].into_iter().enumerate() {
            let at = |axis: usize| {
                let along = |(moved, load): (HyperDual64, HyperDual64)| {
                    let mut numbers = [rod.taper, rod.gradient].map(HyperDual64::from);
                    numbers[i] = moved;
                    ln_pole_of(&rod, numbers, [HyperDual64::from(tau), load])[axis]
                };
                second_partial_derivative(along, (value, load))
            };
            let [ln_d, phi] = [0, 1].map(at);
            let first = DVec2::new(ln_d.1, phi.1);
            let mixed = DVec2::new(ln_d.3, phi.3);
            for (own, dual) in [(own[i].ln_pole, first), (own[i].by_load, mixed)] {
                let apart = own.distance(dual) / dual.length();
                assert!(apart < 1e-7, "{i} at taper {taper}: {own}, num-dual {dual}");
            }
        }
    }
}

type Pick = fn(&SecondVariation) -> DVec2;

const PICKS: [(&str, Pick); 5] = [
    ("by_tau", |c| c.map.by_tau),
    ("by_load", |c| c.map.by_load),
    ("by_tau_load", |c| c.by_tau_load),
    ("by_tau_tau", |c| c.by_tau_tau),
    ("by_load_load", |c| c.by_load_load),
];

fn second(rod: &Rod, tau: f64, load: f64, axis: usize, which: usize) -> f64 {
    let mixed = |f: &dyn Fn(HyperDual64, HyperDual64) -> HyperDual64, x: f64, y: f64| {
        second_partial_derivative(|(a, b)| f(a, b), (x, y))
    };
    let at = |tau, load| ln_pole(rod, tau, load)[axis];
    match which {
        0 => mixed(&at, tau, load).1,
        1 => mixed(&at, tau, load).2,
        2 => mixed(&at, tau, load).3,
        // f(a + b) has d2/dadb = f''.
        3 => mixed(&|a, b| at(a + b, HyperDual64::from(load)), tau, 0.0).3,
        _ => mixed(&|a, b| at(HyperDual64::from(tau), a + b), load, 0.0).3,
    }
}

/// Derivatives on curved rods against central differences of one order less (measured difference: 3e-9, relative).
#[test]
fn sensitivities_of_curved_rods_agree_with_differences() {
    for condition in rods().iter().filter(|condition| condition.rod.bend > 0.0) {
        let at = |tau: f64, load: f64| {
            Batch::new(steps(128)).shoot::<SecondVariation>(&[InitialCondition {
                rod: condition.rod,
                tau,
                load,
            }])[0]
        };
        let (tau, load) = (condition.tau, condition.load);
        let h = 1e-4;
        let here = at(tau, load);
        let difference = |pick: fn(&ShootingMap) -> DVec2, dt: f64, dl: f64| {
            let f = |k: f64| pick(&at(tau + k * dt, load + k * dl).map);
            (8.0 * (f(1.0) - f(-1.0)) - (f(2.0) - f(-2.0))) / 12.0
        };
        let by_tau: fn(&ShootingMap) -> DVec2 = |l| l.by_tau;
        let by_load: fn(&ShootingMap) -> DVec2 = |l| l.by_load;
        let ln_pole: fn(&ShootingMap) -> DVec2 =
            |l| DVec2::new(l.pole.length().ln(), l.pole.to_angle());
        for (name, exact, numeric) in [
            ("by_tau", here.map.by_tau, difference(ln_pole, h, 0.0) / h),
            ("by_load", here.map.by_load, difference(ln_pole, 0.0, h) / h),
            (
                "by_tau_tau",
                here.by_tau_tau,
                difference(by_tau, h, 0.0) / h,
            ),
            (
                "by_tau_load",
                here.by_tau_load,
                difference(by_load, h, 0.0) / h,
            ),
            (
                "by_load_load",
                here.by_load_load,
                difference(by_load, 0.0, h) / h,
            ),
        ] {
            let miss = exact.distance(numeric) / exact.length();
            assert!(
                miss < 1e-5,
                "{name} of {condition:?}: {exact}, differences {numeric}"
            );
        }
    }
}
