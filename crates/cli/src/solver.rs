//! Options `--engine` and `--tolerance`: the solver of a map.

use super::engine::{EngineArgs, OpenEngine};
use super::failure::{Failure, message};
use super::tolerance::ToleranceArgs;
use clap::Args;
use whiskmap::compute::PlannedMap;
use whiskmap::plan::{Channels, Plan};
use whiskmap::scene::Scene;

#[derive(Debug, Default, Args)]
pub struct SolverArgs {
    #[command(flatten)]
    pub engine: EngineArgs,
    #[command(flatten)]
    tolerance: ToleranceArgs,
}

impl SolverArgs {
    /// Returns `plan` with these channels and the steps that --tolerance selects.
    pub fn plan<'a>(
        &self,
        scene: &'a Scene,
        plan: Plan,
        channels: Channels,
    ) -> Result<PlannedMap<'a>, Failure> {
        let tolerance_deg = self.tolerance.degrees();
        Ok(PlannedMap::new(scene, plan, tolerance_deg, Some(channels))?)
    }

    /// Opens the engine of a planned map, and prints the accuracy.
    pub fn open(&self, map: &PlannedMap<'_>) -> Result<OpenEngine, Failure> {
        let engine = self.engine.open(map)?;
        match (&engine.0, map.left_deg) {
            (Some(opened), Some(_)) => message(&format!(
                "accuracy: residuals of at most {:.1e} of the length",
                opened.residual_bound()
            )),
            _ => self.tolerance.report(map.accuracy),
        }
        Ok(engine)
    }

    /// Returns the name of the first option that is given; `None` without one.
    pub fn given(&self) -> Option<&'static str> {
        let tolerance = self.tolerance.degrees().map(|_| "--tolerance");
        self.engine.given().or(tolerance)
    }
}
