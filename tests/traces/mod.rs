//! Curves, branches and shapes: closed forms, agreement and properties.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod branch;
mod closed_form;
mod curve;
mod shape;

use whiskmap::scene::{Curvature, Pole, Whisker};

/// Whisker of 20 mm length with a base radius of 30 um.
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
        euler_spiral: None,
        traced: None,
        profile: None,
        profile_scale: 1.0,
        modulus_tip_to_base: 1.0,
        arc_stretch: 1.0,
    }
}

/// Combinations of whiskers from cylinder to perfect cone, straight to strongly bent, with poles from a point to thick, smooth and rough.
fn everything() -> impl Iterator<Item = (Whisker, Pole)> {
    [30.0, 20.0, 6.0, 1.5, 0.1, 0.0]
        .into_iter()
        .flat_map(|tip| [0.0, 0.02, 0.04, 0.07].map(|a| whisker(tip, a)))
        .chain([0.1, 10.0].map(|ratio| Whisker {
            euler_spiral: None,
            traced: None,
            profile: None,
            modulus_tip_to_base: ratio,
            ..whisker(1.5, 0.02)
        }))
        .flat_map(|whisker| POLES.map(|pole| (whisker.clone(), pole)))
}

const POLES: [Pole; 4] = [POINT, POLE, Pole::smooth(1.0), ROUGH];

/// Pole with friction.
const ROUGH: Pole = Pole {
    radius_mm: 0.25,
    friction: 0.4,
};

/// Pole of the paper, and a point contact.
const POLE: Pole = Pole::smooth(0.25);
const POINT: Pole = Pole::smooth(0.0);
