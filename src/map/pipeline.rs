//! The row batches of a run in order. An engine solves the next ones while the threads of the pool complete and classify one.
//!
//! Cells are collected in order, and the audit of a batch ends before those of the next one are used, so that no race decides about a cell.

use super::fallback::complete;
use super::panel::Panel;
use super::rows;
use super::stages::{Stage, StageTimes};
use super::summary::Summary;
use super::task::Task;
use crate::engine::{Cells, Cpu, RowBatch, WhiskerSide, Worker, on_gpu};
use crate::shooting::Resolution;
use std::collections::VecDeque;
use std::ops::{ControlFlow, Range};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A batch of a run.
struct QueuedBatch {
    batch: Arc<RowBatch>,
    /// Whether it is the last one of its group of panels.
    is_last: bool,
}

/// The batches of a run that are still to be made.
struct Batches<'a> {
    task: &'a Task<'a>,
    groups: Box<dyn Iterator<Item = Range<usize>> + 'a>,
    /// The sides of the last batch's group, and the number of their rows in batches.
    begun: Option<(Arc<[WhiskerSide]>, usize)>,
}

impl Batches<'_> {
    /// Makes the next batch, with base points in the steps of `resolution` if an engine may solve it.
    fn next(
        &mut self,
        resolution: Option<Resolution>,
        times: &mut StageTimes,
    ) -> Option<QueuedBatch> {
        let (task, method) = (self.task, self.task.plan.method);
        let (sides, from) = match self.begun.take() {
            Some(begun) => begun,
            None => {
                let whiskers = self.groups.next()?;
                (times.time(Stage::Sheets, || task.sides(whiskers)), 0)
            }
        };
        let height = task.scene.grid.distance_mm.len();
        let all = sides.len() * height;
        let to = all.min(from + task.rows_at_once);
        let rows = (from..to).map(|i| (i / height, i % height));
        let pushes = Arc::clone(&task.pushes);
        let mut batch = RowBatch::new(method, Arc::clone(&sides), pushes, rows);
        batch.has_values = task.plan.channels.has_state();
        if let Some(resolution) = resolution.filter(|_| on_gpu(method.effects).is_ok()) {
            batch = times.time(Stage::BasePoints, || batch.with_base_points(resolution));
        }
        self.begun = (to < all).then_some((sides, to));
        Some(QueuedBatch {
            batch: Arc::new(batch),
            is_last: to == all,
        })
    }
}

/// Batches submitted ahead of the one that is completed: one that the engine solves, and one that waits.
const AHEAD: usize = 2;

/// A run under way.
pub struct Pipeline<'a> {
    worker: Worker,
    cpu: Cpu,
    /// Resolution of base points for the engine, if there is one.
    resolution: Option<Resolution>,
    batches: Batches<'a>,
    queue: VecDeque<QueuedBatch>,
    waiting: Duration,
    summary: Summary,
}

impl<'a> Pipeline<'a> {
    /// A run before its first batch; base points for the engine of `worker` are in the steps of `resolution`.
    pub fn new(task: &'a Task<'a>, worker: Worker, resolution: Option<Resolution>) -> Self {
        Self {
            worker,
            cpu: Cpu::default(),
            resolution,
            batches: Batches {
                task,
                groups: Box::new(task.plan.groups()),
                begun: None,
            },
            queue: VecDeque::new(),
            waiting: Duration::ZERO,
            summary: Summary::default(),
        }
    }

    /// Computes the panels of the next group; `None` if the run is cancelled.
    pub fn panels(
        &mut self,
        on_progress: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Option<Vec<Panel>> {
        let mut panels = Vec::new();
        while let Some((cells, is_last)) = self.advance(&mut panels) {
            self.summary.is_cancelled |= on_progress(cells).is_break();
            if is_last || self.summary.is_cancelled {
                break;
            }
        }
        if self.summary.is_cancelled {
            return None;
        }
        let mut times = self.summary.stages;
        let count = || panels.iter().for_each(|panel| self.summary.count(panel));
        times.time(Stage::Classification, count);
        self.summary.stages = times;
        Some(panels)
    }

    /// Ends the run.
    pub fn finish(mut self) -> Summary {
        self.summary.stages.add(Stage::Guesses, self.cpu.guesses);
        self.summary
            .stages
            .add(Stage::Refinement, self.cpu.refinement);
        Summary {
            device: self.worker.busy,
            engine_failure: self.worker.failure,
            waiting: self.waiting,
            ..self.summary
        }
    }

    /// Submits the next batches, and completes the first of the queue. Returns the number of its cells, and whether the `panels` are
    /// complete; `None` without a further batch.
    fn advance(&mut self, panels: &mut Vec<Panel>) -> Option<(usize, bool)> {
        let ahead = if self.worker.is_working() { AHEAD } else { 0 };
        while self.queue.len() <= ahead {
            let resolution = self.resolution.filter(|_| self.worker.is_working());
            let next = self.batches.next(resolution, &mut self.summary.stages);
            let Some(next) = next else { break };
            if next.is_for_engine() {
                self.worker.submit(Arc::clone(&next.batch));
            }
            self.queue.push_back(next);
        }
        let first = self.queue.pop_front()?;
        let begun = Instant::now();
        let cells = first.is_for_engine().then(|| self.worker.collect());
        self.waiting += begun.elapsed();
        self.complete(&first.batch, cells.flatten(), panels);
        Some((first.batch.cells(), first.is_last))
    }

    /// Completes the `cells` of an engine and writes them into `panels`, which are made if there are none.
    fn complete(&mut self, batch: &RowBatch, cells: Option<Cells>, panels: &mut Vec<Panel>) {
        let task = self.batches.task;
        let width = task.scene.grid.push_angle_deg.len();
        let sides = task.sides_per_panel();
        if panels.is_empty() {
            let cells = width * task.scene.grid.distance_mm.len();
            let panel = |_| Panel::unwritten(cells, task.plan.channels);
            *panels = (0..batch.sides.len() / sides).map(panel).collect();
        }
        let summary = &mut self.summary;
        let has_failed = self.worker.failure.is_some();
        let mut counts = summary.engine_cells;
        let done = complete(batch, cells, has_failed, &mut self.cpu, &mut counts);
        if self.resolution.is_some() {
            summary.engine_cells = counts;
        }
        summary.audit += done.audit;
        let fill = || rows::fill(batch, &done.cells, sides, width, panels);
        summary.stages.time(Stage::Classification, fill);
        if done.audit.differing > 0 {
            self.worker
                .fail_audit(done.audit.differing, done.audit.cells);
        }
    }
}

impl QueuedBatch {
    /// Returns true if an engine can solve some of its cells.
    fn is_for_engine(&self) -> bool {
        !self.batch.base_points.is_empty()
    }
}
