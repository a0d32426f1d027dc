//! Row batches: the cells of some rows, as a request to an engine.

use super::{KnownRow, RowExpansion, WhiskerSide};
use crate::plan::Channels;
use crate::sheet::Sheet;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use whiskmap_mechanics::shooting::batch::Method;

/// Row of a batch: the cells of one row to solve.
#[derive(Clone, Debug)]
pub struct BatchRow {
    /// Index of the row's whisker side in the batch.
    pub side: usize,
    /// Index of the row in the side's sheet.
    pub row: usize,
    /// Columns of the side whose cells are to be solved, `[range]`: growing, disjoint ranges.
    pub columns: Vec<Range<usize>>,
    /// Index of the row's first cell among the cells of the batch.
    pub first_cell: usize,
}

impl BatchRow {
    /// Returns the row's cells among the cells of the batch.
    #[must_use]
    pub fn cells(&self) -> Range<usize> {
        let count: usize = self.columns.iter().map(Range::len).sum();
        self.first_cell..self.first_cell + count
    }

    /// Returns the column of each cell of the row, in order.
    pub fn each_column(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        self.columns.iter().flat_map(Range::clone)
    }

    /// Returns the number of the row's cells whose push angles are before `push`; arguments as for [`Self::columns_before`].
    #[must_use]
    pub fn cells_before(&self, push: f64, pushes: &[f64]) -> usize {
        let before = self.columns_before(push, pushes);
        before.map(|columns| columns.len()).sum()
    }

    /// Returns the columns of the row whose push angles are before `push`, `[range]`. `pushes` are the push angles of the side's columns. All
    /// are magnitudes in radians.
    pub fn columns_before(
        &self,
        push: f64,
        pushes: &[f64],
    ) -> impl Iterator<Item = Range<usize>> + use<'_> {
        let end = pushes.partition_point(|other| *other < push);
        let before = self.columns.iter().map(move |range| range.start..range.end.min(end));
        before.take_while(|range| !range.is_empty())
    }
}

/// Returns true if an engine whose rows have a residual of at most `most` whisker lengths needs nets with the values of states for a map with these
/// `channels`.
#[must_use]
pub fn needs_values(channels: Channels, most: f64) -> bool {
    channels.needs_states() || most < KnownRow::RESIDUAL
}

/// Number of rows of a side that are compared with their net at once, on one thread.
const ROWS_TOGETHER: usize = 64;

/// Row batch: cells of some rows, for an [`Engine`](super::Engine).
#[derive(Clone, Debug)]
pub struct RowBatch {
    /// Integration method of the trajectories: effects and resolution.
    pub method: Method,
    /// Whisker sides of the batch: `[side]`.
    pub sides: Arc<[WhiskerSide]>,
    /// Rows of the batch, in the order of their cells: `[row]`.
    pub rows: Vec<BatchRow>,
    /// Channels that the map has: an engine returns the values of those of a state, and `(tau, load)` for the largest bending strain.
    pub channels: Channels,
    /// Expansions of the rows, `[row]`: `None` for a row without a net. Empty before [`RowBatch::with_nets`], and for rows without numbers of
    /// states.
    pub expansions: Vec<Option<RowExpansion>>,
    /// Rows without numbers of states, `[row]`: `None` for a row that is not known.
    pub known: Vec<Option<KnownRow>>,
}

impl RowBatch {
    /// Creates a batch of all cells of `rows`, pairs of a side and a row of its sheet, with the standard channels.
    #[must_use]
    pub fn new(
        method: Method,
        sides: Arc<[WhiskerSide]>,
        rows: impl IntoIterator<Item = (usize, usize)>,
    ) -> Self {
        let mut batch = Self {
            method,
            channels: Channels::STANDARD,
            sides,
            rows: Vec::new(),
            expansions: Vec::new(),
            known: Vec::new(),
        };
        for (side, row) in rows {
            let columns = 0..batch.sides[side].columns.len();
            batch.rows.push(BatchRow {
                side,
                row,
                columns: std::iter::once(columns).collect(),
                first_cell: batch.cells(),
            });
        }
        batch
    }

    /// Returns a batch of the cells in some `columns` of each row of this one, without expansions or known rows.
    #[must_use]
    pub fn only(&self, columns: impl IntoIterator<Item = Vec<Range<usize>>>) -> Self {
        let mut part = Self::new(self.method, Arc::clone(&self.sides), []);
        part.channels = self.channels;
        for (row, columns) in self.rows.iter().zip(columns) {
            part.rows.push(BatchRow { columns, first_cell: part.cells(), ..*row });
        }
        part
    }

    /// Returns pairs of the index of a cell in this batch of whole rows and in `part`, a batch of some of its cells.
    pub fn places_in<'a>(&'a self, part: &'a Self) -> impl Iterator<Item = (usize, usize)> + 'a {
        let rows = self.rows.iter().zip(&part.rows);
        rows.flat_map(|(whole, part)| {
            let columns = part.each_column();
            columns.map(|column| whole.first_cell + column).zip(part.first_cell..)
        })
    }

    /// Returns true if an engine can solve some cells of the batch: a row has expansions, or is known.
    #[must_use]
    pub fn is_for_engine(&self) -> bool {
        self.expansions.iter().any(Option::is_some) || self.known.iter().any(Option::is_some)
    }

    /// Returns the batch with the expansions of all rows, or with their known rows if the map needs no values ([`needs_values`]). A row whose
    /// residual exceeds `most` whisker lengths gets none.
    #[must_use]
    pub fn with_nets(mut self, most: f64) -> Self {
        let sides = &self.sides;
        if needs_values(self.channels, most) {
            let rows = self.rows.par_iter();
            let expansions = rows.map(|row| RowExpansion::of(&sides[row.side], row.row, most));
            self.expansions = expansions.collect();
        } else {
            let by_side = self.rows.par_chunk_by(|a, b| a.side == b.side);
            let together = by_side.flat_map(|of_side| of_side.par_chunks(ROWS_TOGETHER));
            let known = together.flat_map_iter(|of_side| {
                let rows: Vec<usize> = of_side.iter().map(|row| row.row).collect();
                KnownRow::of(&sides[of_side[0].side], &rows)
            });
            self.known = known.collect();
        }
        self
    }

    /// Returns the sheets of all sides of the batch: `[side]`.
    #[must_use]
    pub fn sheets(&self) -> Vec<&Sheet> {
        self.sides.iter().map(|side| &side.sheet).collect()
    }

    /// Returns the number of cells of all rows of the batch.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.rows.last().map_or(0, |last| last.cells().end)
    }
}
