//! States with friction against an independent integration of the push.

use super::cone;
use super::stepped::SteppedWhisker;
use whiskmap::friction::Sliding;
use whiskmap::mechanics::rod::{Rest, Side};
use whiskmap::scene::Scene;
use whiskmap::trace::Branch;

/// The whisker of `scene` for the independent integration, on one side of its pole.
pub fn stepped(scene: &Scene, side: Side) -> SteppedWhisker {
    let rod = scene.whisker.rod(&scene.pole, side);
    SteppedWhisker {
        taper: rod.taper,
        bend: rod.bend,
        pole: rod.pole.abs(),
        friction: rod.friction.abs(),
        side: side.sign(),
    }
}

/// Number of steps of the push.
const PUSHES: u32 = 1500;

/// Largest relative difference of a contact that slides. Measured: 9.1e-10.
const SLIDES: f64 = 1e-9;

/// Largest relative difference of a contact that sticks. Measured: 6.2e-9.
pub const STICKS: f64 = 2e-8;

/// Returns the largest relative difference of a state in a phase from that of small steps.
pub fn allowed(sliding: Sliding) -> f64 {
    match sliding {
        Sliding::Sticks => STICKS,
        _ => SLIDES,
    }
}

/// Forces, moments, contacts and energies of all three phases are those of the independent integration.
#[test]
fn states_are_those_of_small_steps() {
    let mut counts = [0; 3];
    for (a_per_mm, radius_mm, friction, side, distance) in [
        (0.02, 0.25, 0.3, Side::Cf, 15.66),
        (0.02, 0.25, 0.3, Side::Cb, 15.66),
        (0.02, 0.0, 0.9, Side::Cf, 9.0),
        (0.04, 1.0, 0.3, Side::Cf, 15.0),
    ] {
        let scene = cone(a_per_mm, radius_mm, friction);
        let steps = stepped(&scene, side);
        let rod = scene.whisker.rod(&scene.pole, side);
        let (touch, _) = Rest::new(&rod).touch_at_distance(distance / scene.whisker.length_mm);
        let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
        let end = branch.stable_end_deg().abs().to_radians();
        // The fold is singular, where difference quotients fail.
        let pushes = (1..=PUSHES).map(|i| 0.9 * end * f64::from(i) / f64::from(PUSHES));
        let pushes: Vec<f64> = pushes.collect();
        let course = steps.course(rod.tau(touch), &pushes);
        let units = scene.whisker.units();
        for (push, wanted) in pushes.iter().zip(&course).skip(20).step_by(7) {
            let state = branch.state(side.sign() * push, true).unwrap();
            let found = branch.read(&state);
            let sliding = state.sliding.unwrap();
            let pairs = [
                (found.force_un, wanted.loaded[1].abs() * units.force_un),
                (found.base_moment_nnm, wanted.moment * units.moment_nnm),
                (found.arc_length_mm, wanted.arclength * units.length_mm),
                (found.energy_nj, wanted.energy * units.moment_nnm),
            ];
            for (found, wanted) in pairs {
                let error = (found / wanted - 1.0).abs();
                assert!(
                    error < allowed(sliding),
                    "{a_per_mm} {radius_mm} {friction} {side:?} {distance}: {} {sliding:?} {error:e}",
                    push.to_degrees()
                );
            }
            counts[sliding as usize] += 1;
        }
    }
    assert!(counts.iter().all(|count| *count > 10), "{counts:?}");
}
