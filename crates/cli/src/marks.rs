//! Columns that mark rows beyond the yield strain of their whisker; a scene without one has none.

use super::outputs::Columns;
use serde::{Serialize, Serializer};
use whiskmap::yields::{PushMark, StrainMark, YieldMark};

/// Heading of the columns of marks in help texts.
pub const HEADING: &str = "More columns with whisker.yield_strain";

/// Columns of marks in help texts.
pub const MARKS: (&str, Columns) = (HEADING, YieldMark::COLUMNS);
pub const STRAIN_MARKS: (&str, Columns) = (HEADING, StrainMark::COLUMNS);
pub const PUSH_MARKS: (&str, Columns) = (HEADING, PushMark::COLUMNS);

/// Row of a table with its mark; `None` without a yield strain, for all rows of the table.
pub struct Marked<R, M>(pub R, pub Option<M>);

impl<R: Serialize, M: Serialize> Serialize for Marked<R, M> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.1 {
            None => self.0.serialize(serializer),
            Some(mark) => (&self.0, mark).serialize(serializer),
        }
    }
}

/// Returns the rows of a table with their `marks`, `[row]`.
pub fn marked<R, M>(rows: &[R], marks: Option<Vec<M>>) -> impl Iterator<Item = Marked<&R, M>> {
    let mut marks = marks.map(Vec::into_iter);
    rows.iter().map(move |row| {
        let mark = marks.as_mut().and_then(Iterator::next);
        Marked(row, mark)
    })
}
