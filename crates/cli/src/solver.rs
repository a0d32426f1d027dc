//! Options `--engine` and `--tolerance`: the solver of a map.

use super::engine::{EngineArgs, OpenEngine};
use super::failure::{Failure, message};
use super::tolerance::ToleranceArgs;
use clap::Args;
use serde_json::Value;
use whiskmap::accuracy::{Accuracy, tolerances};
use whiskmap::plan::{Channels, Plan};
use whiskmap::scene::Scene;

#[derive(Debug, Default, Args)]
pub struct SolverArgs {
    #[command(flatten)]
    pub engine: EngineArgs,
    #[command(flatten)]
    tolerance: ToleranceArgs,
}

/// Plan of a map, and the accuracy of its steps.
pub struct PlannedMap {
    pub plan: Plan,
    /// Accuracy of the steps that --tolerance selects.
    accuracy: Option<Accuracy>,
    /// Part of the tolerance that the steps leave to the engine, in degrees; `None` without a tolerance.
    pub left_deg: Option<f64>,
}

impl SolverArgs {
    /// Returns `plan` with these channels and the steps that --tolerance selects.
    pub fn plan(
        &self,
        scene: &Scene,
        mut plan: Plan,
        channels: Channels,
    ) -> Result<PlannedMap, Failure> {
        let accuracy = self.tolerance.find(scene, &plan.sides)?;
        if let Some(accuracy) = &accuracy {
            plan.method.resolution = accuracy.resolution;
        }
        let left_deg = self.tolerance.degrees().zip(accuracy.as_ref());
        let left_deg = left_deg.map(|(tolerance_deg, accuracy)| accuracy.left_deg(tolerance_deg));
        Ok(PlannedMap {
            plan: plan.with_channels(channels, scene)?,
            accuracy,
            left_deg,
        })
    }

    /// Opens the engine of a planned map, and prints the accuracy. Returns the attribute `tolerances` of the map, too.
    pub fn open(&self, scene: &Scene, map: &PlannedMap) -> Result<(OpenEngine, Value), Failure> {
        let engine = self.engine.open(scene, &map.plan, map.left_deg)?;
        match (&engine.0, map.left_deg) {
            (Some(own), Some(_)) => message(&format!(
                "accuracy: residuals of at most {:.1e} of the length",
                own.residual_bound()
            )),
            _ => self.tolerance.report(map.accuracy),
        }
        let tolerances = tolerances(scene, map.accuracy.as_ref(), engine.0.as_deref());
        Ok((engine, tolerances))
    }

    /// Returns the name of the first option that is given; `None` without one.
    pub fn given(&self) -> Option<&'static str> {
        let tolerance = self.tolerance.degrees().map(|_| "--tolerance");
        self.engine.given().or(tolerance)
    }
}
