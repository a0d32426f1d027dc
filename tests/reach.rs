//! Distances at the reach of the resting whisker: its shape at rest decides, whatever taper and resolution.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod compute;

use compute::compute_as;
use whiskmap::accuracy::cheapest;
use whiskmap::classify::Regime;
use whiskmap::integrate::Cpu;
use whiskmap::plan::Plan;
use whiskmap::rod::Side;
use whiskmap::scene::Scene;
use whiskmap::shooting::Resolution;
use whiskmap::trace::{DetachmentKind, curve_at};

const LENGTH_MM: f64 = 20.0;

/// Distances over the length: well within reach, as near as a tenth of a micrometre, at it but for rounding, and beyond.
const DISTANCES: [f64; 7] = [
    0.9,
    1.0 - 5e-9,
    1.0 - 1e-15,
    1.0,
    1.0 + 1e-15,
    1.0 + 5e-9,
    1.01,
];

const REACHED: usize = 5;

const PUSHES: &str = "[-120, -70, -10, -1, 0, 1, 10, 70, 120]";

fn scene(pole: f64, friction: f64) -> Scene {
    let distances = DISTANCES.map(|d| d * LENGTH_MM);
    let text = format!(
        "title = \"straight\"\n[whisker]\nlength_mm = {LENGTH_MM:?}\nbase_radius_um = 30\nyoungs_modulus_gpa = 3\n\
         [pole]\nradius_mm = {pole:?}\n[contact]\nfriction = {friction:?}\n[grid]\npush_angle_deg = {PUSHES}\n\
         distance_mm = {distances:?}\ntaper = [0, 1e-9, 0.3, 0.7, 0.9, 0.95, 0.98, 0.999, 0.999999, 1]"
    );
    Scene::parse(&text, "straight").unwrap()
}

#[test]
fn the_shape_at_rest_decides_at_the_straight_length() {
    for (pole, friction) in [(0.0, 0.0), (0.25, 0.0), (1.0, 0.0), (0.25, 0.4)] {
        let scene = scene(pole, friction);
        let told = cheapest(&scene, &Side::BOTH, 1e-3).unwrap().resolution;
        for resolution in Resolution::LADDER.into_iter().chain([told]) {
            let mut plan = Plan::new(&scene).unwrap();
            plan.method.resolution = resolution;
            let (summary, panels) = compute_as(&scene, &plan, &mut Cpu);
            let case = format!("pole {pole}, friction {friction}, {resolution:?}");
            assert_eq!(
                (summary.unresolved(), summary.disagreements),
                (0, 0),
                "{case}"
            );
            for ((morphology, whisker), panel) in scene.whiskers().zip(&panels) {
                let case = format!("{case}, taper {}", morphology.taper);
                for side in Side::BOTH {
                    let distances = &scene.grid.distance_mm;
                    let ends = curve_at(resolution, &whisker, &scene.pole, side, distances);
                    for (row, end) in ends.iter().enumerate() {
                        let case = format!("{case}, {side:?}, distance {:e}", DISTANCES[row] - 1.0);
                        // The point of a perfect cone yields to any force; other tips hold until they are pulled off.
                        let expected = if row >= REACHED {
                            DetachmentKind::OutOfReach
                        } else if morphology.taper == 1.0 {
                            DetachmentKind::SlipOff
                        } else {
                            DetachmentKind::PullOff
                        };
                        if row > 0 {
                            assert_eq!(end.kind, expected, "{case}");
                            let at = end.push_angle_deg.unwrap_or(0.0);
                            assert!(at.abs() < 0.5, "{case}: {at}");
                        }
                        let width = scene.grid.push_angle_deg.len();
                        for (column, push) in scene.grid.push_angle_deg.iter().enumerate() {
                            if Side::of_push(*push) != side {
                                continue;
                            }
                            let past = end.push_angle_deg.is_some_and(|at| push.abs() > at.abs());
                            let expected = match end.kind {
                                DetachmentKind::OutOfReach => Regime::OutOfReach,
                                _ if !past => Regime::Contact,
                                DetachmentKind::SlipOff => Regime::SlipOff,
                                DetachmentKind::PullOff => Regime::PullOff,
                                DetachmentKind::Unresolved => Regime::Unresolved,
                            };
                            let found = panel.regime[row * width + column];
                            assert_eq!(found, expected.code(), "{case}, push {push}");
                        }
                    }
                }
            }
        }
    }
}
