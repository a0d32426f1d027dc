//! What Newton's method says of a state without a trajectory there, against trajectories.
#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "tests may panic, and tell what they measured"
)]

use crate::effect_sets;
use crate::random_rods;
use crate::shipped;

use glam::DVec2;
use whiskmap::mechanics::rod::{Effects, Rod, Side, arclength};
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::mechanics::shooting::{
    FirstVariation, FullState, Resolution, SecondVariation, ShootingMap, StateDerivative,
};
use whiskmap::refine::{TOLERANCE, states};
use whiskmap::scene::Scene;
use whiskmap::sheet::Sheet;

/// Random states on random rods with these effects, those of the engines' tests.
fn conditions(effects: Effects) -> Vec<InitialCondition<'static>> {
    random_rods::conditions(effects, 40, 6.0, 7)
}

/// `(tau, load)` over which a state changes by about as much as it is.
fn scale(condition: &InitialCondition) -> DVec2 {
    let s = arclength(condition.rod, condition.tau);
    DVec2::new(s, condition.load.abs() + 1.0 / (s * s))
}

fn moved<'a>(condition: &InitialCondition<'a>, step: DVec2) -> InitialCondition<'a> {
    InitialCondition { tau: condition.tau + step.x, load: condition.load + step.y, ..*condition }
}

/// Angle of the tangent (from that of `near`), place, force and energy.
fn numbers(full: &FullState, near: &FullState) -> [f64; 5] {
    let angle = near.tangent.perp_dot(full.tangent);
    let place = full.position;
    [angle, place.x, place.y, full.force, full.energy]
}

fn listed(change: &StateDerivative) -> [f64; 5] {
    let StateDerivative { angle, position, force, energy } = *change;
    [angle, position.x, position.y, force, energy]
}

/// Every [`StateDerivative`] is the derivative of what it names, for every set of effects and on both sides of what a kernel
/// carries; central differences leave 3.2e-8 (measured) of it.
#[test]
fn a_state_changes_as_it_says() {
    let mut worst = 0.0_f64;
    for effects in effect_sets::all() {
        let method = Method::fine().with_effects(effects);
        let conditions = conditions(effects);
        let here: Vec<FirstVariation> = Batch::new(method).shoot::<FirstVariation>(&conditions);
        for axis in [DVec2::X, DVec2::Y] {
            let step = |condition: &InitialCondition| 1e-4 * axis * scale(condition);
            let [before, after] = [-1.0, 1.0].map(|sign| {
                let there: Vec<InitialCondition> = conditions
                    .iter()
                    .map(|condition| moved(condition, sign * step(condition)))
                    .collect();
                Batch::new(method).shoot::<FirstVariation>(&there)
            });
            for (i, condition) in conditions.iter().enumerate() {
                let by = if axis == DVec2::X { here[i].by_tau } else { here[i].by_load };
                let full = &here[i].full;
                let [low, high] = [&before[i], &after[i]].map(|m| numbers(&m.full, full));
                let width = scale(condition).dot(axis);
                let sizes = numbers(full, full);
                for (k, change) in listed(&by).into_iter().enumerate() {
                    let difference = (high[k] - low[k]) / 2e-4;
                    let size = 1.0 + sizes[k].abs() + difference.abs();
                    let apart = (width * change - difference).abs() / size;
                    worst = worst.max(apart);
                    assert!(apart < 3e-7, "{effects:?} {axis} {k} {condition:?}: {apart:e}");
                }
            }
        }
    }
    eprintln!("worst {worst:.1e}");
}

/// A map with second derivatives, moved, is the map there: the pole to third order, the first derivatives to second.
#[test]
fn taylor_extrapolation_is_of_second_order() {
    let mut worst = [0.0_f64; 2];
    for effects in effect_sets::all() {
        let method = Method::fine().with_effects(effects);
        let conditions = conditions(effects);
        let here = Batch::new(method).shoot::<SecondVariation>(&conditions);
        let step = |condition: &InitialCondition| 1e-4 * DVec2::new(0.6, -0.8) * scale(condition);
        let there: Vec<InitialCondition> =
            conditions.iter().map(|condition| moved(condition, step(condition))).collect();
        let there = Batch::new(method).shoot::<ShootingMap>(&there);
        for ((condition, here), there) in conditions.iter().zip(&here).zip(&there) {
            let found = here.extrapolated(step(condition)).map;
            let size = scale(condition);
            let reach = there.pole.length() + size.x;
            let turned = (found.by_tau - there.by_tau).length() * size.x
                + (found.by_load - there.by_load).length() * size.y;
            let reach_part = reach / there.pole.length();
            worst[0] = worst[0].max((found.pole - there.pole).length() / reach);
            worst[1] = worst[1].max(turned / reach_part.powi(3));
        }
    }
    eprintln!("worst {worst:?}");
    // Steps of 1e-4: their cube is 1e-12, their square 1e-8. Measured 2.4e-12 and 2.2e-8.
    assert!(worst[0] < 3e-11 && worst[1] < 3e-7);
}

/// Whiskers of rough radii, whose rows are followed by continuation: 60 rows with 30 % of noise; a waist before a bulge, on a rough pole, of a modulus that
/// rises.
fn rough() -> [Scene; 2] {
    const LAST: u32 = 59;
    let mut random = random_rods::Random::new(3);
    let row = |i: u32| {
        let s = f64::from(i) / f64::from(LAST);
        [20.0 * s, 30.0 * (1.0 - 0.95 * s) * random.between(0.7, 1.3)]
    };
    let rows: Vec<[f64; 2]> = (0..=LAST).map(row).collect();
    let waist = "[[0, 30], [5, 28], [6, 9], [7, 60], [9, 40], [12, 14], [16, 9], [20, 2]]";
    let more = "[whisker.modulus_gradient]\ntip_to_base = 3\n[contact]\nfriction = 0.3\n";
    let scene = |rows: &str, more: &str| {
        let text = format!(
            "title = \"rough\"\n[whisker]\nlength_mm = 20\nyoungs_modulus_gpa = 3\n\
             [whisker.profile]\nrows = {rows}\n[whisker.curvature]\nparabola_per_mm = 0.02\n\
             {more}[pole]\nradius_mm = 0.25\n[grid]\npush_angle_deg = {{ from = -70, to = 70, count = 128 }}\n\
             distance_mm = {{ from = 2, to = 20, count = 256 }}\n"
        );
        Scene::parse(&text, "rough").unwrap()
    };
    [scene(&format!("{rows:?}"), ""), scene(waist, more)]
}

/// The residual of a refined state bounds what a trajectory finds there, at every resolution.
#[test]
fn residuals_are_bounds() {
    let scenes = ["cone", "measured", "cylinder", "euler_spiral", "traced", "fig4_whisker"];
    let shipped = scenes.map(|name| {
        let scene = shipped::scene(name);
        (name, scene)
    });
    for (name, scene) in shipped.into_iter().chain(rough().map(|scene| ("rough", scene))) {
        let whisker = scene.first_whisker().whisker;
        for side in Side::BOTH {
            let rod = whisker.rod(&scene.pole, side);
            for least in [3, 5, 9, 18] {
                let method = Method::new(Resolution::of(least));
                let length = whisker.length_mm;
                let distances = scene.grid.distance_mm.iter().map(|d| d / length);
                let distances: Vec<f64> = distances.step_by(16).collect();
                let sheet = Sheet::new(method, &rod, side, &distances);
                let found = states(method, &sheet, &scene.grid.push_angle_deg);
                assert!(!found.is_empty());
                let conditions: Vec<InitialCondition> = found
                    .iter()
                    .map(|(_, state)| InitialCondition::new(&rod, state.point))
                    .collect();
                let shot = Batch::new(method).shoot::<ShootingMap>(&conditions);
                for ((shot, state), map) in found.iter().zip(shot) {
                    let residual = map.pole.distance(shot.pole);
                    assert!(
                        residual <= state.residual && state.residual <= TOLERANCE,
                        "{name} {side:?} x{least}: {residual:e}, said {:e}",
                        state.residual
                    );
                }
            }
        }
    }
}

/// The energy is a small difference toward the tip of a cone: the finest default steps keep 7 digits of it where the radius is a
/// millionth of the base's. Measured 6e-12 and 1.3e-8.
#[test]
fn the_energy_is_known_toward_the_tip() {
    let rod = Rod { taper: 1.0, ..Rod::default() };
    for (radius, bound) in [(1e-3, 1e-10), (1e-6, 1e-7)] {
        let (tau, load) = (-f64::ln(radius), 6.0);
        let energy = |resolution: Resolution| {
            let method = Method::new(resolution);
            Batch::new(method).shoot::<FirstVariation>(&[InitialCondition::new(&rod, (tau, load))])
                [0]
            .full
            .energy
        };
        let (energy, finer) = (energy(Resolution::FINE), energy(Resolution::FINE.doubled()));
        let apart = (energy / finer - 1.0).abs();
        eprintln!("{radius}: {energy:e}, {apart:e}");
        assert!(apart < bound, "{radius}: {apart:e}");
    }
}
