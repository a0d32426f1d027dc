//! Cells: the response of an engine, with one column for each number of a cell.

use super::RowBatch;
use crate::classify::Outcome;
use crate::plan::STATE_CHANNELS;
use glam::DVec2;

/// Result of an engine for one cell of [`Cells`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Outcome of the engine for the cell.
    pub outcome: Outcome,
    /// Number of Newton steps that the engine took for the cell.
    pub steps: u32,
    /// Bound on the distance of the cell's pole from its target, in whisker lengths; NaN without a state.
    pub residual: f32,
    /// Channel values of the cell in map units, in the order of [`STATE_CHANNELS`], `[channel]`. They are unspecified without a solution, and
    /// where the batch does not request the channel.
    pub values: [f32; STATE_CHANNELS.len()],
    /// Contact coordinate and signed load `f/rho^2`, `(tau, load)`, dimensionless; unspecified without a solution, NaN if not requested.
    pub point: DVec2,
}

impl Cell {
    /// Creates a cell without a state.
    #[must_use]
    pub const fn new(outcome: Outcome, steps: u32) -> Self {
        Self {
            outcome,
            steps,
            residual: f32::NAN,
            values: [f32::NAN; STATE_CHANNELS.len()],
            point: DVec2::NAN,
        }
    }
}

/// Cells of one row of a [`RowBatch`], as writable columns of [`Cells`].
pub(crate) struct RowCells<'a> {
    pub outcome: &'a mut [Outcome],
    pub steps: &'a mut [u32],
    pub residual: &'a mut [f32],
    pub values: [&'a mut [f32]; STATE_CHANNELS.len()],
    pub points: &'a mut [DVec2],
}

impl RowCells<'_> {
    /// Replaces the cell at `index` of the row.
    pub fn set(&mut self, index: usize, cell: &Cell) {
        self.outcome[index] = cell.outcome;
        self.steps[index] = cell.steps;
        self.residual[index] = cell.residual;
        for (column, value) in self.values.iter_mut().zip(cell.values) {
            if let Some(number) = column.get_mut(index) {
                *number = value;
            }
        }
        if let Some(point) = self.points.get_mut(index) {
            *point = cell.point;
        }
    }

    /// Removes the first `count` cells and returns them.
    fn split_off(&mut self, count: usize) -> Self {
        Self {
            outcome: split_off(&mut self.outcome, count),
            steps: split_off(&mut self.steps, count),
            residual: split_off(&mut self.residual, count),
            values: self.values.each_mut().map(|column| split_off(column, count)),
            points: split_off(&mut self.points, count),
        }
    }
}

/// Removes the first `count` elements of a column and returns them; nothing of an empty column.
fn split_off<'a, T>(column: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let count = count.min(column.len());
    column.split_off_mut(..count).unwrap_or_default()
}

/// Cells of a [`RowBatch`], in its order, as columns.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// Outcome of the engine for each cell: `[cell]`.
    pub outcome: Vec<Outcome>,
    /// Number of Newton steps that the engine took for each cell: `[cell]`.
    pub steps: Vec<u32>,
    /// Bound on the distance of each cell's pole from its target, in whisker lengths: `[cell]`; NaN without a state.
    pub residual: Vec<f32>,
    /// Channel values in map units: `[channel][cell]`, in the order of [`STATE_CHANNELS`]. They are unspecified without a solution, and empty
    /// where the batch does not request the channel.
    pub values: [Vec<f32>; STATE_CHANNELS.len()],
    /// Contact and signed load `(tau, load)` of each cell: `[cell]`; unspecified without a solution, empty if the batch requests none.
    pub points: Vec<DVec2>,
}

/// Lengths of the columns that `batch` requests, of channel values and of points.
fn lengths(batch: &RowBatch) -> ([usize; STATE_CHANNELS.len()], usize) {
    let cells = batch.cells();
    let length = |is_wanted| if is_wanted { cells } else { 0 };
    (batch.channels.states().map(length), length(batch.channels.has_strain()))
}

impl Cells {
    /// Creates the cells of `batch`, still to be written, all with `outcome`.
    #[must_use]
    pub fn new(batch: &RowBatch, outcome: Outcome) -> Self {
        let (values, points) = lengths(batch);
        let cells = batch.cells();
        Self {
            outcome: vec![outcome; cells],
            steps: vec![0; cells],
            residual: vec![0.0; cells],
            values: values.map(|cells| vec![0.0; cells]),
            points: vec![DVec2::ZERO; points],
        }
    }

    fn all_mut(&mut self) -> RowCells<'_> {
        RowCells {
            outcome: &mut self.outcome,
            steps: &mut self.steps,
            residual: &mut self.residual,
            values: self.values.each_mut().map(Vec::as_mut_slice),
            points: &mut self.points,
        }
    }

    /// Returns the cells of each row of `batch`, which can be written in parallel.
    pub(crate) fn rows_mut(&mut self, batch: &RowBatch) -> Vec<RowCells<'_>> {
        let mut rest = self.all_mut();
        let rows = batch.rows.iter();
        rows.map(|row| rest.split_off(row.cells().len())).collect()
    }

    /// Returns the number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.outcome.len()
    }

    /// Returns true if there is no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.outcome.is_empty()
    }

    /// Returns true if every column has the length that `batch` requests.
    #[must_use]
    pub fn fit(&self, batch: &RowBatch) -> bool {
        let all = [self.outcome.len(), self.steps.len(), self.residual.len()];
        let wanted = (self.values.each_ref().map(Vec::len), self.points.len());
        all == [batch.cells(); 3] && wanted == lengths(batch)
    }

    /// Returns the cell at `index`; NaN in columns that the batch does not request.
    #[must_use]
    pub fn get(&self, index: usize) -> Cell {
        let value = |column: &Vec<f32>| column.get(index).copied().unwrap_or(f32::NAN);
        Cell {
            outcome: self.outcome[index],
            steps: self.steps[index],
            residual: self.residual[index],
            values: self.values.each_ref().map(value),
            point: self.points.get(index).copied().unwrap_or(DVec2::NAN),
        }
    }

    /// Replaces the cell at `index`.
    pub fn set(&mut self, index: usize, cell: &Cell) {
        self.all_mut().set(index, cell);
    }
}
