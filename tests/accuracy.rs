//! `--tolerance`: the estimate bounds the true error on every shipped scene.
#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test fails by panicking, and says aloud what it measured"
)]

use crate::shipped;
use whiskmap::accuracy::cheapest;
use whiskmap::mechanics::rod::{Effects, Side};
use whiskmap::mechanics::shooting::batch::{Batch, InitialCondition, Method};
use whiskmap::mechanics::shooting::{Resolution, ShootingMap};
use whiskmap::refine::states;
use whiskmap::scene::{Scene, Whisker};
use whiskmap::sheet::Sheet;
use whiskmap::trace::curve_at;

/// Its own error, 1e-11 degrees at most, is far below every tolerance here.
const EXACT: Resolution = Resolution::FINE.doubled();

/// The largest error of detachment angles, in degrees.
fn ends(scene: &Scene, whisker: &Whisker, side: Side, resolution: Resolution) -> f64 {
    let curve = |resolution| {
        let distances = &scene.grid.distance_mm;
        curve_at(resolution, whisker, &scene.pole, side, distances)
    };
    let pairs = curve(resolution).into_iter().zip(curve(EXACT));
    let apart = pairs.map(|(rough, exact)| {
        assert_eq!(rough.kind, exact.kind);
        let angles = rough.push_angle_deg.zip(exact.push_angle_deg);
        angles.map_or(0.0, |(rough, exact)| (rough - exact).abs())
    });
    apart.fold(0.0, f64::max)
}

/// The largest error of the cells, in degrees: where a state that the resolution calls solved has its pole.
fn cells(scene: &Scene, whisker: &Whisker, side: Side, resolution: Resolution) -> f64 {
    let rod = whisker.rod(&scene.pole, side);
    let effects = Effects::of([&rod]);
    let method = Method::new(resolution).with_effects(effects);
    let distances = &scene.grid.distance_mm;
    let distances: Vec<f64> = distances.iter().map(|d| d / whisker.length_mm).collect();
    let sheet = Sheet::new(method, &rod, side, &distances);
    let (conditions, poles): (Vec<InitialCondition>, Vec<_>) =
        states(method, &sheet, &scene.grid.push_angle_deg)
            .into_iter()
            .map(|(shot, state)| (InitialCondition::new(&rod, state.point), shot.pole))
            .unzip();
    let exact = Method::new(EXACT).with_effects(effects);
    let shot = Batch::new(exact).shoot::<ShootingMap>(&conditions);
    let missed = shot.iter().zip(poles);
    let missed = missed.map(|(map, pole)| map.residual(pole).length().to_degrees());
    missed.fold(0.0, f64::max)
}

#[test]
fn the_estimate_bounds_the_error_of_every_scene() {
    let mut closest = f64::INFINITY;
    for path in shipped::scene_paths() {
        let whole = Scene::read(&path).unwrap();
        let scene = whole.thinned(36, 4);
        let mut last = 0;
        for tolerance_deg in [1e-2, 1e-4, 1e-6, 1e-8] {
            let found = cheapest(&whole, &Side::BOTH, tolerance_deg).unwrap();
            assert!(found.error_deg <= tolerance_deg);
            assert!(found.resolution.least >= last);
            last = found.resolution.least;
            let (mut at_ends, mut in_cells) = (0.0_f64, 0.0_f64);
            for whisker in scene.whiskers().flatten().map(|swept| swept.whisker) {
                for side in Side::BOTH {
                    let ends = ends(&scene, &whisker, side, found.resolution);
                    let cells = cells(&scene, &whisker, side, found.resolution);
                    at_ends = at_ends.max(ends);
                    in_cells = in_cells.max(cells);
                }
            }
            let truth = at_ends.max(in_cells);
            eprintln!(
                "{:14} {tolerance_deg:.0e}: {last:2} steps, estimate {:.1e}, true {at_ends:.1e} and {in_cells:.1e}",
                whole.name, found.error_deg
            );
            assert!(truth <= found.error_deg, "{}", whole.name);
            closest = closest.min(found.error_deg / truth);
        }
        // The ladder is used.
        assert!(last >= 8);
    }
    eprintln!("the estimate is at least {closest:.1} times the error");
}

/// A cylinder that a stiff tip and friction let coil up; its net has guesses that are no states.
#[test]
fn whiskers_that_coil_up_have_an_estimate() {
    let text = "title = \"coiled\"\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 30\n\
                youngs_modulus_gpa = 3\n[whisker.curvature]\nparabola_per_mm = 0.075\n[whisker.modulus_gradient]\n\
                tip_to_base = 10\n[contact]\nfriction = 1\n[pole]\nradius_mm = 1\n[grid]\n\
                push_angle_deg = { from = -90, to = 90, count = 12 }\n\
                distance_mm = { from = 1.5, to = 19.9, count = 24 }\n";
    let scene = Scene::parse(text, "coiled").unwrap();
    for tolerance_deg in [1e-1, 1e-4] {
        let found = cheapest(&scene, &Side::BOTH, tolerance_deg).unwrap();
        let whisker = scene.first_whisker().whisker;
        let errors = Side::BOTH.map(|side| cells(&scene, &whisker, side, found.resolution));
        assert!(errors.iter().all(|error| *error <= found.error_deg), "{errors:?} {found:?}");
    }
}

#[test]
fn what_no_steps_reach_is_said() {
    let scene = shipped::scene("cone");
    let finest = cheapest(&scene, &Side::BOTH, 1e-15).unwrap_err();
    assert!(finest.error_deg < 1e-9 && finest.error_deg > 1e-15);
    assert_eq!(finest.resolution, Resolution::LADDER[7]);
}
