//! Share of a tolerance that is left to the engine, the engines that keep it, and the bounds that a map describes.

use super::{Accuracy, BOUNDED, bound_deg};
use crate::engine::{Engine, Spectral};
use crate::plan::Plan;
use crate::refine::{GOAL, TOLERANCE};
use crate::scene::Scene;
use serde_json::{Value, json};

/// Largest bound on the residual of the spectral engine, in whisker lengths.
const LARGEST_BOUND: f64 = 1e-5;

/// Relative rounding error of a bound that is computed from a tolerance and back.
const ROUNDING: f64 = 1e-8;

impl Accuracy {
    /// Returns the part of `tolerance_deg` that the steps leave to the engine, in degrees.
    #[must_use]
    pub fn left_deg(&self, tolerance_deg: f64) -> f64 {
        tolerance_deg - self.error_deg
    }
}

/// Returns the spectral engine whose residuals leave push angles within `left_deg`, if given.
#[must_use]
pub fn spectral(scene: &Scene, left_deg: Option<f64>) -> Spectral {
    let bound = left_deg.map(|left| (left / bound_deg(scene, 1.0)).min(LARGEST_BOUND));
    bound.map_or_else(Spectral::default, Spectral::new)
}

/// Returns the spectral engine within `left_deg`, if given; `None` where the CPU engine takes less time, as counted by `plan`.
///
/// It is also `None` where the residuals would have to be smaller than those of the CPU engine.
#[must_use]
pub fn cheaper(scene: &Scene, plan: &Plan, left_deg: Option<f64>) -> Option<Spectral> {
    let pays = plan.expansions(scene).is_some_and(|count| count.pays());
    let spectral = spectral(scene, left_deg);
    (pays && spectral.residual_bound() >= GOAL).then_some(spectral)
}

/// Returns the bound on push-angle errors in degrees for an engine with this bound on its residuals, if it exceeds `left_deg`; otherwise
/// `None`.
#[must_use]
pub fn excess_deg(scene: &Scene, residual_bound: f64, left_deg: Option<f64>) -> Option<f64> {
    let bound = bound_deg(scene, residual_bound);
    left_deg
        .is_some_and(|left| bound > left * (1.0 + ROUNDING))
        .then_some(bound)
}

/// Returns the attribute `tolerances` of a map of `scene`: residuals of the CPU or the engine, and the estimated push-angle error of steps
/// with an `accuracy`.
#[must_use]
pub fn tolerances(
    scene: &Scene,
    accuracy: Option<&Accuracy>,
    engine: Option<&dyn Engine>,
) -> Value {
    let of_engine = engine.map_or(0.0, Engine::residual_bound);
    let mut tolerances = json!({
        "residual_goal_whisker_lengths": GOAL.max(of_engine),
        "residual_accepted_whisker_lengths": TOLERANCE.max(of_engine),
    });
    if let Some(accuracy) = accuracy {
        let error_deg = accuracy.error_deg + bound_deg(scene, of_engine);
        tolerances["push_angle_error_estimated_deg"] = error_deg.into();
        tolerances["bounded"] = BOUNDED.into();
    }
    tolerances
}
