//! The response of an engine: one column per number of a cell.

use super::RowBatch;
use crate::plan::STATE_CHANNELS;
use glam::DVec2;
use std::ops::Range;

/// What an engine made of a cell. A cell without a solution is data, not an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Solved, with a bound on the residual.
    Solved,
    /// Solved, with the contact at the tip up to the residual.
    AtTip,
    /// No solution: the contact lies beyond the tip.
    BeyondTip,
    /// No solution: the push angle lies beyond the fold.
    BeyondFold,
    /// No solution: the sheet has no guess there.
    OffSheet,
    /// Failed: neither a solution nor a proof that there is none.
    NotConverged,
    /// Not certified: a number is not finite, or nothing was written.
    NotFinite,
    /// Not certified: next to the fold or to the tip.
    NearEdge,
    /// Not certified: outside the trust region of its base point.
    OutsideTrust,
    /// Not certified: the bound on the residual is too large.
    Missed,
    /// Not computed: the row has no base point there.
    NoBasePoint,
}

/// One cell of [`Cells`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// What the engine made of it.
    pub outcome: Outcome,
    /// Newton steps taken.
    pub steps: u32,
    /// Bound on the distance of the pole from its place, in whisker lengths; NaN without a state.
    pub residual: f32,
    /// Channel values in map units, in the order of [`STATE_CHANNELS`]; NaN without a solution.
    pub values: [f32; STATE_CHANNELS.len()],
    /// `(tau, load)` of the contact; NaN where unknown.
    pub point: DVec2,
}

impl Cell {
    /// Values of a cell without a solution.
    pub const NO_VALUES: [f32; STATE_CHANNELS.len()] = [f32::NAN; STATE_CHANNELS.len()];

    /// A cell without a state.
    #[must_use]
    pub const fn new(outcome: Outcome, steps: u32) -> Self {
        Self {
            outcome,
            steps,
            residual: f32::NAN,
            values: Self::NO_VALUES,
            point: DVec2::NAN,
        }
    }

    /// This cell with another outcome.
    #[must_use]
    pub const fn with_outcome(self, outcome: Outcome) -> Self {
        Self { outcome, ..self }
    }
}

/// The cells of a [`RowBatch`], in its order, as columns.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// What the engine made of each cell.
    pub outcome: Vec<Outcome>,
    /// Newton steps taken.
    pub steps: Vec<u32>,
    /// Bounds on the distance of the pole from its place, in whisker lengths; NaN without a state.
    pub residual: Vec<f32>,
    /// Channel values in map units, a column per name in [`STATE_CHANNELS`], unspecified without a solution; empty if the batch wants none.
    pub values: [Vec<f32>; STATE_CHANNELS.len()],
    /// `(tau, load)` of contacts, unspecified without a solution; empty if the batch wants none.
    pub points: Vec<DVec2>,
}

impl Cells {
    /// Cells of `batch` that are still to be written, all with `outcome`.
    #[must_use]
    pub fn new(batch: &RowBatch, outcome: Outcome) -> Self {
        let count = batch.cells();
        let values = if batch.has_values { count } else { 0 };
        let points = if batch.has_points { count } else { 0 };
        Self {
            outcome: vec![outcome; count],
            steps: vec![0; count],
            residual: vec![0.0; count],
            values: std::array::from_fn(|_| vec![0.0; values]),
            points: vec![DVec2::ZERO; points],
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.outcome.len()
    }

    /// Returns true if there is no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.outcome.is_empty()
    }

    /// Returns true if every column has the length that `batch` wants.
    #[must_use]
    pub fn fit(&self, batch: &RowBatch) -> bool {
        let count = batch.cells();
        let values = if batch.has_values { count } else { 0 };
        let points = if batch.has_points { count } else { 0 };
        [self.outcome.len(), self.steps.len(), self.residual.len()] == [count; 3]
            && self.values.iter().all(|column| column.len() == values)
            && self.points.len() == points
    }

    /// The cell at `index`.
    #[must_use]
    pub fn get(&self, index: usize) -> Cell {
        Cell {
            outcome: self.outcome[index],
            steps: self.steps[index],
            residual: self.residual[index],
            values: self
                .values
                .each_ref()
                .map(|column| column.get(index).copied().unwrap_or(f32::NAN)),
            point: self.points.get(index).copied().unwrap_or(DVec2::NAN),
        }
    }

    /// Replaces the cell at `index`.
    pub fn set(&mut self, index: usize, cell: &Cell) {
        self.rows_mut(std::slice::from_ref(&(index..index + 1)))[0].set(0, cell);
    }

    /// Splits the cells at growing, disjoint `ranges`, which can be written side by side.
    pub(super) fn rows_mut(&mut self, ranges: &[Range<usize>]) -> Vec<CellsMut<'_>> {
        let mut rest = CellsMut {
            outcome: &mut self.outcome,
            steps: &mut self.steps,
            residual: &mut self.residual,
            values: self.values.each_mut().map(Vec::as_mut_slice),
            points: &mut self.points,
        };
        let mut from = 0;
        let parts = ranges.iter().map(|range| {
            rest.take(range.start - from);
            from = range.end;
            rest.take(range.len())
        });
        parts.collect()
    }
}

/// Some cells of [`Cells`].
pub(super) struct CellsMut<'a> {
    outcome: &'a mut [Outcome],
    steps: &'a mut [u32],
    residual: &'a mut [f32],
    values: [&'a mut [f32]; STATE_CHANNELS.len()],
    points: &'a mut [DVec2],
}

/// Removes the first `count` elements of a column and returns them; nothing of an empty column.
fn take<'a, T>(column: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    column
        .split_off_mut(..count.min(column.len()))
        .unwrap_or_default()
}

impl<'a> CellsMut<'a> {
    fn take(&mut self, count: usize) -> Self {
        Self {
            outcome: take(&mut self.outcome, count),
            steps: take(&mut self.steps, count),
            residual: take(&mut self.residual, count),
            values: self.values.each_mut().map(|column| take(column, count)),
            points: take(&mut self.points, count),
        }
    }

    /// Replaces the cell at `index`.
    pub fn set(&mut self, index: usize, cell: &Cell) {
        self.outcome[index] = cell.outcome;
        self.steps[index] = cell.steps;
        self.residual[index] = cell.residual;
        for (column, value) in self.values.iter_mut().zip(cell.values) {
            if let Some(own) = column.get_mut(index) {
                *own = value;
            }
        }
        if let Some(point) = self.points.get_mut(index) {
            *point = cell.point;
        }
    }
}
