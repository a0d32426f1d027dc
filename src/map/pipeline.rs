//! Strips of rows on their way: the engine solves one while the threads judge the one before and prepare the one after.
//!
//! A strip ahead is all that there is room for, and all that it takes: the threads share the work on each strip. What an audit finds
//! in a strip is known before the answers to the next one are looked at, so that no race decides what becomes of a cell.

use super::panel::Panel;
use super::stages::Stage;
use super::strip::{self, Asked, Solved};
use super::task::{Group, Task};
use super::{Audit, Summary, answers};
use crate::integrate::{CellDifference, Engine, Fallback};
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
    asked: Asked,
    /// What the engine made of it.
    differences: Option<Vec<CellDifference>>,
}

/// The strips of a task, in order.
struct Strips<'a> {
    task: &'a Task<'a>,
    groups: Box<dyn Iterator<Item = Range<usize>> + 'a>,
    /// The group of the last strip, and how many of its rows are in strips.
    begun: Option<(Arc<Group<'a>>, usize)>,
}

impl<'a> Strips<'a> {
    /// The next one, with references if there is an engine to ask.
    fn prepare(&mut self, has_engine: bool) -> Option<Strip<'a>> {
        let task = self.task;
        let (group, from) = match self.begun.take() {
            Some(begun) => begun,
            None => {
                let whiskers = self.groups.next()?;
                let group = task.stages.of(Stage::Sheets, || task.group(whiskers));
                (Arc::new(group), 0)
            }
        };
        let height = task.scene.grid.distance_mm.len();
        let all = group.faces.len() * height;
        let to = all.min(from + task.rows_at_once);
        let rows: Vec<(usize, usize)> = (from..to).map(|i| (i / height, i % height)).collect();
        let mut asked = Asked::default();
        if has_engine {
            let ask = || Asked::new(task.plan.method, &group.faces, &rows);
            asked = task.stages.of(Stage::References, ask);
        }
        self.begun = (to < all).then(|| (Arc::clone(&group), to));
        Some(Strip {
            group,
            rows,
            is_last: to == all,
            asked,
            differences: None,
        })
    }
}

/// A run under way.
pub struct Pipeline<'a, 'e> {
    engine: Fallback<'e>,
    strips: Strips<'a>,
    prepared: Option<Strip<'a>>,
    solved: Option<Strip<'a>>,
    /// Counts and times up to now.
    pub summary: Summary,
}

impl<'a, 'e> Pipeline<'a, 'e> {
    /// Before its first strip.
    pub fn new(task: &'a Task<'a>, engine: Option<&'e mut dyn Engine>) -> Self {
        let strips = Strips {
            task,
            groups: Box::new(task.plan.groups()),
            begun: None,
        };
        let failure = None;
        Self {
            engine: Fallback { engine, failure },
            strips,
            prepared: None,
            solved: None,
            summary: Summary::default(),
        }
    }

    /// The panels of the next group.
    pub fn panels(&mut self, settled: &mut dyn FnMut(usize)) -> Vec<Panel> {
        let mut panels = Vec::new();
        while !self.advance(&mut panels, settled) {}
        let count = || panels.iter().for_each(|panel| self.summary.count(panel));
        self.strips.task.stages.of(Stage::Judging, count);
        panels
    }

    /// What there is to say in the end, after so much time.
    pub fn finish(self, wall: Duration) -> Summary {
        let mut summary = self.summary;
        summary.engine_failure = self.engine.failure;
        summary.stages = self.strips.task.stages.times();
        summary.wall = wall;
        summary
    }

    /// All strips on their way advance. Whether `panels` are complete.
    fn advance(&mut self, panels: &mut Vec<Panel>, settled: &mut dyn FnMut(usize)) -> bool {
        let Self {
            engine,
            strips,
            summary,
            ..
        } = self;
        let task = strips.task;
        let has_engine = engine.engine.is_some();
        let has_failed = engine.failure.is_some();
        let before = self.solved.take();
        let mut now = self.prepared.take();
        let is_last = before.as_ref().map(|strip| strip.is_last);
        let mut audit = Audit::default();
        let mut answer = (None, Duration::ZERO);
        let done = rayon::in_place_scope(|scope| {
            let is_asked = |strip: &&Strip| has_engine && !strip.asked.references.is_empty();
            if let Some(Strip { asked, .. }) = now.as_ref().filter(is_asked) {
                let (engine, answer) = (&mut *engine, &mut answer);
                scope.spawn(move |_| {
                    let start = Instant::now();
                    let Asked {
                        rods, references, ..
                    } = asked;
                    let solve = || engine.solve(task.plan.method, rods, &task.angles, references);
                    let solved = task.stages.of(Stage::References, solve);
                    *answer = (solved, start.elapsed());
                });
            }
            if let Some(strip) = before {
                let cells = strip.cells();
                let failed = (has_engine || has_failed).then_some(has_failed);
                let finish = || strip.finish(task, failed, panels, summary);
                audit = task.stages.of(Stage::Judging, finish);
                settled(cells);
            }
            self.prepared = strips.prepare(has_engine);
            Instant::now()
        });
        let (differences, device) = answer;
        summary.wait(device, done.elapsed());
        if audit.differing > 0 {
            // Who has been wrong once is not asked again, and not believed.
            engine.distrust(audit.differing, audit.cells);
        } else if let Some(strip) = &mut now {
            strip.differences = differences;
        }
        let is_over = now.is_none() && self.prepared.is_none();
        self.solved = now;
        is_last.unwrap_or(is_over)
    }
}

impl Strip<'_> {
    /// How many there are.
    fn cells(&self) -> usize {
        let columns = |(face, _): &(usize, usize)| self.group.faces[*face].pushes.columns.len();
        self.rows.iter().map(columns).sum()
    }

    /// Settles what the engine has left, and writes all cells into `panels`, which are made if there are none; `has_failed` is about an
    /// engine, if there is or was one.
    fn finish(
        self,
        task: &Task,
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
        let solved = self
            .differences
            .map(|differences| Solved { asked, differences });
        let solved = solved.unwrap_or_default();
        let (settled, audit) =
            strip::settle(task.plan.method, faces, &self.rows, solved, &task.stages);
        summary.audit += audit;
        if let Some(has_failed) = has_failed {
            settled.count(has_failed || audit.differing > 0, &mut summary.engine_cells);
        }
        answers::fill(width, whiskers, faces, task.sides.len(), &settled, panels);
        audit
    }
}
