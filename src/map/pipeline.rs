//! Strips of rows on their way: an engine is asked about the next ones before the threads, which share the work on each, settle one.
//!
//! Answers are looked at in order, and what an audit finds in a strip is known before those to the next one are, so that no race decides
//! what becomes of a cell.

use super::panel::Panel;
use super::solved::{RowsAsked, Solved};
use super::stages::{Stage, StageTimes};
use super::strip;
use super::task::{Group, Task};
use super::{Audit, Summary, answers};
use crate::engine::{CellDifference, Worker};
use crate::shooting::Resolution;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Some rows of a group that are settled together.
struct Strip<'a> {
    group: Arc<Group<'a>>,
    /// Pairs of a face and a row of its panel.
    rows: Vec<(usize, usize)>,
    /// Whether it is the last one of its group.
    is_last: bool,
    asked: RowsAsked,
}

/// The strips of a task, in order.
struct Strips<'a> {
    task: &'a Task<'a>,
    groups: Box<dyn Iterator<Item = Range<usize>> + 'a>,
    /// The group of the last strip, and how many of its rows are in strips.
    begun: Option<(Arc<Group<'a>>, usize)>,
}

impl<'a> Strips<'a> {
    /// The next one, with references in the steps of `resolution` if there is an engine to ask.
    fn prepare(
        &mut self,
        resolution: Option<Resolution>,
        times: &mut StageTimes,
    ) -> Option<Strip<'a>> {
        let task = self.task;
        let (group, from) = match self.begun.take() {
            Some(begun) => begun,
            None => {
                let whiskers = self.groups.next()?;
                let group = times.time(Stage::Sheets, || task.group(whiskers));
                (Arc::new(group), 0)
            }
        };
        let height = task.scene.grid.distance_mm.len();
        let all = group.faces.len() * height;
        let to = all.min(from + task.rows_at_once);
        let rows: Vec<(usize, usize)> = (from..to).map(|i| (i / height, i % height)).collect();
        let mut asked = RowsAsked::default();
        if let Some(resolution) = resolution {
            let method = task.plan.method;
            let ask = || strip::ask(method, resolution, &task.angles, &group.faces, &rows);
            asked = times.time(Stage::BasePoints, ask);
        }
        self.begun = (to < all).then(|| (Arc::clone(&group), to));
        Some(Strip {
            group,
            rows,
            is_last: to == all,
            asked,
        })
    }
}

/// Strips that an engine has been asked about while one is settled: one that it solves, and one that waits.
const AHEAD: usize = 2;

/// A run under way.
pub struct Pipeline<'a> {
    worker: Worker,
    /// The resolution of references for the engine, if there is one.
    resolution: Option<Resolution>,
    strips: Strips<'a>,
    /// Those whose cells an engine may be at, in order.
    under_way: VecDeque<Strip<'a>>,
    waiting: Duration,
    /// Counts up to now.
    pub summary: Summary,
}

impl<'a> Pipeline<'a> {
    /// Before its first strip; `resolution` is that of references for the engine of `worker`.
    pub fn new(task: &'a Task<'a>, worker: Worker, resolution: Option<Resolution>) -> Self {
        let strips = Strips {
            task,
            groups: Box::new(task.plan.groups()),
            begun: None,
        };
        Self {
            worker,
            resolution,
            strips,
            under_way: VecDeque::new(),
            waiting: Duration::ZERO,
            summary: Summary::default(),
        }
    }

    /// The panels of the next group.
    pub fn panels(&mut self, settled: &mut dyn FnMut(usize)) -> Vec<Panel> {
        let mut panels = Vec::new();
        while !self.advance(&mut panels, settled) {}
        let mut times = self.summary.stages;
        let count = || panels.iter().for_each(|panel| self.summary.count(panel));
        times.time(Stage::Classification, count);
        self.summary.stages = times;
        panels
    }

    /// What there is to say in the end.
    pub fn finish(self) -> Summary {
        let Self {
            worker,
            waiting,
            summary,
            ..
        } = self;
        Summary {
            device: worker.busy,
            engine_failure: worker.failure,
            waiting,
            ..summary
        }
    }

    /// The next strip is settled, and others get under way. Whether `panels` are complete.
    fn advance(&mut self, panels: &mut Vec<Panel>, settled: &mut dyn FnMut(usize)) -> bool {
        let ahead = if self.worker.is_working() { AHEAD } else { 0 };
        while self.under_way.len() <= ahead {
            let resolution = self.resolution.filter(|_| self.worker.is_working());
            let Some(strip) = self.strips.prepare(resolution, &mut self.summary.stages) else {
                break;
            };
            if strip.is_asked() {
                self.worker.ask(Arc::clone(&strip.asked.question));
            }
            self.under_way.push_back(strip);
        }
        let Some(strip) = self.under_way.pop_front() else {
            return true;
        };
        let differences = strip.is_asked().then(|| {
            let begun = Instant::now();
            let answers = self.worker.answers();
            self.waiting += begun.elapsed();
            answers
        });
        let task = self.strips.task;
        let (cells, is_last) = (strip.cells(), strip.is_last);
        let has_failed = self.resolution.map(|_| self.worker.failure.is_some());
        let summary = &mut self.summary;
        let audit = strip.finish(task, differences.flatten(), has_failed, panels, summary);
        settled(cells);
        if audit.differing > 0 {
            // Who has been wrong once is not asked again, and not believed.
            self.worker.distrust(audit.differing, audit.cells);
        }
        is_last
    }
}

impl Strip<'_> {
    /// Whether there is something to ask an engine.
    fn is_asked(&self) -> bool {
        !self.asked.question.references.is_empty()
    }

    /// How many there are.
    fn cells(&self) -> usize {
        let columns = |(face, _): &(usize, usize)| self.group.faces[*face].pushes.columns.len();
        self.rows.iter().map(columns).sum()
    }

    /// Settles what the engine has left after these `differences`, and writes all cells into `panels`, which are made if there are none;
    /// `has_failed` is about an engine, if there is or was one.
    fn finish(
        self,
        task: &Task,
        differences: Option<Vec<CellDifference>>,
        has_failed: Option<bool>,
        panels: &mut Vec<Panel>,
        summary: &mut Summary,
    ) -> Audit {
        let Group { whiskers, faces } = &*self.group;
        let width = task.scene.grid.push_angle_deg.len();
        if panels.is_empty() {
            let cells = width * task.scene.grid.distance_mm.len();
            let panel = |_| Panel::unwritten(cells, task.plan.channels);
            *panels = whiskers.iter().map(panel).collect();
        }
        let asked = self.asked;
        let solved = differences.map(|differences| Solved { asked, differences });
        let solved = solved.unwrap_or_default();
        let (settled, audit) = strip::settle(
            task.plan.method,
            faces,
            &self.rows,
            solved,
            &mut summary.stages,
        );
        summary.audit += audit;
        if let Some(has_failed) = has_failed {
            settled.count(has_failed || audit.differing > 0, &mut summary.engine_cells);
        }
        let sides = task.sides.len();
        let fill = || answers::fill(width, whiskers, faces, sides, &settled, panels);
        summary.stages.time(Stage::Classification, fill);
        audit
    }
}
