//! Solver of a map: options `--engine` and `--tolerance`, the plan, the engine, and the computation.

use super::engine::{EngineArgs, OpenEngine};
use super::failure::{Failure, message};
use super::progress::Progress;
use super::tolerance::ToleranceArgs;
use clap::Args;
use std::sync::atomic::AtomicBool;
use whiskmap::compute::PlannedMap;
use whiskmap::engine::Engine;
use whiskmap::map::{self, Panel, Summary};
use whiskmap::plan::{Channels, Plan};
use whiskmap::scene::Scene;
use whiskmap::store::StoreError;

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

/// Computes the parts of `plan` by an open engine, or by the CPU engine without one, with a progress bar, and passes panels to `keep`. Warns if the
/// engine fails.
pub fn compute(
    scene: &Scene,
    plan: &Plan,
    engine: &mut Option<Box<dyn Engine>>,
    mut keep: impl FnMut(&mut Vec<Panel>) -> Result<(), StoreError> + Send,
) -> Result<Summary, Failure> {
    let engine = engine.as_mut().map(|engine| &mut **engine as _);
    let bar = Progress::over(plan.cells_of_parts(), "cells");
    // A signal ends the process.
    let never = AtomicBool::new(false);
    let result = map::run(scene, plan, engine, &mut |cells| bar.inc(cells), &never, &mut keep);
    bar.finish();
    let summary = result?;
    if let Some(failure) = &summary.engine_failure {
        message(&format!("warning: {failure}; the CPU solved the remaining cells"));
    }
    Ok(summary)
}
