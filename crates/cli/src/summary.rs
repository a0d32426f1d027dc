//! Summary of a run of the command `map` on standard output.

use super::failure::{Failure, check_resolved};
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::Instant;
use whiskmap::classify::Regime;
use whiskmap::map::{EngineCells, Stage, Summary};
use whiskmap::scene::Scene;
use whiskmap::terminal::StandardOutput;

/// Prints the summary of a map since `start` and the names of its `files`; warns of unresolved cells.
///
/// # Errors
/// If every cell is unresolved.
pub fn report(
    scene: &Scene,
    summary: &Summary,
    start: Instant,
    files: &[PathBuf],
) -> Result<(), Failure> {
    print(scene, summary, start.elapsed().as_secs_f64(), files)?;
    let see = "the channel `status`";
    let [unresolved, all] = summary.unresolved_of_all();
    check_resolved(unresolved, all, "cells", see)
}

fn print(scene: &Scene, summary: &Summary, seconds: f64, files: &[PathBuf]) -> io::Result<()> {
    let mut out = StandardOutput::open();
    let engine = &summary.engine_cells;
    writeln!(out, "{}", scene.title)?;
    for (regime, cells) in Regime::ALL.iter().zip(summary.regimes) {
        if cells > 0 || *regime == Regime::Unresolved {
            writeln!(out, "{cells:>12}  {}", regime.name())?;
        }
    }
    writeln!(
        out,
        "{:>12}  states, {:.2} Newton steps each, worst residual {:.1e} of the length",
        summary.refined,
        summary.steps as f64 / summary.refined.max(1) as f64,
        summary.worst_residual
    )?;
    let has_engine = summary.audit.cells > 0 || *engine != EngineCells::default();
    if has_engine {
        let name = &summary.engine.engine;
        writeln!(out, "{:>12}  solved by the engine {name}", engine.solved)?;
    }
    for (count, what) in [
        (summary.trajectories, "trajectories of nets integrated by the engine"),
        (engine.fallback(), "not certified by the engine, and refined in f64"),
        (engine.without_row, "without a row of a net, and refined in f64"),
        (engine.on_cpu_instead, "solved by the CPU in f64 after the engine had failed"),
        (summary.audit.cells, "of the engine's cells audited in f64"),
        (summary.audit.differing, "of them differed by more than the audit allows"),
        (summary.toward_base, "slide toward the base"),
        (summary.sticking, "stick where their last sliding ended"),
        (summary.without_state, "in contact, whose state with friction was not found"),
        (summary.yielding, "beyond the yield strain"),
    ] {
        if count > 0 {
            writeln!(out, "{count:>12}  {what}")?;
        }
    }
    writeln!(out, "{:>12}  disagreements between cells and boundaries", summary.disagreements)?;
    let rate = summary.cells() as f64 / seconds;
    writeln!(out, "{rate:>12.0}  cells/s, in {seconds:.2} s")?;
    let stages =
        Stage::ALL.map(|(stage, name)| format!("{name} {:.2}", summary.stage_seconds(stage)));
    let (wall, stages) = (summary.wall_seconds, stages.join(", "));
    writeln!(out, "{wall:>12.2}  s for the stages: {stages}")?;
    if let Some(cpu) = summary.cpu_seconds {
        writeln!(out, "{cpu:>12.2}  CPU s of all threads meanwhile")?;
    }
    if summary.device_seconds > 0.0 {
        writeln!(
            out,
            "{:>12.2}  s of the engine beside them, {:.2} of these waited for",
            summary.device_seconds, summary.waiting_seconds
        )?;
    }
    for file in files {
        writeln!(out, "{}", file.display())?;
    }
    Ok(())
}
