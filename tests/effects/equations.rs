//! Poles and derivatives of every set of effects, against plain equations, central differences and an integral.

use super::{conditions, with};
use crate::effect_sets;
use crate::random_rods::ROWS;
use glam::DVec2;
use whiskmap::mechanics::rod::{Side, arclength};
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::mechanics::shooting::{FirstVariation, Resolution, SecondVariation, ShootingMap};
use whiskmap::scene::Scene;

/// The pole as the base sees it, by the classical Runge-Kutta method on the equations as they are usually written: by
/// arclength, from the contact to the base, with angles. Steps end at the rows of the profile.
fn plainly(condition: &InitialCondition, steps: u32) -> DVec2 {
    let InitialCondition { rod, tau, load } = condition;
    let force = load * rod.radius(*tau).powi(2);
    let at_rest = |s: f64| match (&rod.polynomial, rod.spiral) {
        (Some(curvature), _) => curvature.at(s),
        (None, Some([k0, k1])) => k0 + k1 * s,
        (None, None) => 0.0,
    };
    let slope = |s: f64, [theta, x, _]: [f64; 3]| {
        let _ = theta;
        [at_rest(s) - force * x / rod.stiffness(s), theta.cos(), theta.sin()]
    };
    let mut y = [rod.friction.atan(), 0.0, 0.0];
    let mut from = arclength(rod, *tau);
    let rows = ROWS.iter().rev().map(|row| row[0]);
    let first = from;
    for to in rows.filter(|row| *row < first) {
        let h = (to - from) / f64::from(steps);
        for i in 0..steps {
            let s = from + h * f64::from(i);
            let add = |k: [f64; 3], h: f64| std::array::from_fn(|j| h.mul_add(k[j], y[j]));
            let k1 = slope(s, y);
            let k2 = slope(s + 0.5 * h, add(k1, 0.5 * h));
            let k3 = slope(s + 0.5 * h, add(k2, 0.5 * h));
            // A row belongs to the piece that it ends, so the end of a step may not be asked for its radius there.
            let k4 = slope(s + h * (1.0 - 1e-13), add(k3, h));
            for j in 0..3 {
                y[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
            }
        }
        from = to;
    }
    let [theta, x, y] = y;
    // The moment turns the base in its mount.
    let theta = theta + rod.mount * force * x;
    DVec2::from_angle(-theta).rotate(rod.to_pole() - DVec2::new(x, y))
}

/// Measured: 6e-12, the truncation of 2000 steps of order 4.
#[test]
fn the_pole_is_where_plain_equations_see_it() {
    for effects in effect_sets::all().filter(|e| e.profile && !e.curvature) {
        let conditions = conditions(effects, 100);
        let maps = Batch::new(with(effects, Resolution::FINE)).shoot::<ShootingMap>(&conditions);
        for (condition, map) in conditions.iter().zip(maps) {
            let apart = plainly(condition, 2000).distance(map.pole);
            assert!(apart < 1e-10, "{apart:e} {condition:?}");
        }
    }
}

/// Central differences of the map; with steps of 1e-5 they are right to 1e-8 relative or so.
#[test]
fn derivatives_agree_with_differences_in_every_set() {
    const STEP: f64 = 1e-5;
    for effects in effect_sets::all() {
        let method = with(effects, Resolution::FINE);
        for condition in conditions(effects, 40) {
            let scale = [condition.tau, condition.load.abs() + 1.0 / condition.tau.powi(2)];
            let moved = |axis: usize, sign: f64| {
                let mut moved = condition;
                [&mut moved.tau, &mut moved.load]
                    .into_iter()
                    .nth(axis)
                    .map(|value| *value += sign * STEP * scale[axis])
                    .unwrap();
                Batch::new(method).shoot::<ShootingMap>(&[moved])[0]
            };
            let here = Batch::new(method).shoot::<SecondVariation>(&[condition])[0];
            for (axis, first, second) in [
                (0, here.map.by_tau, [here.by_tau_tau, here.by_tau_load]),
                (1, here.map.by_load, [here.by_tau_load, here.by_load_load]),
            ] {
                let (after, before) = (moved(axis, 1.0), moved(axis, -1.0));
                let width = 2.0 * STEP * scale[axis];
                let ratio = DVec2::new(before.pole.x, -before.pole.y).rotate(after.pole);
                let ln =
                    DVec2::new((after.pole.length() / before.pole.length()).ln(), ratio.to_angle());
                let close = |a: DVec2, b: DVec2, unit: f64| a.distance(b) * unit < 1e-6;
                let size = scale[axis] / (1.0 + first.length() * scale[axis]);
                assert!(close(ln / width, first, size), "{effects:?} {condition:?}");
                let by = [(after.by_tau, before.by_tau), (after.by_load, before.by_load)];
                for (other, ((after, before), second)) in by.into_iter().zip(second).enumerate() {
                    let size = scale[axis] * scale[other];
                    let size = size / (1.0 + second.length() * size);
                    let found = (after - before) / width;
                    assert!(close(found, second, size), "{effects:?} {axis} {other} {condition:?}");
                }
            }
        }
    }
}

/// A light push on a straight whisker turns its base by the force times the integral of the lever over the stiffness, whose radius
/// and modulus are those at the real arclength.
#[test]
fn radius_and_modulus_are_read_at_the_real_arclength() {
    for (tip_um, tip_to_base, arc_stretch) in
        [(30.0, 1.9, 1.5), (30.0, 0.6, 1.3), (12.0, 2.5, 1.4), (12.0, 0.5, 1.0)]
    {
        let scene = Scene::parse(
            &format!(
                "title = 'drooping'\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = {tip_um}\n\
                 youngs_modulus_gpa = 3\nmodulus_gradient.tip_to_base = {tip_to_base}\n\
                 projection.arc_stretch = {arc_stretch}\n[grid]\npush_angle_deg = [1]\ndistance_mm = [15]"
            ),
            "drooping",
        )
        .unwrap();
        let rod = scene.first_whisker().rod(Side::Cb);
        let (contact, force) = (0.75, 1e-5);
        let softness = |planar: f64| {
            let real = arc_stretch * planar;
            let radius = 1.0 + (tip_um / 30.0 - 1.0) * real;
            let modulus = 1.0 + (tip_to_base - 1.0) * real;
            (contact - planar) / (modulus * radius.powi(4))
        };
        // Simpson's rule.
        let h = contact / 1000.0;
        let parts = (0..1000).map(|i| h * f64::from(i));
        let turn: f64 = parts
            .map(|s| softness(s) + 4.0 * softness(s + 0.5 * h) + softness(s + h))
            .map(|sum| force * h / 6.0 * sum)
            .sum();
        let tau = rod.tau(contact);
        let condition = InitialCondition { rod: &rod, tau, load: force / rod.radius(tau).powi(2) };
        let state = Batch::new(Method::fine()).shoot::<FirstVariation>(&[condition])[0];
        let turned = state.full.tangent.to_angle().abs();
        // What is left is of the third order in the force.
        assert!(
            (turned / turn - 1.0).abs() < 1e-9,
            "{tip_um} um, {tip_to_base}, {arc_stretch}: {turned} instead of {turn}"
        );
    }
}
