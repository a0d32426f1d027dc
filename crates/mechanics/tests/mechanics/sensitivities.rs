//! Derivatives that a trajectory carries, against automatic differentiation and differences.

use super::integrators::{rods, steps};
use glam::DVec2;
use num_dual::{DualNum, HyperDual64, second_partial_derivative};
use whiskmap_mechanics::rod::{Rod, RodDerivative};
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap_mechanics::shooting::{
    Resolution, SecondVariation, ShootingMap, TrajectoryVariable, differentiate,
};

/// `(ln D, phi)` of a straight, tapered, graded rod on a rough pole, differentiated by num-dual through the whole integration.
fn ln_pole(rod: &Rod, tau: HyperDual64, load: HyperDual64) -> [HyperDual64; 2] {
    let [taper, gradient] = [rod.taper, rod.gradient].map(HyperDual64::from);
    ln_pole_of(rod, [taper, gradient], [tau, load])
}

/// Steps of the classical Runge-Kutta method of order 4.
const STEPS: u32 = 256;

/// `(ln D, phi)` as [`ln_pole`], for another taper and gradient.
fn ln_pole_of(
    rod: &Rod,
    [taper, gradient]: [HyperDual64; 2],
    [tau, load]: [HyperDual64; 2],
) -> [HyperDual64; 2] {
    let force = load * (tau * taper * -2.0).exp();
    let h = tau / f64::from(STEPS);
    // The right-hand side of the rod's equations at the distance `sigma` from the contact.
    let slope = |sigma: HyperDual64, [c, s, x, _]: [HyperDual64; 4]| {
        let rho = ((sigma - tau) * taper).exp();
        let modulus = (-rho + 1.0) / taper * gradient + 1.0;
        let bend = force * x / (modulus * rho * rho * rho);
        [-bend * s, bend * c, -rho * c, -rho * s]
    };
    let DVec2 { x, y } = rod.contact_tangent();
    let mut state = [x, y, 0.0, 0.0].map(HyperDual64::from);
    for step in 0..STEPS {
        let from = h * f64::from(step);
        let after = |part: f64, k: [HyperDual64; 4]| {
            let moved = std::array::from_fn(|i| state[i] + h * part * k[i]);
            slope(from + h * part, moved)
        };
        let k1 = slope(from, state);
        let k2 = after(0.5, k1);
        let k3 = after(0.5, k2);
        let k4 = after(1.0, k3);
        state =
            std::array::from_fn(|i| state[i] + h * (k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i]) / 6.0);
    }
    let [c, s, x, y] = state;
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
                    let by_hand = pick(&hand)[axis];
                    let scale = pick(&hand).length();
                    assert!(
                        (dual - by_hand).abs() < 1e-6 * scale,
                        "{name}[{axis}] at taper {taper}, load {load}: {by_hand}, num-dual {dual}"
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
        let condition = InitialCondition { rod: &rod, tau, load };
        let by_taper = RodDerivative { taper: 1.0, ..RodDerivative::default() };
        let by_gradient = RodDerivative { gradient: 1.0, ..RodDerivative::default() };
        let variables = [&by_taper, &by_gradient].map(TrajectoryVariable::Rod);
        let (_, by) = differentiate(Resolution::of(128), &condition, &variables);
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
            for (found, dual) in [(by[i].ln_pole, first), (by[i].by_load, mixed)] {
                let apart = found.distance(dual) / dual.length();
                assert!(apart < 1e-7, "{i} at taper {taper}: {found}, num-dual {dual}");
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
            ("by_tau_tau", here.by_tau_tau, difference(by_tau, h, 0.0) / h),
            ("by_tau_load", here.by_tau_load, difference(by_load, h, 0.0) / h),
            ("by_load_load", here.by_load_load, difference(by_load, 0.0, h) / h),
        ] {
            let miss = exact.distance(numeric) / exact.length();
            assert!(miss < 1e-5, "{name} of {condition:?}: {exact}, differences {numeric}");
        }
    }
}
