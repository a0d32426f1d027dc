//! Row batches: the cells of some rows, as a request to an engine.

use super::{RowExpansion, WhiskerSide};
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
    /// Cells of the row to solve, `[range]`: growing, disjoint ranges of the side's columns.
    pub cells: Vec<Range<usize>>,
    /// Index of the row's first cell among the cells of the batch.
    pub first: usize,
}

impl BatchRow {
    /// Returns the number of cells of the row in the batch.
    #[must_use]
    pub fn count(&self) -> usize {
        self.cells.iter().map(Range::len).sum()
    }

    /// Returns the cells of the row to solve, in order.
    pub fn each(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        self.cells.iter().flat_map(Range::clone)
    }

    /// Returns the cells of the row to solve whose push angles are before `push`, `[range]`. `magnitudes` are the push angles of the
    /// side's columns, in radians.
    pub fn before(
        &self,
        push: f64,
        magnitudes: &[f64],
    ) -> impl Iterator<Item = Range<usize>> + use<'_> {
        let end = magnitudes.partition_point(|magnitude| *magnitude < push);
        let before = self
            .cells
            .iter()
            .map(move |range| range.start..range.end.min(end));
        before.take_while(|range| !range.is_empty())
    }
}

/// Row batch: cells of some rows, for an [`Engine`](super::Engine).
#[derive(Clone, Debug)]
pub struct RowBatch {
    /// Integration method of the trajectories: effects and resolution.
    pub method: Method,
    /// Whisker sides of the batch: `[side]`.
    pub sides: Arc<[WhiskerSide]>,
    /// Rows of the batch, in the order of their cells: `[row]`.
    pub rows: Vec<BatchRow>,
    /// Signed push angles of the columns of all sides, in radians: `[column]`.
    pub pushes: Arc<[f64]>,
    /// Channels that the map has: an engine returns the values of those of a state, and `(tau, load)` for the largest bending strain.
    pub channels: Channels,
    /// Expansions of the rows, `[row]`: `None` for a row without a net. Empty before [`RowBatch::with_expansions`].
    pub expansions: Vec<Option<RowExpansion>>,
}

impl RowBatch {
    /// Creates a batch of all cells of `rows`, pairs of a side and a row of its sheet, with the standard channels.
    #[must_use]
    pub fn new(
        method: Method,
        sides: Arc<[WhiskerSide]>,
        pushes: Arc<[f64]>,
        rows: impl IntoIterator<Item = (usize, usize)>,
    ) -> Self {
        let mut first = 0;
        let rows = rows.into_iter().map(|(side, row)| {
            let columns = sides[side].columns.len();
            first += columns;
            BatchRow {
                side,
                row,
                cells: std::iter::once(0..columns).collect(),
                first: first - columns,
            }
        });
        let rows = rows.collect();
        Self {
            method,
            channels: Channels::STANDARD,
            sides,
            rows,
            pushes,
            expansions: Vec::new(),
        }
    }

    /// Returns a batch of some `cells` of each row of this one, without expansions.
    #[must_use]
    pub fn only(&self, cells: impl IntoIterator<Item = Vec<Range<usize>>>) -> Self {
        let (sides, pushes) = (Arc::clone(&self.sides), Arc::clone(&self.pushes));
        let mut part = Self::new(self.method, sides, pushes, []);
        part.channels = self.channels;
        for (row, cells) in self.rows.iter().zip(cells) {
            part.rows.push(BatchRow {
                cells,
                first: part.cells(),
                ..*row
            });
        }
        part
    }

    /// Returns pairs of the index of a cell in this batch and in `part`, a batch of some of its cells.
    pub fn places_in<'a>(&'a self, part: &'a Self) -> impl Iterator<Item = (usize, usize)> + 'a {
        let rows = self.rows.iter().zip(&part.rows);
        rows.flat_map(|(whole, part)| part.each().map(|cell| whole.first + cell).zip(part.first..))
    }

    /// Returns true if an engine can solve some cells of the batch: a row has expansions.
    #[must_use]
    pub fn is_for_engine(&self) -> bool {
        self.expansions.iter().any(Option::is_some)
    }

    /// Returns the batch with the expansions of all rows that nets of the sides have, with a residual of at most `most` whisker lengths.
    #[must_use]
    pub fn with_expansions(mut self, most: f64) -> Self {
        let rows = self.rows.par_iter();
        let expansions = rows.map(|row| RowExpansion::of(&self.sides[row.side], row.row, most));
        self.expansions = expansions.collect();
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
        self.rows.last().map_or(0, |last| last.first + last.count())
    }
}
