//! The stages in order, for a whole scene: sheets, an engine's cells, guesses and refinement of all others, regimes, panels.

mod answer;
mod answers;
mod audit;
mod cells;
mod channels;
mod columns;
mod doubt;
mod panel;
mod pipeline;
mod runs;
mod sliding;
mod solved;
mod stages;
mod strip;
mod summary;
mod task;
mod work;

use crate::engine::{Engine, Worker};
use crate::plan::Plan;
pub use crate::plan::{Channels, STATE_CHANNELS};
use crate::scene::Scene;
use crate::sheet::Sheet;
use columns::SideColumns;
pub use panel::Panel;
use pipeline::Pipeline;
pub use stages::Stage;
use stages::{StageTimes, process_time};
use std::time::Instant;
pub use summary::{Audit, EngineCells, Summary};
use task::Task;

/// One side of one whisker.
struct WhiskerSide<'a> {
    pushes: &'a SideColumns,
    sheet: Sheet,
}

/// Computes the panels of `scene` as `plan` says, on the threads of the current pool, best from within it
/// (`rayon::ThreadPool::install`): from outside, every stage of every strip of rows wakes it up. `engine`, on a thread of its own, solves
/// cells in place of the refinement, those of a strip while the threads judge the one before and find the references of those
/// after; without one, or where it fails, the CPU does it all. `settled` hears how many more cells are settled; `keep` gets the
/// finished panels, in the order of the sweep, while the next ones are computed: it holds at most one group of them.
///
/// # Errors
/// What `keep` refuses panels with, which ends the run; a cell without an answer is no error.
pub fn run<E: Send>(
    scene: &Scene,
    plan: &Plan,
    engine: Option<&mut dyn Engine>,
    settled: &mut dyn FnMut(usize),
    keep: &mut (dyn FnMut(Vec<Panel>) -> Result<(), E> + Send),
) -> Result<Summary, E> {
    let (start, cpu_start) = (Instant::now(), process_time());
    let task = Task::new(scene, plan, engine.is_some());
    let resolution = engine
        .as_ref()
        .map(|own| own.resolution(plan.method.resolution));
    let mut packing = StageTimes::default();
    let summary = Worker::with(engine, |worker| {
        let mut pipeline = Pipeline::new(&task, worker, resolution);
        let mut keep = |panels| packing.time(Stage::Packing, || keep(panels));
        let mut finished: Option<Vec<Panel>> = None;
        for _ in plan.groups() {
            let (before, mut kept) = (finished.take(), Ok(()));
            rayon::in_place_scope(|scope| {
                scope.spawn(|_| kept = before.map_or(Ok(()), &mut keep));
                finished = Some(pipeline.panels(settled));
            });
            kept?;
        }
        finished.map_or(Ok(()), keep)?;
        Ok(pipeline.finish())
    })?;
    Ok(Summary {
        packing: packing.of(Stage::Packing),
        wall: start.elapsed(),
        cpu: process_time()
            .zip(cpu_start)
            .map(|(end, start)| end - start),
        ..summary
    })
}
