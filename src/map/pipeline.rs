//! Pipeline of the row batches of a run, in order. An engine solves the next ones while the threads of the pool complete and classify
//! one.
//!
//! Cells are collected in order, and the audit of a batch ends before the cells of the next one are used. So the bytes do not depend on
//! the speed of a thread.

use super::fallback::complete;
use super::nets::PendingNets;
use super::panel::Panel;
use super::rows;
use super::sides::whisker_sides;
use super::summary::{EngineCells, Summary};
use super::times::Stage;
use crate::engine::{Cells, Cpu, RowBatch, SideColumns, WhiskerSide, Worker, needs_values};
use crate::plan::{CELLS_IN_FLIGHT, Plan};
use crate::scene::{Scene, SweptWhisker};
use crate::sheet::SheetUse;
use crate::stopwatch::Stopwatch;
use std::collections::VecDeque;
use std::iter;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::batch::Method;

/// Cells per thread in a batch for the CPU alone: nearly all blocks of the refinement are full, and little memory is new.
const CELLS_PER_THREAD: usize = 8192;

/// Cells of a batch for expansions: many rows for the threads, in little memory.
const EXPANDED_CELLS: usize = 1 << 15;

/// Batches submitted ahead of the one that is completed: one that the engine solves, and one that waits.
const AHEAD: usize = 2;

/// Pipeline of a run: its batches and results.
pub struct Pipeline<'a, 'e> {
    scene: &'a Scene,
    plan: &'a Plan,
    /// Effects of the plan and steps of trajectories.
    method: Method,
    rows_at_once: usize,
    /// Panels whose memory is used again for the next panels: `[panel]`.
    pub spare: Vec<Panel>,
    /// Columns of the map on each side: `[side]`.
    columns: Vec<Arc<SideColumns>>,
    /// The whiskers of each group of panels whose batches are still to be made.
    groups: Box<dyn Iterator<Item = Range<usize>> + 'a>,
    /// Nets of the next group, on which a device is working.
    drafted: Option<PendingNets>,
    /// The whiskers of each group of panels that are still to be finished. Bands of a panel have the same whisker.
    unfinished: Box<dyn Iterator<Item = Range<usize>> + 'a>,
    /// The sides of the group of the last batch, and the number of its rows in batches: band by band, and in a band side by side.
    begun: Option<(Arc<[WhiskerSide]>, usize)>,
    /// The batches made and not completed, each with whether it is the last one of its band.
    queue: VecDeque<(Arc<RowBatch>, bool)>,
    worker: Worker<'e>,
    /// True if the engine has a thread of its own, beside the stages.
    has_device: bool,
    cpu: Cpu,
    /// True if the engine integrates the trajectories of nets.
    engine_integrates: bool,
    summary: Summary,
    /// Flag that cancels the run.
    cancel: &'a AtomicBool,
}

impl<'a, 'e> Pipeline<'a, 'e> {
    /// Creates the pipeline of a run, whose engine may integrate the trajectories of nets. `cancel` ends it.
    pub fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        worker: Worker<'e>,
        engine_integrates: bool,
        cancel: &'a AtomicBool,
    ) -> Self {
        let push_angle_deg = &scene.grid.push_angle_deg;
        let rows = |cells: usize| (cells / push_angle_deg.len()).max(1);
        let cells = (CELLS_PER_THREAD * rayon::current_num_threads()).min(CELLS_IN_FLIGHT);
        let of_side = |side: &Side| Arc::new(SideColumns::new(push_angle_deg, *side));
        let has_device = worker.has_thread();
        let mut method = plan.method;
        let has_values = |most| needs_values(plan.channels, most);
        if worker.row_residual.is_some_and(has_values) {
            // Coarser steps are so few that their number changes along a row: states would not be analytic.
            method.resolution = method.resolution.at_least_fine();
        }
        Self {
            scene,
            plan,
            method,
            rows_at_once: match worker.row_residual {
                // After a failed audit, the CPU engine solves the batches that follow. So that equal runs write equal bytes, batches must not depend
                // on the number of threads.
                Some(_) if !has_device => plan.rows_at_once.min(rows(EXPANDED_CELLS)),
                Some(_) => plan.rows_at_once,
                None => rows(cells),
            },
            spare: Vec::new(),
            columns: plan.sides.iter().map(of_side).collect(),
            groups: Box::new(plan.groups()),
            unfinished: Box::new(iter::repeat_with(|| plan.groups()).flatten()),
            drafted: None,
            begun: None,
            queue: VecDeque::new(),
            worker,
            cpu: Cpu::default(),
            has_device,
            engine_integrates,
            summary: Summary::default(),
            cancel,
        }
    }

    /// Computes the panels of the next group, or the next band of rows of its panel; `None` after the last one, and if the run is cancelled.
    pub fn panels(&mut self, on_progress: &mut dyn FnMut(usize)) -> Option<Vec<Panel>> {
        let (scene, channels) = (self.scene, self.plan.channels);
        let (mut panels, mut whiskers) = (Vec::new(), Vec::new());
        let mut is_complete = false;
        while !is_complete {
            let advanced = self.advance(&mut panels);
            self.summary.is_cancelled |= self.cancel.load(Ordering::Relaxed);
            let (mut cells, is_last) = advanced.filter(|_| !self.summary.is_cancelled)?;
            if is_last {
                let group = self.unfinished.next().unwrap_or_default();
                whiskers = group.map(|index| scene.whisker(index)).collect();
                let size = scene.grid.panel_cells();
                for (place, found) in whiskers.iter().enumerate() {
                    if found.is_err() {
                        panels.insert(place, Panel::without_whisker(size, channels));
                        cells += size;
                    }
                }
            }
            on_progress(cells);
            is_complete = is_last;
        }
        let mut times = self.summary.stages;
        times.time(Stage::Classification, || {
            for (panel, found) in panels.iter().zip(&whiskers) {
                let swept = found.as_ref().ok();
                let yield_strain = swept.and_then(|swept| swept.whisker.yield_strain);
                self.summary.count(panel, yield_strain);
            }
        });
        self.summary.stages = times;
        Some(panels)
    }

    /// Ends the run. Returns its counts and times.
    pub fn finish(self) -> Summary {
        let mut summary = self.summary;
        summary.stages.0[Stage::Guesses as usize] = self.cpu.guesses;
        summary.stages.0[Stage::Refinement as usize] = self.cpu.refinement;
        let busy = self.worker.busy;
        match self.has_device {
            true => summary.device_seconds = busy.as_secs_f64(),
            false => summary.stages.0[Stage::Cells as usize] = busy,
        }
        summary.trajectories = self.worker.trajectories;
        summary.engine_failure = self.worker.failure;
        if self.worker.row_residual.is_none() {
            summary.engine_cells = EngineCells::default();
        }
        summary
    }

    /// Submits the next batches, and completes the first of the queue. Returns the number of its cells, and whether it is the last one of the
    /// `panels`; `None` without a further batch.
    fn advance(&mut self, panels: &mut Vec<Panel>) -> Option<(usize, bool)> {
        let ahead = if self.worker.has_thread() { AHEAD } else { 0 };
        while self.queue.len() <= ahead
            && let Some((batch, is_last)) = self.next_batch()
        {
            if batch.is_for_engine() {
                self.worker.submit(Arc::clone(&batch));
            }
            self.queue.push_back((batch, is_last));
        }
        // While the device works on these batches, the threads begin the nets of the next group.
        if self.drafted.is_none()
            && let Some(most) = self.on_device()
        {
            self.drafted = self.draft_next(most);
        }
        let (batch, is_last) = self.queue.pop_front()?;
        let begun = Stopwatch::start();
        let is_submitted = batch.is_for_engine();
        let cells = is_submitted.then(|| self.worker.collect()).flatten();
        if self.has_device {
            self.summary.waiting_seconds += begun.elapsed().as_secs_f64();
        }
        self.complete(&batch, cells, panels);
        Some((batch.cells(), is_last))
    }

    /// Returns the sides of the next group, whisker by whisker; none of rows of a table that have no whisker.
    fn next_group(&mut self) -> Option<Arc<[WhiskerSide]>> {
        let nets = match (self.drafted.take(), self.on_device()) {
            (Some(nets), _) => nets,
            (None, Some(most)) => self.draft_next(most)?,
            (None, None) => return Some(self.sides_of_next(self.side_net())?.into()),
        };
        let begun = Stopwatch::start();
        let (sides, waited) = nets.finish(&mut self.worker);
        self.summary.waiting_seconds += waited.as_secs_f64();
        self.summary.stages.0[Stage::Sheets as usize] += begun.elapsed() - waited;
        Some(sides)
    }

    /// Returns the residual of nets, in whisker lengths, if a device integrates their trajectories.
    fn on_device(&self) -> Option<f64> {
        let integrates = self.engine_integrates && self.worker.has_thread();
        let channels = self.plan.channels;
        let needed = |most: &f64| integrates && needs_values(channels, *most);
        self.worker.row_residual.filter(needed)
    }

    /// Begins the nets of the next group, with a residual of at most `most` whisker lengths.
    fn draft_next(&mut self, most: f64) -> Option<PendingNets> {
        let sides = self.sides_of_next((SheetUse::Guesses, None))?;
        let (method, worker) = (self.method, &mut self.worker);
        let nets = || PendingNets::new(sides, method, most, worker);
        Some(self.summary.stages.time(Stage::Sheets, nets))
    }

    /// Returns the use of the sheets of the next group, if no device integrates them. The second value is the residual of their nets, in whisker lengths;
    /// `None` without nets.
    fn side_net(&self) -> (SheetUse, Option<f64>) {
        let most = self.worker.row_residual;
        match most.filter(|_| self.worker.is_working()) {
            Some(most) if needs_values(self.plan.channels, most) => (SheetUse::Guesses, Some(most)),
            Some(_) => (SheetUse::KnownRows, None),
            None => (SheetUse::Guesses, None),
        }
    }

    /// Computes the sides of the next group with this `net` ([`whisker_sides`]); `None` after the last group, and if the run is cancelled.
    fn sides_of_next(&mut self, net: (SheetUse, Option<f64>)) -> Option<Vec<WhiskerSide>> {
        let whiskers = self.groups.next()?;
        let found = whiskers.filter_map(|index| self.scene.whisker(index).ok());
        let found: Vec<SweptWhisker> = found.collect();
        let of_plan = (self.plan, self.method);
        let sides = || whisker_sides(self.scene, of_plan, net, &self.columns, &found, self.cancel);
        self.summary.stages.time(Stage::Sheets, sides)
    }

    /// Makes the next batch, with expansions of its rows if there is an engine. Returns it, and whether it is the last one of its band. The batch
    /// of a group without a whisker is empty.
    fn next_batch(&mut self) -> Option<(Arc<RowBatch>, bool)> {
        let (sides, from) = match self.begun.take() {
            Some(begun) => begun,
            None => (self.next_group()?, 0),
        };
        if sides.is_empty() {
            return Some((Arc::new(RowBatch::new(self.method, sides, [])), true));
        }
        let height = self.scene.grid.distance_mm.len();
        let all = sides.len() * height;
        // The rows of a band follow one another on each side.
        let band = self.band(from / sides.len());
        let end = band.end * sides.len();
        let to = end.min(from + self.rows_at_once);
        let rows = (from..to).map(|i| {
            let i = i - band.start * sides.len();
            (i / band.len(), band.start + i % band.len())
        });
        let mut batch = RowBatch::new(self.method, Arc::clone(&sides), rows);
        batch.channels = self.plan.channels;
        if let Some(most) = self.worker.row_residual
            && self.worker.is_working()
        {
            let times = &mut self.summary.stages;
            batch = times.time(Stage::Rows, || batch.with_nets(most));
        }
        self.begun = (to < all).then_some((sides, to));
        Some((Arc::new(batch), to == end))
    }

    /// The rows of the band that has `row`.
    fn band(&self, row: usize) -> Range<usize> {
        let (height, rows) = (self.scene.grid.distance_mm.len(), self.plan.band_rows);
        let first = row / rows * rows;
        first..height.min(first + rows)
    }

    /// Completes the `cells` of an engine and writes them into `panels`, which are taken from the spare ones or made if there are none.
    fn complete(&mut self, batch: &RowBatch, cells: Option<Cells>, panels: &mut Vec<Panel>) {
        let (width, sides) = (self.scene.grid.push_angle_deg.len(), self.columns.len());
        let band = self.band(batch.rows.first().map_or(0, |row| row.row));
        if panels.is_empty() {
            let (cells, channels) = (width * band.len(), self.plan.channels);
            let spare = std::mem::take(&mut self.spare)
                .into_iter()
                .map(|panel| panel.resized(cells, channels));
            let new = std::iter::repeat_with(|| Panel::unwritten(cells, channels));
            *panels = spare.chain(new).take(batch.sides.len() / sides).collect();
        }
        let summary = &mut self.summary;
        let has_failed = self.worker.failure.is_some();
        let counts = &mut summary.engine_cells;
        let bounds = (self.worker.residual_bound, self.worker.row_residual.unwrap_or(0.0));
        let cells = cells.map(|cells| (cells, bounds));
        let (mut cells, audit) = complete(batch, cells, has_failed, &mut self.cpu, counts);
        summary.audit += audit;
        let fill =
            || rows::fill(batch, &mut cells, sides, [width, band.start], panels, self.cancel);
        summary.stages.time(Stage::Classification, fill);
        if audit.differing > 0 {
            self.worker.fail_audit(audit.differing, audit.cells);
        }
    }
}
