//! Maps of whiskers whose level curves run along lines of constant load, turn back, or come in pieces.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::compute::{compute, is_contact};
use whiskmap::scene::Scene;

/// A map of a whisker of 20 mm without a cell in doubt.
fn certain(tip_um: Option<f64>, rest: &str) {
    let tip = tip_um.map(|radius| format!("tip_radius_um = {radius}"));
    let tip = tip.unwrap_or_default();
    let text = format!(
        "title = \"hard\"\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\n{tip}\n\
         youngs_modulus_gpa = 3\n{rest}"
    );
    let scene = Scene::parse(&text, "hard").unwrap();
    let (summary, panels) = compute(&scene, None);
    let doubtful = (summary.unresolved(), summary.disagreements);
    assert_eq!(doubtful, (0, 0), "{text}");
    for panel in panels {
        for (regime, residual) in panel.regime.iter().zip(&panel.residual) {
            assert!(!is_contact(*regime) || *residual <= 1e-11);
        }
    }
}

const TIP: &str = "[grid]\npush_angle_deg = { from = -14, to = 14, count = 201 }\n\
                   distance_mm = { from = 18, to = 20, count = 71 }";

#[test]
fn at_the_tip_of_a_perfect_cone() {
    for pole in ["", "[pole]\nradius_mm = 0.25\n"] {
        certain(Some(0.0), &format!("{pole}{TIP}"));
        certain(Some(0.0), &format!("[whisker.curvature]\nparabola_per_mm = 0.02\n{pole}{TIP}"));
    }
}

#[test]
fn tiny_pushes_over_all_tapers_and_curvatures() {
    certain(
        None,
        "[pole]\nradius_mm = 0.25\n[grid]\n\
         push_angle_deg = [-0.1, -1e-3, -1e-5, -1e-7, 0, 1e-7, 1e-5, 1e-3, 0.1, 5, 60]\n\
         distance_mm = { from = 0.5, to = 20, count = 40 }\n\
         taper = [0, 1e-12, 1e-6, 0.9, 0.999, 0.999999, 1]\n\
         curvature_per_mm = [0, 1e-9, 0.001, 0.05, 0.075]\n",
    );
}

#[test]
fn bent_cylinders_whose_rows_leave_the_sheet_more_than_once() {
    let grid = "[grid]\npush_angle_deg = { from = -220, to = 220, count = 120 }\n\
                distance_mm = { from = 0.5, to = 20, count = 100 }";
    for friction in [0.0, 0.4, 1.0] {
        let contact = format!("[pole]\nradius_mm = 0.25\n[contact]\nfriction = {friction}\n{grid}");
        for a_per_mm in [0.04, 0.075] {
            let bent = format!("[whisker.curvature]\nparabola_per_mm = {a_per_mm}\n{contact}");
            certain(Some(30.0), &bent);
        }
    }
    let vertex = "[whisker.curvature]\nparabola_per_mm = 0.128\nvertex_mm = 9.42\n";
    certain(Some(30.0), &format!("{vertex}[pole]\nradius_mm = 0.25\n{grid}"));
}

/// The stiffer the tip of a perfect cone is, the farther its folds are from those of other cones.
#[test]
fn perfect_cones_with_a_stiff_tip() {
    for tip_to_base in [2.3, 3.3, 8.0, 20.0] {
        certain(
            Some(0.0),
            &format!(
                "[whisker.modulus_gradient]\ntip_to_base = {tip_to_base}\n[grid]\n\
                 push_angle_deg = {{ from = -70, to = 70, count = 64 }}\n\
                 distance_mm = {{ from = 4, to = 21, count = 64 }}"
            ),
        );
    }
}
