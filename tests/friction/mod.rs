//! Friction of the contact: directions of sliding, states of contacts that slide to the tip, slide to the base and stick, and their cells.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod cells;
mod course;
mod events;
mod random;
mod sampled;
mod sliding;
mod stepped;
mod whisk;

use whiskmap::Side;
use whiskmap::scene::Scene;
use whiskmap::sensitivity::{NoDerivative, Variable, detachments, state};

/// Scene of the cone of the paper's first figure, with curvature `a_per_mm`, at a pole of this radius and friction.
fn cone(a_per_mm: f64, radius_mm: f64, friction: f64) -> Scene {
    let text = format!(
        "title = \"rough\"\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 1.5\n\
         youngs_modulus_gpa = 3\n[whisker.curvature]\nparabola_per_mm = {a_per_mm:?}\n\
         [pole]\nradius_mm = {radius_mm:?}\n[contact]\nfriction = {friction:?}\n[grid]\n\
         push_angle_deg = {{ from = -70, to = 70, count = 48 }}\n\
         distance_mm = {{ from = 2, to = 20, count = 36 }}"
    );
    Scene::parse(&text, "rough").unwrap()
}

/// A state whose place is history has no derivatives; its detachment has.
#[test]
fn states_of_the_course_have_no_derivatives() {
    let scene = cone(0.02, 0.25, 0.3);
    let variables = [Variable::PushAngleDeg];
    let by = |push: f64| {
        let found = state(&scene.whisker, &scene.pole, 15.66, push, &variables).unwrap();
        found.by[0]
    };
    for push in [-5.0, -10.0] {
        assert_eq!(by(push), Err(NoDerivative::Course), "{push}");
    }
    assert!(by(-20.0).is_ok() && by(5.0).is_ok());
    let variables = [Variable::DistanceMm];
    let ends = detachments(&scene.whisker, &scene.pole, Side::Cf, &[15.66], &variables);
    assert!(ends[0].by[0].is_ok(), "{ends:?}");
}

/// Where the contact slides toward the tip, the tangential force is the friction's coefficient times the normal one (Coulomb). Where it
/// sticks, it is less. Without friction there is none.
#[test]
fn the_whole_force_is_the_normal_one_with_friction() {
    use whiskmap::friction::Sliding;
    use whiskmap::trace::{Branch, curve};
    for friction in [0.0, 0.3] {
        let scene = cone(0.02, 0.25, friction);
        let most = f64::sqrt(1.0 + friction * friction);
        for side in Side::BOTH {
            let points = Branch::new(&scene.whisker, &scene.pole, side, 15.66).unwrap();
            for point in points.points(40).unwrap().iter().filter(|point| point.force_un > 0.0) {
                let ratio = point.contact_force_un / point.force_un;
                match point.sliding {
                    Some(Sliding::Sticks) => assert!((1.0..most).contains(&ratio), "{point:?}"),
                    _ => assert!((ratio / most - 1.0).abs() < 1e-12, "{point:?}"),
                }
            }
            let end = curve(&scene.whisker, &scene.pole, side, &[15.66])[0];
            let ratio = end.contact_force_un.unwrap() / end.force_un.unwrap();
            assert!((ratio / most - 1.0).abs() < 1e-12, "{end:?}");
        }
    }
}
