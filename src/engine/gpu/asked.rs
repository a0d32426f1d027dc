//! A question under way: it is sent in parts, and answered in their order.

use crate::engine::{CellDifference, Question};
use std::ops::Range;
use std::sync::Arc;

/// A question under way.
#[derive(Debug)]
pub struct Asked {
    pub question: Arc<Question>,
    /// The answers up to now.
    pub cells: Vec<CellDifference>,
    /// How many there will be.
    count: usize,
    /// The references, and the starts of their steps, that have been sent.
    sent: Part,
}

/// Some references of a question, and the starts of their steps.
#[derive(Clone, Debug)]
pub struct Part {
    pub references: Range<usize>,
    pub starts: Range<usize>,
}

impl Asked {
    pub fn new(question: Arc<Question>) -> Self {
        let count = question.cells();
        Self {
            question,
            cells: Vec::with_capacity(count),
            count,
            sent: Part {
                references: 0..0,
                starts: 0..0,
            },
        }
    }

    /// Whether there is something left to send.
    pub fn is_waiting(&self) -> bool {
        self.sent.references.end < self.question.references.len()
    }

    /// Whether all answers are there.
    pub const fn is_answered(&self) -> bool {
        self.cells.len() >= self.count
    }

    /// What is sent next: at least one reference, together at most so many `cells` and about so many `steps`.
    pub fn next(&mut self, cells: usize, steps: usize) -> Part {
        let [first, first_start] = [self.sent.references.end, self.sent.starts.end];
        let Question {
            references,
            trajectories,
            ..
        } = &*self.question;
        let (mut count, mut cells_here, mut steps_here) = (0, 0, 0);
        for (reference, trajectory) in references.iter().zip(trajectories).skip(first) {
            let cells_with_it = cells_here + reference.cells.len();
            let steps_with_it = steps_here + trajectory.steps as usize;
            if count > 0 && (cells_with_it > cells || steps_with_it > steps) {
                break;
            }
            (count, cells_here, steps_here) = (count + 1, cells_with_it, steps_with_it);
        }
        self.sent = Part {
            references: first..first + count,
            starts: first_start..first_start + steps_here,
        };
        self.sent.clone()
    }
}
