//! What a resolution costs in accuracy, measured by doubling its steps on a sample of the scene, and the cheapest
//! resolution that suffices.
//!
//! Newton's method adds the residual that it may leave, which counts for more the nearer the pole is.

mod sample;

use crate::refine::GOAL;
use crate::rod::Side;
use crate::scene::Scene;
use crate::shooting::Resolution;
use sample::Sample;

/// A resolution, and what it leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The steps.
    pub resolution: Resolution,
    /// Estimated error, in degrees, of what [`BOUNDED`] names, over the whole scene.
    pub error_deg: f64,
}

/// What a tolerance bounds, and what it does not. A state's place is that of its pole, seen from the base: a direction and
/// a distance, of which an error of a part of itself counts as that many radians. At a fold everything else changes with
/// the square root of the push angle.
pub const BOUNDED: &str = "push angles: where states stand and where they detach; not contact angles, arclengths, \
                           forces and moments, which next to a fold change faster";

/// By how much the worst of the sample may be exceeded elsewhere. The largest factor met in all shipped scenes, over
/// tolerances from 1e-2 to 1e-8 degrees, is 1.5 (`tests/accuracy.rs`).
const SAFETY: f64 = 4.0;

/// The cheapest rung of [`Resolution::LADDER`] whose estimate for `sides` of the scene is within `tolerance_deg`.
///
/// # Errors
/// Where none is: the finest, and its estimate.
pub fn cheapest(scene: &Scene, sides: &[Side], tolerance_deg: f64) -> Result<Accuracy, Accuracy> {
    let sample = Sample::new(scene, sides);
    let lengths = scene.corner_whiskers().map(|own| own.whisker.length_mm);
    let left = GOAL * lengths.fold(0.0, f64::max) / scene.grid.distance_mm[0];
    let mut tried = Accuracy {
        resolution: Resolution::FINE,
        error_deg: f64::INFINITY,
    };
    for resolution in Resolution::LADDER {
        tried = Accuracy {
            resolution,
            error_deg: (SAFETY * sample.error(resolution) + left).to_degrees(),
        };
        if tried.error_deg <= tolerance_deg {
            return Ok(tried);
        }
    }
    Err(tried)
}
