//! Which way the contact slides: friction is computed as of one that slides toward the tip, and states where it does not
//! are told.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod compute;

use compute::compute;
use whiskmap::classify::{Regime, Sliding, Status};
use whiskmap::map::{Panel, Summary};
use whiskmap::rod::Side;
use whiskmap::scene::Scene;
use whiskmap::trace::{Branch, Shape};

/// The cone of the first figure, bent by `a_per_mm`, in front of a pole of this radius and friction.
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

/// Half the push between the states of a difference; their distance is known to its square.
const HALF: f64 = 1e-4;

/// Work of friction, over that of the base's rotation, which rounding and the difference cannot tell from none.
const NO_WORK: f64 = 1e-6;

/// What the base puts in by its rotation and the whisker does not keep as bending energy is what friction takes. It takes
/// some where the contact slides toward the tip; where it slides toward the base, this friction would give some.
#[test]
fn friction_takes_energy_only_toward_the_tip() {
    let mut told = [0, 0];
    for (a_per_mm, radius_mm) in [(0.0, 0.0), (0.02, 0.0), (0.02, 0.25), (0.04, 1.0)] {
        let scene = cone(a_per_mm, radius_mm, 0.3);
        for side in Side::BOTH {
            for distance in [1.5, 4.0, 9.0, 15.0, 17.5] {
                let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
                let points = branch.points(60).unwrap();
                let stable = points.iter().filter(|point| point.stable);
                for point in stable.filter(|point| point.mark.is_none()) {
                    let push = point.push_angle_deg.to_radians();
                    let [before, after] = [-HALF, HALF].map(|step| {
                        let state = branch.state(push + side.sign() * step, true);
                        state.map(|state| branch.read(&state).energy_nj)
                    });
                    let (Ok(before), Ok(after)) = (before, after) else {
                        continue;
                    };
                    let put_in = 2.0 * HALF * side.sign() * point.base_moment_nnm;
                    let taken = put_in - (after - before);
                    if taken.abs() < NO_WORK * put_in.abs() {
                        continue;
                    }
                    let sliding = if taken > 0.0 {
                        Sliding::Tip
                    } else {
                        Sliding::Base
                    };
                    let case = format!(
                        "{a_per_mm} {radius_mm} {side:?} {distance}: {taken:e} of {put_in:e}"
                    );
                    assert_eq!(point.sliding, Some(sliding), "{case}: {point:?}");
                    told[usize::from(sliding == Sliding::Base)] += 1;
                    let state = branch.state(push, true).unwrap();
                    assert_eq!(
                        Shape::new(&branch, &state, 2).sliding,
                        Some(sliding),
                        "{case}"
                    );
                }
            }
        }
    }
    assert!(told[0] > 800 && told[1] > 60, "{told:?}");
}

/// Along a whole branch, unstable states included: arclength of the contact, less what it has rolled around the pole.
#[test]
fn sliding_is_what_is_not_rolled() {
    let mut told = [0, 0];
    for radius_mm in [0.0, 0.25, 1.0] {
        let scene = cone(0.02, radius_mm, 0.3);
        for side in Side::BOTH {
            for distance in [1.5, 4.0, 9.0, 15.0, 18.5] {
                let branch = Branch::new(&scene.whisker, &scene.pole, side, distance).unwrap();
                let points = branch.points(400).unwrap();
                for pair in points.windows(2) {
                    let [slid, next] = [pair[0], pair[1]].map(|point| {
                        let turned = (point.contact_angle_deg - point.push_angle_deg).to_radians();
                        point.arc_length_mm + side.sign() * radius_mm * turned
                    });
                    // Between two that differ the contact turns back.
                    if pair[0].sliding == pair[1].sliding {
                        let is_base = next < slid;
                        let case = format!("{radius_mm} {side:?} {distance}: {pair:?}");
                        let sliding = if is_base { Sliding::Base } else { Sliding::Tip };
                        assert_eq!(pair[0].sliding, Some(sliding), "{case}");
                        told[usize::from(is_base)] += 1;
                    }
                }
            }
        }
    }
    assert!(told.iter().all(|count| *count > 500), "{told:?}");
}

fn map(friction: f64) -> (Summary, Panel) {
    let (summary, mut panels) = compute(&cone(0.02, 0.25, friction), None);
    (summary, panels.remove(0))
}

/// On CF the first part of a push slides toward the base, on CB none does.
#[test]
fn cells_that_slide_toward_the_base_are_told() {
    let scene = cone(0.02, 0.25, 0.3);
    let (summary, panel) = map(0.3);
    let pushes = &scene.grid.push_angle_deg;
    let mut contacts = [0, 0];
    let mut toward_base = [0, 0];
    for (row, distance) in scene.grid.distance_mm.iter().enumerate() {
        for (column, push) in pushes.iter().enumerate() {
            let at = row * pushes.len() + column;
            let status = panel.status[at];
            let is_contact = panel.regime[at] == Regime::Contact.code();
            let slides = status == Status::TowardBase.code();
            if !is_contact {
                assert!(!slides || panel.regime[at] == Regime::Unreachable.code());
                continue;
            }
            let side = Side::of_push(*push);
            let branch = Branch::new(&scene.whisker, &scene.pole, side, *distance).unwrap();
            let state = branch.state(push.to_radians(), true).unwrap();
            let sliding = Shape::new(&branch, &state, 2).sliding;
            assert_eq!(sliding == Some(Sliding::Base), slides, "{distance} {push}");
            contacts[side as usize] += 1;
            toward_base[side as usize] += usize::from(slides);
        }
    }
    let [cb, cf] = [Side::Cb, Side::Cf].map(|side| side as usize);
    let share = toward_base[cf] as f64 / contacts[cf] as f64;
    assert!((0.1..0.3).contains(&share), "{toward_base:?} {contacts:?}");
    assert_eq!(toward_base[cb], 0, "{contacts:?}");
    assert_eq!(summary.unresolved(), 0);
    let code = Status::TowardBase.code();
    let all = panel.status.iter().filter(|status| **status == code);
    assert_eq!(summary.toward_base, all.count() as u64);
}

#[test]
fn without_friction_no_cell_has_a_direction() {
    let (summary, panel) = map(0.0);
    assert_eq!(summary.toward_base, 0);
    assert!(!panel.status.contains(&Status::TowardBase.code()));
    let scene = cone(0.02, 0.25, 0.0);
    let branch = Branch::new(&scene.whisker, &scene.pole, Side::Cf, 9.0).unwrap();
    let points = branch.points(20).unwrap();
    assert!(points.iter().all(|point| point.sliding.is_none()));
}
