//! Computation of maps, stage by stage: sheets, rows, an engine's cells, the CPU's cells, classification, panels.

mod audit;
mod doubt;
mod fallback;
mod friction;
mod nets;
mod panel;
mod pipeline;
mod rows;
mod sides;
mod summary;
mod times;

use crate::engine::{Engine, EngineDescription, Worker};
use crate::plan::Plan;
pub use crate::plan::{Channels, STATE_CHANNELS};
use crate::scene::Scene;
use crate::stopwatch::Stopwatch;
pub use panel::Panel;
use pipeline::Pipeline;
use std::convert::Infallible;
use std::sync::atomic::AtomicBool;
pub use summary::{Audit, EngineCells, Summary};
use times::StageTimes;
pub use times::{Stage, process_seconds, thread_seconds};

/// Computes the panels of `scene` according to `plan`, on the threads of the current pool; call it within
/// `rayon::ThreadPool::install`, or every stage of every row batch wakes the pool up.
///
/// `engine` solves cells, a GPU's on a thread of its own, some batches ahead; the CPU engine solves all others, and everything after a failure.
/// `on_progress(n)` is called after `n` more cells are finished. If `cancel` is true, the run soon ends, within the whiskers that it computes, and
/// [`Summary::is_cancelled`] is set. `keep` gets the finished panels in the order of the sweep, while the
/// next ones are computed: it holds at most one group of them. If [`Plan::band_rows`] is less than the distances, it gets one band of rows
/// of a panel at a time instead, as a panel of these rows. The panels that it leaves are written again.
///
/// # Errors
/// The first error of `keep`, which ends the run. An unresolved cell is no error.
pub fn run<E: Send>(
    scene: &Scene,
    plan: &Plan,
    engine: Option<&mut dyn Engine>,
    on_progress: &mut dyn FnMut(usize),
    cancel: &AtomicBool,
    keep: &mut (dyn FnMut(&mut Vec<Panel>) -> Result<(), E> + Send),
) -> Result<Summary, E> {
    let description = EngineDescription::of(engine.as_deref());
    let (start, cpu_start) = (Stopwatch::start(), process_seconds());
    let effects = plan.method.effects;
    let integrates = engine.as_ref().is_some_and(|engine| engine.integrates_nodes(effects));
    let mut packing = StageTimes::default();
    let mut summary = Worker::with(engine, |worker| {
        let mut pipeline = Pipeline::new(scene, plan, worker, integrates, cancel);
        let mut finished: Vec<Panel> = Vec::new();
        let mut is_open = true;
        while is_open {
            let (mut before, mut kept) = (finished, Ok(()));
            let mut next = None;
            rayon::in_place_scope(|scope| {
                if !before.is_empty() {
                    scope.spawn(|_| kept = packing.time(Stage::Packing, || keep(&mut before)));
                }
                next = pipeline.panels(on_progress);
            });
            kept?;
            pipeline.spare = before;
            is_open = next.is_some();
            finished = next.unwrap_or_default();
        }
        Ok(pipeline.finish())
    })?;
    let packing = packing.0[Stage::Packing as usize];
    summary.stages.0[Stage::Packing as usize] = packing;
    summary.engine = description;
    summary.wall_seconds = start.elapsed().as_secs_f64();
    let cpu = process_seconds().zip(cpu_start);
    summary.cpu_seconds = cpu.map(|(end, start)| end - start);
    Ok(summary)
}

/// Computes a map as [`run`] does, to its end: without progress, and without errors of `keep`.
pub fn run_to_end(
    scene: &Scene,
    plan: &Plan,
    engine: Option<&mut dyn Engine>,
    mut keep: impl FnMut(&mut Vec<Panel>) + Send,
) -> Summary {
    let never = AtomicBool::new(false);
    let Ok(summary) = run(scene, plan, engine, &mut |_| {}, &never, &mut |panels| {
        keep(panels);
        Ok::<(), Infallible>(())
    });
    summary
}
