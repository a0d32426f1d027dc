//! What an engine is asked about some rows, and what it makes of them.

use crate::engine::{CellDifference, Question};
use std::ops::Range;
use std::sync::Arc;

/// What an engine is asked about some rows.
#[derive(Default)]
pub struct RowsAsked {
    /// About the references of all rows.
    pub question: Arc<Question>,
    /// The references of each row, and the first of their cells.
    pub rows: Vec<(Range<usize>, usize)>,
}

/// What an engine made of some rows.
#[derive(Default)]
pub struct Solved {
    /// What it was asked.
    pub asked: RowsAsked,
    /// Its answers.
    pub differences: Vec<CellDifference>,
}
