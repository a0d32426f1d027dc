//! Tables as CSV: a header, then a line per row. Numbers have the fewest digits that parse to the same value.

use super::Output;
use serde::Serialize;
use std::io;

/// CSV table that is being written.
#[derive(Debug)]
pub struct TableFile(csv::Writer<Output>);

impl TableFile {
    /// Creates a CSV table that is written to `output`.
    #[must_use]
    pub fn new(output: Output) -> Self {
        Self(csv::Writer::from_writer(output))
    }

    /// Appends `rows` to the CSV table; the names of the fields of the first one are the header.
    ///
    /// # Errors
    /// When the output takes no more.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> io::Result<()> {
        rows.into_iter()
            .try_for_each(|row| self.0.serialize(row).map_err(unwrapped))
    }

    /// Flushes the CSV table and finishes the output.
    ///
    /// # Errors
    /// When the output takes no more.
    pub fn finish(self) -> io::Result<()> {
        let output = self.0.into_inner();
        output.map_err(csv::IntoInnerError::into_error)?.finish()
    }
}

/// The I/O error in an error of `csv`, which hides its kind.
fn unwrapped(error: csv::Error) -> io::Error {
    let message = error.to_string();
    match error.into_kind() {
        csv::ErrorKind::Io(cause) => cause,
        _ => io::Error::other(message),
    }
}
