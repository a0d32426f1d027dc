//! Settled cells: where the answer of each comes from.

use super::WhiskerSide;
use super::columns::Push;
use super::runs::{Run, Source};
use super::summary::EngineCells;
use crate::classify::{RowBoundary, Status, TIE};
use crate::engine::{BasePoint, CellDifference, Question};
use crate::refine::{ContactState, End, Refined};
use crate::sheet::Row;
use std::sync::Arc;

/// Some rows, settled.
pub struct Settled {
    /// The rows.
    pub rows: Vec<SettledRow>,
    /// What an engine was asked, and what it made of the cells.
    pub question: Arc<Question>,
    pub differences: Vec<CellDifference>,
    /// What the refinement made of the other cells.
    pub refined: Vec<Refined>,
    /// Those of them that no engine was asked for.
    pub unasked: u64,
}

/// A settled row of a face.
pub struct SettledRow {
    /// Index of the face.
    pub face: usize,
    /// Row of the panel.
    pub row: usize,
    /// All its cells, by growing push angle.
    pub runs: Vec<Run>,
}

/// A settled cell.
#[derive(Clone, Copy, Debug)]
pub struct Cell<'a> {
    /// Where it is.
    pub push: Push,
    /// How it was settled; the boundary has not been asked yet.
    pub status: Status,
    /// What is known of its state.
    pub state: State<'a>,
    /// Newton steps.
    pub steps: u32,
}

/// A state, as it was computed.
#[derive(Clone, Copy, Debug)]
pub enum State<'a> {
    /// None.
    Unknown,
    /// First touch in this row, whatever solved the cell: the resting whisker, without a load.
    FirstTouch(Row),
    /// In `f64`, to the last one if there were several.
    Refined(ContactState),
    /// By an engine, as it differs from a reference.
    Different(&'a BasePoint, &'a CellDifference),
}

impl Cell<'_> {
    /// Whether its push is none, on a row that ends one from first touch.
    pub fn is_first_touch(&self, boundary: &RowBoundary) -> bool {
        self.push.angle.abs() <= TIE && boundary.detachment().is_some()
    }
}

impl Settled {
    /// Cells that an engine solved.
    pub fn solved(&self) -> u64 {
        let cells = self.differences.iter();
        cells.filter(|cell| cell.outcome.is_vouched_for()).count() as u64
    }

    /// Adds to `counts` what became of the cells, with an engine that `has_failed` or not.
    pub fn count(&self, has_failed: bool, counts: &mut EngineCells) {
        for cell in &self.differences {
            counts.count(cell.outcome);
        }
        *match has_failed {
            true => &mut counts.on_cpu_instead,
            false => &mut counts.without_reference,
        } += self.unasked;
    }

    /// The cells of a `run` of `row` of `face`.
    pub fn cells<'a>(
        &'a self,
        face: &'a WhiskerSide,
        row: usize,
        run: &Run,
    ) -> impl Iterator<Item = Cell<'a>> + 'a {
        let row = &face.sheet.rows[row];
        run.each().map(move |(cell, source)| {
            let push = face.pushes.columns[cell];
            let (status, state, steps) = match source {
                Source::Outside => (Status::Outside, State::Unknown, 0),
                Source::Refined(index) => {
                    let refined = &self.refined[index as usize];
                    let status = match refined.end {
                        End::Solved => Status::Solved,
                        End::BeyondTip => Status::BeyondTip,
                        End::BeyondFold => Status::BeyondFold,
                        End::NotConverged => Status::NotConverged,
                    };
                    (status, State::Refined(refined.state), refined.steps)
                }
                Source::Engine(reference, cell) => {
                    let cell = &self.differences[cell as usize];
                    let reference = &self.question.references[reference as usize];
                    (Status::Solved, State::Different(reference, cell), 1)
                }
            };
            let is_first_touch = push.angle == 0.0 && row.is_reached();
            let (status, state) = match is_first_touch {
                true => (Status::Solved, State::FirstTouch(*row)),
                false => (status, state),
            };
            Cell {
                push,
                status,
                state,
                steps,
            }
        })
    }
}
