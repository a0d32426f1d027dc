//! From the cells of a row batch to panels: regimes, statuses and values.

use super::panel::RowMut;
use super::sliding::{self, FoundRow, FoundState};
use super::{Panel, doubt};
use crate::classify::{Regime, RowBoundary, Status, TIE};
use crate::engine::{BatchRow, Cell, Cells, Outcome, RowBatch, SideColumns, WhiskerSide};
use rayon::prelude::*;
use std::ops::Range;

/// Classifies the `cells` of a batch of whole rows and writes them into `panels`, which are `width` cells wide; each panel has
/// `sides_per_panel` sides.
pub fn fill(
    batch: &RowBatch,
    cells: &Cells,
    sides_per_panel: usize,
    width: usize,
    panels: &mut [Panel],
) {
    let panels = panels.par_iter_mut().enumerate();
    panels.for_each(|(index, panel)| {
        // The columns of two sides may be in one row of a panel.
        for side in index * sides_per_panel..(index + 1) * sides_per_panel {
            let [from, to] =
                [side, side + 1].map(|side| batch.rows.partition_point(|row| row.side < side));
            let rows = &batch.rows[from..to];
            let Some(first) = rows.first() else { continue };
            let into = panel.rows_mut(width, first.row..first.row + rows.len());
            let side = &batch.sides[side];
            let found = into.into_par_iter().zip(rows).map(|(into, row)| {
                let writer = RowWriter {
                    side,
                    row,
                    boundary: boundary(side, row.row),
                    cells,
                    into,
                    found: Vec::new(),
                };
                writer.write()
            });
            let found: Vec<FoundRow> = found.flatten_iter().collect();
            sliding::mark(side, &found, width, &mut panel.status);
        }
    });
}

fn boundary(side: &WhiskerSide, row: usize) -> RowBoundary {
    RowBoundary::new(side.sheet.touches(row), &side.sheet.crossings[row])
}

/// The status of an outcome before it is compared with the boundary; `is_on_span` if the boundary has a state there.
const fn status(outcome: Outcome, is_on_span: bool) -> Status {
    match outcome {
        Outcome::Solved => Status::Solved,
        // At the tip both verdicts are right; the boundary's is taken.
        Outcome::AtTip if is_on_span => Status::Solved,
        Outcome::AtTip | Outcome::BeyondTip => Status::BeyondTip,
        Outcome::BeyondFold => Status::BeyondFold,
        Outcome::OffSheet => Status::Outside,
        Outcome::NotConverged
        | Outcome::NotFinite
        | Outcome::NearEdge
        | Outcome::OutsideTrust
        | Outcome::Missed
        | Outcome::NoBasePoint => Status::NotConverged,
    }
}

const fn has_state(regime: Regime) -> bool {
    matches!(regime, Regime::Contact | Regime::Unreachable)
}

/// Writes one row of one whisker side.
struct RowWriter<'a> {
    side: &'a WhiskerSide,
    row: &'a BatchRow,
    boundary: RowBoundary,
    cells: &'a Cells,
    into: RowMut<'a>,
    /// States whose contact friction may have dragged elsewhere, with the index of the cell.
    found: Vec<(usize, FoundState)>,
}

impl RowWriter<'_> {
    /// Writes all cells; cells in doubt are solved once more. Returns the states found if there is friction.
    fn write(mut self) -> Option<FoundRow> {
        let columns = &self.side.columns.columns;
        let row = &self.side.sheet.rows[self.row.row];
        let is_touch = |push: f64| push == 0.0 && row.is_reached();
        let touches = columns.iter().take_while(|column| is_touch(column.push));
        let touches = touches.count();
        let mut doubtful = Vec::new();
        for index in 0..touches {
            let steps = self.cells.steps[self.row.first + index];
            let cell = self.side.first_touch(self.row.row, steps);
            self.write_cell(index, cell, &mut doubtful);
        }
        let first = self.row.first;
        let outcomes = &self.cells.outcome[first + touches..first + columns.len()];
        let mut from = touches;
        for run in outcomes.chunk_by(PartialEq::eq) {
            let run = from..from + run.len();
            from = run.end;
            if self.write_run(&run).is_none() {
                for index in run {
                    self.write_cell(index, self.cells.get(first + index), &mut doubtful);
                }
            }
        }
        if !doubtful.is_empty() {
            let (side, row) = (self.side, self.row.row);
            let again = doubt::solve(side, row, &self.boundary, doubtful);
            for (index, cell) in again {
                self.found.retain(|(own, _)| *own != index);
                self.write_cell(index, cell, &mut Vec::new());
            }
            self.found.sort_unstable_by_key(|(index, _)| *index);
        }
        let row = self.row.row;
        let states: Vec<FoundState> = self.found.into_iter().map(|(_, state)| state).collect();
        (!states.is_empty()).then_some(FoundRow { row, states })
    }

    /// Writes a cell, and appends it to `doubtful` if its regime may be found by continuation.
    fn write_cell(&mut self, index: usize, cell: Cell, doubtful: &mut Vec<(usize, Cell)>) {
        let column = &self.side.columns.columns[index];
        let push = column.push.abs();
        let span = self.boundary.span(push);
        let status = status(cell.outcome, span.is_some());
        let (regime, status) = self.boundary.classify(push, status);
        let margin_deg = span
            .filter(|_| has_state(regime))
            .map_or(f32::NAN, |span| span.margin_deg(push));
        let into = &mut self.into;
        into.regime[column.index] = regime.code();
        into.status[column.index] = status.code();
        into.newton_steps[column.index] = cell.steps;
        into.margin_deg[column.index] = margin_deg;
        let keeps_residual = has_state(regime) || regime == Regime::Unresolved;
        into.residual[column.index] = if keeps_residual {
            cell.residual
        } else {
            f32::NAN
        };
        let values = if has_state(regime) {
            cell.values
        } else {
            Cell::NO_VALUES
        };
        for (channel, value) in into.state.iter_mut().zip(values) {
            if let Some(own) = channel.get_mut(column.index) {
                *own = value;
            }
        }
        if self.side.has_friction() && status == Status::Solved {
            let found = FoundState {
                column: column.index,
                regime,
                point: cell.point,
                push,
            };
            self.found.push((index, found));
        }
        let is_touch = push <= TIE && self.boundary.detachment().is_some();
        if regime == Regime::Unresolved || is_touch && regime != Regime::Contact {
            doubtful.push((index, cell));
        }
    }

    /// Writes the cells of `run`, which have one outcome, by columns if they have one verdict; otherwise returns `None`.
    fn write_run(&mut self, run: &Range<usize>) -> Option<()> {
        let columns: &SideColumns = &self.side.columns;
        let ours = &columns.columns[run.clone()];
        let [from, to] = [ours.first()?, ours.last()?].map(|column| column.push.abs());
        let outcome = self.cells.outcome[self.row.first + run.start];
        let (boundary, into) = (&self.boundary, &mut self.into);
        if !boundary.is_one_verdict(from, to) {
            return None;
        }
        let span = boundary.span(from);
        let (regime, status) = boundary.classify(from, status(outcome, span.is_some()));
        if regime == Regime::Unresolved || self.side.has_friction() && status == Status::Solved {
            return None;
        }
        let place = columns.span(run);
        into.regime[place.clone()].fill(regime.code());
        into.status[place.clone()].fill(status.code());
        let cells = self.row.first + run.start..self.row.first + run.end;
        let steps = &self.cells.steps[cells.clone()];
        columns.write(into.newton_steps, run, |i| steps[i]);
        match span.filter(|_| has_state(regime)) {
            Some(span) => {
                let residual = &self.cells.residual[cells.clone()];
                columns.write(into.residual, run, |i| residual[i]);
                let margin = |i: usize| span.margin_deg(ours[i].push.abs());
                columns.write(into.margin_deg, run, margin);
                for (channel, column) in into.state.iter_mut().zip(&self.cells.values) {
                    if let Some(column) = column.get(cells.clone()) {
                        columns.write(channel, run, |i| column[i]);
                    }
                }
            }
            None => {
                let numbers = [&mut *into.residual, &mut *into.margin_deg].into_iter();
                let channels = into.state.iter_mut().map(|channel| &mut **channel);
                for column in numbers.chain(channels) {
                    if let Some(own) = column.get_mut(place.clone()) {
                        own.fill(f32::NAN);
                    }
                }
            }
        }
        Some(())
    }
}
