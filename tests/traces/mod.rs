//! Curves, branches and shapes: closed forms, agreement and properties.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod branch;
mod closed_form;
mod curve;
mod shape;

use rayon::prelude::*;
use std::sync::LazyLock;
use whiskmap::Side;
use whiskmap::scene::{Curvature, Pole, Whisker};
use whiskmap::trace::{Branch, Detachment, NoState, curve};

/// Whisker of 20 mm length with a base radius of 30 um.
fn whisker(tip_radius_um: f64, a_per_mm: f64) -> Whisker {
    Whisker {
        curvature: (a_per_mm > 0.0)
            .then_some(Curvature { parabola_per_mm: a_per_mm, vertex_mm: 0.0 }),
        ..Whisker::cone(20.0, [30.0, tip_radius_um], 3.0)
    }
}

/// Combinations of whiskers from cylinder to perfect cone, straight to strongly bent, with poles from a point to thick, smooth and rough.
fn everything() -> impl Iterator<Item = (Whisker, Pole)> {
    [30.0, 20.0, 6.0, 1.5, 0.1, 0.0]
        .into_iter()
        .flat_map(|tip| [0.0, 0.02, 0.04, 0.07].map(|a| whisker(tip, a)))
        .chain(
            [0.1, 10.0].map(|ratio| Whisker { modulus_tip_to_base: ratio, ..whisker(1.5, 0.02) }),
        )
        .flat_map(|whisker| POLES.map(|pole| (whisker.clone(), pole)))
}

const POLES: [Pole; 4] = [POINT, POLE, Pole::smooth(1.0), ROUGH];

/// Pole with friction.
const ROUGH: Pole = Pole { radius_mm: 0.25, friction: 0.4 };

/// Pole of the paper, and a point contact.
const POLE: Pole = Pole::smooth(0.25);
const POINT: Pole = Pole::smooth(0.0);

/// Distances of first touch of [`EVERY_BRANCH`], in mm.
const DISTANCES: [f64; 4] = [0.5, 9.0, 17.5, 19.0];

/// A branch of [`everything`], and the end of its push by [`curve`].
struct TestBranch {
    whisker: Whisker,
    pole: Pole,
    side: Side,
    distance_mm: f64,
    branch: Result<Branch, NoState>,
    end: Detachment,
}

impl TestBranch {
    /// Returns a description of the whisker and the pole.
    fn case(&self) -> String {
        let Self { whisker, pole, side, distance_mm, .. } = self;
        format!("{whisker:?} {pole:?} {side:?} at {distance_mm}")
    }
}

/// The branches of all whiskers and poles of [`everything`], on both sides, at [`DISTANCES`] beyond the radius of the pole. Several tests
/// read them.
static EVERY_BRANCH: LazyLock<Vec<TestBranch>> = LazyLock::new(|| {
    let mut cases = Vec::new();
    for (whisker, pole) in everything() {
        for distance in DISTANCES.into_iter().filter(|d| *d > pole.radius_mm) {
            cases.extend(Side::BOTH.map(|side| (whisker.clone(), pole, side, distance)));
        }
    }
    let of_case = |(whisker, pole, side, distance_mm)| TestBranch {
        branch: Branch::new(&whisker, &pole, side, distance_mm),
        end: curve(&whisker, &pole, side, &[distance_mm])[0],
        whisker,
        pole,
        side,
        distance_mm,
    };
    cases.into_par_iter().map(of_case).collect()
});

/// Returns the branches of [`EVERY_BRANCH`] at 9 mm, which every whisker reaches.
fn branches_at_9_mm() -> impl Iterator<Item = (&'static TestBranch, &'static Branch)> {
    let near = EVERY_BRANCH.iter().filter(|traced| traced.distance_mm == 9.0);
    near.map(|traced| (traced, traced.branch.as_ref().unwrap()))
}
