//! Forces from curvature against the states that have it.

use whiskmap::force::{CurvatureFrame, ForceMethod, FrameContact, FrameForce, NoForce, forces};
use whiskmap::rod::Side;
use whiskmap::scene::Scene;
use whiskmap::trace::{Branch, WhiskerPart, WhiskerShape};

/// The frame of a state: its curvature at the point next to `part` of the length, and its contact. With the frame, the state's force and
/// moment at the base.
fn frame(scene: &Scene, distance_mm: f64, push_deg: f64, part: f64) -> (CurvatureFrame, [f64; 2]) {
    let side = Side::of_push(push_deg);
    let branch = Branch::new(&scene.whisker, &scene.pole, side, distance_mm).unwrap();
    let state = branch.state(push_deg.to_radians(), true).unwrap();
    let shape = WhiskerShape::new(&branch, &state, 101);
    // From the frame of the pole to that of the base, which is turned by -push.
    let (sin, cos) = push_deg.to_radians().sin_cos();
    let in_base = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y];
    let contact = shape
        .points
        .iter()
        .find(|point| point.part == WhiskerPart::Contact)
        .unwrap();
    let at = &shape.points[(100.0 * part) as usize];
    let frame = CurvatureFrame {
        line: 2,
        time_s: 0.0,
        curvature_per_mm: at.curvature_per_mm,
        at_arc_length_mm: at.arc_length_mm,
        at_mm: Some(in_base(at.x_mm, at.y_mm)),
        contact: Some(FrameContact {
            contact_mm: in_base(contact.x_mm, contact.y_mm),
            contact_angle_deg: Some(contact.angle_deg + push_deg),
        }),
    };
    let loads = [
        side.sign() * shape.state.force_un,
        shape.state.base_moment_nnm,
    ];
    (frame, loads)
}

fn force(scene: &Scene, frame: &CurvatureFrame, method: ForceMethod) -> FrameForce {
    forces(
        &scene.whisker,
        &scene.pole,
        std::slice::from_ref(frame),
        method,
    )[0]
}

/// Both methods return force and moment of states, from first touch to just before the detachment, on both sides.
#[test]
fn forces_of_states_come_back() {
    let ends = [
        ("cone", 15.66, [-24.9, -12.0, -1.0, 1.0, 8.0, 15.6]),
        (
            "cylinder",
            15.66,
            [-100.56, -100.27, -30.0, -1.0, 1.0, 62.0],
        ),
        ("robot", 60.0, [-49.9, -20.0, -1.0, 1.0, 20.0, 36.0]),
        ("measured", 12.0, [-45.0, -10.0, -1.0, 1.0, 10.0, 32.8]),
        ("traced", 12.0, [-39.9, -10.0, -1.0, 1.0, 10.0, 28.9]),
    ];
    for (name, distance, pushes) in ends {
        let scene = Scene::read(format!("scenes/{name}.toml")).unwrap();
        for push in pushes {
            for part in [0.0, 0.05, 0.3] {
                let (frame, [wanted, moment]) = frame(&scene, distance, push, part);
                for method in [ForceMethod::Lever, ForceMethod::Model] {
                    let found = force(&scene, &frame, method);
                    let context = format!("{name} {push} {part} {method:?} {found:?} {wanted}");
                    let own = found.force_un.unwrap_or_else(|| panic!("{context}"));
                    assert!((own / wanted - 1.0).abs() < 1e-9, "{context}");
                    let own = found.base_moment_nnm.unwrap();
                    // The moment at the base changes its sign along some pushes.
                    let size = wanted.abs() * scene.whisker.length_mm;
                    assert!((own - moment).abs() < 1e-9 * size, "{context} {moment}");
                    if method == ForceMethod::Model {
                        assert!(found.contact_off_mm.unwrap() < 1e-8, "{context}");
                    }
                }
            }
        }
    }
}

/// What has no force says why.
#[test]
fn frames_without_a_force_have_a_reason() {
    let scene = Scene::read("scenes/cone.toml").unwrap();
    let (good, _) = frame(&scene, 15.66, 10.0, 0.3);
    let contact = good.contact.unwrap();
    let with = |change: fn(&mut FrameContact)| {
        let mut contact = contact;
        change(&mut contact);
        CurvatureFrame {
            contact: Some(contact),
            ..good
        }
    };
    let far = with(|contact| contact.contact_mm = [25.0, 0.0]);
    assert_eq!(
        force(&scene, &far, ForceMethod::Model).reason,
        Some(NoForce::OutOfReach)
    );
    let behind = with(|contact| contact.contact_mm = [1.0, 0.0]);
    for method in [ForceMethod::Lever, ForceMethod::Model] {
        assert_eq!(
            force(&scene, &behind, method).reason,
            Some(NoForce::NoLever)
        );
    }
    // No stable state has ten times the curvature of one near the slip-off.
    let sharp = CurvatureFrame {
        curvature_per_mm: 10.0 * good.curvature_per_mm,
        ..good
    };
    assert_eq!(
        force(&scene, &sharp, ForceMethod::Model).reason,
        Some(NoForce::NoState)
    );
    let free = CurvatureFrame {
        contact: None,
        ..good
    };
    for method in [ForceMethod::Lever, ForceMethod::Model] {
        let found = force(&scene, &free, method);
        assert_eq!((found.force_un, found.reason), (Some(0.0), None));
    }
}
