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
    /// Estimated error of angles over the whole scene, in degrees: how far from the wanted push angle a state really
    /// stands (a distance that is off by a part of itself counts as that many radians), and how far detachment angles
    /// are off.
    pub error_deg: f64,
}

/// By how much the worst of the sample may be exceeded elsewhere. The largest factor met in all shipped scenes, over
/// tolerances from 1e-2 to 1e-8 degrees, is 1.5 (`tests/accuracy.rs`).
const SAFETY: f64 = 4.0;

/// The cheapest rung of [`Resolution::LADDER`] whose estimate for `sides` of the scene is within `tolerance_deg`.
///
/// # Errors
/// Where none is: the finest, and its estimate.
pub fn cheapest(scene: &Scene, sides: &[Side], tolerance_deg: f64) -> Result<Accuracy, Accuracy> {
    let sample = Sample::new(scene, sides);
    let (nearest, length) = (scene.grid.distance_mm[0], scene.whisker.length_mm);
    let left = GOAL * length / nearest;
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
