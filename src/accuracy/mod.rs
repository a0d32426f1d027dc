//! Accuracy of a resolution, measured by doubling its steps on a sample of the scene, and the cheapest sufficient resolution.
//!
//! Newton's method adds its largest residual, whose angle is largest at the nearest pole.

mod sample;

use crate::refine::GOAL;
use crate::scene::Scene;
use sample::SceneSample;
use std::ops::RangeInclusive;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Resolution;

/// Accuracy of a resolution: its estimated error for a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Resolution whose error is estimated.
    pub resolution: Resolution,
    /// Estimated error of the quantities in [`BOUNDED`] over the whole scene, in degrees.
    pub error_deg: f64,
}

/// Text about the quantities that a tolerance bounds, and the quantities without a bound. The error of a state is the error of its pole as
/// seen from the base: of the pole's direction, and of the logarithm of the pole's distance as radians. At a fold all other quantities
/// change with the square root of the push angle.
pub const BOUNDED: &str = "push angles: where states stand and where they detach; not contact angles, arclengths, \
                           forces and moments, which next to a fold change faster";

/// Tolerances of push angles that can be requested, in degrees: smaller ones are below the rounding error, larger ones give meaningless maps.
pub const TOLERANCE_DEG: RangeInclusive<f64> = 1e-10..=1.0;

/// Largest error of the scene over the largest of the sample. The largest factor measured in all shipped scenes, over tolerances from 1e-2
/// to 1e-8 degrees, is 1.5 (`tests/accuracy.rs`).
const SAFETY: f64 = 4.0;

/// Returns the cheapest rung of [`Resolution::LADDER`] whose estimate for `sides` of the scene is within `tolerance_deg`.
///
/// # Errors
/// If there is none, the finest rung with its estimate.
pub fn cheapest(scene: &Scene, sides: &[Side], tolerance_deg: f64) -> Result<Accuracy, Accuracy> {
    let sample = SceneSample::new(scene, sides);
    let mut tried = Accuracy { resolution: Resolution::FINE, error_deg: f64::INFINITY };
    for resolution in Resolution::LADDER {
        tried = Accuracy {
            resolution,
            error_deg: (SAFETY * sample.error(resolution)).to_degrees() + bound_deg(scene, GOAL),
        };
        if tried.error_deg <= tolerance_deg {
            return Ok(tried);
        }
    }
    Err(tried)
}

/// Returns the bound on push-angle errors in degrees for an engine with the residual bound `goal`, at the nearest distance.
#[must_use]
pub fn bound_deg(scene: &Scene, goal: f64) -> f64 {
    let distances = scene.grid.distance_mm.iter();
    let nearest = distances.copied().fold(f64::INFINITY, f64::min);
    let lengths = scene.corner_whiskers().map(|swept| swept.whisker.length_mm);
    let longest = lengths.fold(0.0, f64::max);
    (goal * longest / nearest).to_degrees()
}
