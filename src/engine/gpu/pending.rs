//! Pending batches: a batch on the device is sent in parts, whose cells return in the same order.

use crate::engine::{Cells, Outcome, RowBatch};
use std::ops::Range;
use std::sync::Arc;

/// Pending batch, of which parts are on the device.
#[derive(Debug)]
pub struct PendingBatch {
    pub batch: Arc<RowBatch>,
    /// Cells of the pending batch; those that have not returned are [`Outcome::NoBasePoint`].
    pub cells: Cells,
    /// Number of base points of the pending batch whose cells have returned.
    pub received: usize,
    sent: BatchPart,
}

/// Part of a batch: some base points, and the starts of their steps.
#[derive(Clone, Debug)]
pub struct BatchPart {
    pub base_points: Range<usize>,
    pub starts: Range<usize>,
}

impl PendingBatch {
    pub fn new(batch: Arc<RowBatch>) -> Self {
        Self {
            cells: Cells::new(&batch, Outcome::NoBasePoint),
            batch,
            received: 0,
            sent: BatchPart {
                base_points: 0..0,
                starts: 0..0,
            },
        }
    }

    /// Returns true if a part of the pending batch is still to be sent.
    pub fn is_waiting(&self) -> bool {
        self.sent.base_points.end < self.batch.base_points.len()
    }

    /// Returns true if all cells of the pending batch have returned.
    pub fn is_done(&self) -> bool {
        self.received == self.batch.base_points.len()
    }

    /// Returns the part of the pending batch to send next: at least one base point, at most `cells` cells and about `steps` steps.
    pub fn next(&mut self, cells: usize, steps: usize) -> BatchPart {
        let [first, first_start] = [self.sent.base_points.end, self.sent.starts.end];
        let (mut count, mut cells_here, mut steps_here) = (0, 0, 0);
        for base in &self.batch.base_points[first..] {
            let cells_with_it = cells_here + base.cells.len();
            let steps_with_it = steps_here + base.trajectory.steps as usize;
            if count > 0 && (cells_with_it > cells || steps_with_it > steps) {
                break;
            }
            (count, cells_here, steps_here) = (count + 1, cells_with_it, steps_with_it);
        }
        self.sent = BatchPart {
            base_points: first..first + count,
            starts: first_start..first_start + steps_here,
        };
        self.sent.clone()
    }
}
