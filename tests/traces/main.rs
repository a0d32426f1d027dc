//! Curves, branches and shapes against closed forms, each other, and what must hold along them.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod branch;
mod closed_form;
mod curve;
mod shape;

use whiskmap::scene::{Curvature, Whisker};

/// A whisker of 20 mm with a base radius of 30 um.
fn whisker(tip_radius_um: f64, a_per_mm: f64) -> Whisker {
    Whisker {
        length_mm: 20.0,
        base_radius_um: 30.0,
        tip_radius_um,
        youngs_modulus_gpa: 3.0,
        curvature: (a_per_mm > 0.0).then_some(Curvature {
            parabola_per_mm: a_per_mm,
            vertex_mm: 0.0,
        }),
    }
}

/// Whiskers and poles from cylinder to perfect cone, straight to strongly bent, point to thick pole.
fn everything() -> impl Iterator<Item = (Whisker, f64)> {
    [30.0, 20.0, 6.0, 1.5, 0.1, 0.0]
        .into_iter()
        .flat_map(|tip| [0.0, 0.02, 0.04, 0.07].map(|a| whisker(tip, a)))
        .flat_map(|whisker| [0.0, 0.25, 1.0].map(|pole| (whisker.clone(), pole)))
}
