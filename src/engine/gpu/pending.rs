//! Pending batches: a batch on the device is sent in parts, whose cells return in the same order.

use crate::classify::Outcome;
use crate::engine::{BatchRow, Cells, Precision, RowBatch, spectral};
use std::ops::Range;
use std::sync::Arc;

/// Pending batch, of which parts are on the device.
#[derive(Debug)]
pub struct PendingBatch {
    pub batch: Arc<RowBatch>,
    /// Cells of the pending batch; cells without a result are [`Outcome::NoRow`].
    pub cells: Cells,
    /// Number of submissions of the pending batch that have not returned.
    pub in_flight: usize,
    /// Number of rows that have been sent, or have no cell to send.
    sent: usize,
}

impl PendingBatch {
    /// Creates the pending batch, with the cells that need no device: those beyond the ends of rows, and those [near touch](Precision::near_touch).
    pub fn new(batch: Arc<RowBatch>, precision: Precision) -> Self {
        let mut cells = Cells::new(&batch, Outcome::NoRow);
        let rows = batch.rows.iter().zip(&batch.expansions);
        for ((row, expansion), mut into) in rows.zip(cells.rows_mut(&batch)) {
            let Some(expansion) = expansion else {
                continue;
            };
            let pushes = &batch.sides[row.side].columns.pushes;
            let near = precision.near_touch() * expansion.end_push;
            let near_row = BatchRow { columns: row.columns_before(near, pushes).collect(), ..*row };
            let count = near_row.cells().len();
            if count > 0 {
                let goal = precision.goal();
                spectral::write(&batch, &near_row, expansion, goal, &mut into);
                into.outcome[count..].fill(Outcome::NoRow);
            }
            expansion.write_beyond(row, pushes, into.outcome);
        }
        Self { cells, batch, in_flight: 0, sent: 0 }
    }

    /// Returns true if a part of the pending batch is still to be sent.
    pub fn is_waiting(&self) -> bool {
        self.sent < self.batch.rows.len()
    }

    /// Returns true if all cells of the pending batch have returned.
    pub fn is_done(&self) -> bool {
        !self.is_waiting() && self.in_flight == 0
    }

    /// Returns the rows of the pending batch to send next: at least one, with at most `cells` cells.
    pub fn next(&mut self, cells: usize) -> Range<usize> {
        let first = self.sent;
        let rows = &self.batch.rows[first..];
        let fits = |row: &&BatchRow| row.cells().end - rows[0].first_cell <= cells;
        self.sent += rows.iter().take_while(fits).count().max(1);
        first..self.sent
    }
}
