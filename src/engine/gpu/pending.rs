//! Pending batches: a batch on the device is sent in parts, whose cells return in the same order.

use crate::classify::Outcome;
use crate::engine::{BatchRow, Cells, RowBatch};
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
    pub fn new(batch: Arc<RowBatch>) -> Self {
        let mut cells = Cells::new(&batch, Outcome::NoRow);
        for (row, expansion) in batch.rows.iter().zip(&batch.expansions) {
            if let Some(expansion) = expansion {
                let outcomes = &mut cells.outcome[row.cells()];
                expansion.write_beyond(row, &batch.sides[row.side].columns.pushes, outcomes);
            }
        }
        Self {
            cells,
            batch,
            in_flight: 0,
            sent: 0,
        }
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
