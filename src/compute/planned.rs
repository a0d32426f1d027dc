//! Plan of a map whose steps keep a tolerance. The plan has the engine's share of the tolerance, the engines that keep this share, and the
//! bounds that the map describes.

use super::{Error, accuracy};
use crate::accuracy::{Accuracy, BOUNDED, bound_deg};
use crate::engine::{Engine, KnownRow, Spectral};
use crate::plan::{Channels, Plan};
use crate::refine::{GOAL, TOLERANCE};
use crate::scene::Scene;
use serde_json::{Value, json};

/// Largest bound on the residual of the spectral engine, in whisker lengths.
const LARGEST_BOUND: f64 = 1e-5;

/// Relative rounding error of a bound that is computed from a tolerance and back.
const ROUNDING: f64 = 1e-8;

/// Plan of a map of a scene, with the steps that keep a tolerance.
#[derive(Clone, Debug)]
pub struct PlannedMap<'a> {
    /// Scene of the map.
    pub scene: &'a Scene,
    /// Plan with the steps and channels of the map.
    pub plan: Plan,
    /// Accuracy of the steps; `None` without a tolerance, which selects the finest steps.
    pub accuracy: Option<Accuracy>,
    /// Part of the tolerance that the steps leave to the engine, in degrees; `None` without a tolerance.
    pub left_deg: Option<f64>,
}

impl<'a> PlannedMap<'a> {
    /// Returns `plan` with these `channels`, or with its channels for `None`, and with the cheapest steps that keep push angles within
    /// `tolerance_deg`.
    ///
    /// # Errors
    /// If no steps keep the tolerance, or the scene does not have a channel.
    pub fn new(
        scene: &'a Scene,
        mut plan: Plan,
        tolerance_deg: Option<f64>,
        channels: Option<Channels>,
    ) -> Result<Self, Error> {
        let accuracy = accuracy(scene, tolerance_deg, &plan.sides)?;
        if let Some(accuracy) = &accuracy {
            plan.method.resolution = accuracy.resolution;
        }
        if let Some(channels) = channels {
            plan = plan.with_channels(channels, scene)?;
        }
        let left_deg = tolerance_deg
            .zip(accuracy)
            .map(|(tolerance_deg, accuracy)| tolerance_deg - accuracy.error_deg);
        Ok(Self { scene, plan, accuracy, left_deg })
    }

    /// Returns the spectral engine whose residuals keep push angles within [`Self::left_deg`]. Boundaries do not depend on an engine, so a map
    /// without numbers of states needs no small residuals.
    #[must_use]
    pub fn spectral(&self) -> Spectral {
        if !self.plan.channels.needs_states() {
            return Spectral::new(KnownRow::RESIDUAL);
        }
        let bound =
            self.left_deg.map(|left| (left / bound_deg(self.scene, 1.0)).min(LARGEST_BOUND));
        bound.map_or_else(Spectral::default, Spectral::new)
    }

    /// Returns the spectral engine; `None` where the CPU engine takes less time, as counted by the plan.
    ///
    /// It is also `None` where the residuals would have to be smaller than the residuals of the CPU engine.
    #[must_use]
    pub fn cheaper(&self) -> Option<Spectral> {
        let count = self.plan.expansions(self.scene);
        let pays = count.is_some_and(|count| count.pays());
        let spectral = self.spectral();
        (pays && spectral.residual_bound() >= GOAL).then_some(spectral)
    }

    /// Returns the bound on push-angle errors in degrees for an engine with this bound on its residuals, if it exceeds [`Self::left_deg`];
    /// otherwise `None`.
    #[must_use]
    pub fn excess_deg(&self, residual_bound: f64) -> Option<f64> {
        let bound = self.of_residual(residual_bound);
        let left = self.left_deg?;
        (bound > left * (1.0 + ROUNDING)).then_some(bound)
    }

    /// Returns the bound on push-angle errors in degrees by residuals of at most `bound` whisker lengths: 0 without numbers of states.
    fn of_residual(&self, bound: f64) -> f64 {
        match self.plan.channels.needs_states() {
            true => bound_deg(self.scene, bound),
            false => 0.0,
        }
    }

    /// Returns the attribute `tolerances` of the map: residuals of the CPU or the engine, and with a tolerance the estimated push-angle error.
    #[must_use]
    pub fn tolerances(&self, engine: Option<&dyn Engine>) -> Value {
        let of_engine = engine.map_or(0.0, Engine::residual_bound);
        let mut tolerances = json!({
            "residual_goal_whisker_lengths": GOAL.max(of_engine),
            "residual_accepted_whisker_lengths": TOLERANCE.max(of_engine),
        });
        if let Some(accuracy) = &self.accuracy {
            let error_deg = accuracy.error_deg + self.of_residual(of_engine);
            tolerances["push_angle_error_estimated_deg"] = error_deg.into();
            tolerances["bounded"] = BOUNDED.into();
        }
        tolerances
    }
}
