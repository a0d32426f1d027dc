//! Tables as CSV: a header, then a line per row. Numbers have the fewest digits that parse to the same value.

use super::Output;
use memchr::memmem;
use serde::Serialize;
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::PathBuf;

/// CSV table that is being written. A number that does not exist is an empty cell.
#[derive(Debug)]
pub struct TableFile(csv::Writer<FiniteCells>);

impl TableFile {
    /// Creates a CSV table that is written to `output`.
    #[must_use]
    pub fn new(output: Output) -> Self {
        Self(csv::Writer::from_writer(FiniteCells { output, begun: Vec::new() }))
    }

    /// Appends `rows` to the CSV table; the names of the fields of the first one are the header.
    ///
    /// # Errors
    /// When the output takes no more.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> io::Result<()> {
        rows.into_iter().try_for_each(|row| self.0.serialize(row).map_err(unwrapped))
    }

    /// Returns the output of the CSV table.
    #[must_use]
    pub fn output(&self) -> &Output {
        &self.0.get_ref().output
    }

    /// Flushes the CSV table and finishes the output. Returns the path of a regular file, `None` for another output.
    ///
    /// # Errors
    /// When the output takes no more.
    pub fn finish(self) -> io::Result<Option<PathBuf>> {
        let cells = self.0.into_inner();
        let cells = cells.map_err(csv::IntoInnerError::into_error)?;
        cells.output.finish()
    }
}

/// Bytes of a CSV table on their way to the output. A number that is not finite becomes an empty cell, as it is `null` in JSON.
#[derive(Debug)]
struct FiniteCells {
    output: Output,
    /// Begin of the cell whose end is not yet written to this.
    begun: Vec<u8>,
}

impl Write for FiniteCells {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let last = bytes.iter().rposition(ends_cell);
        let (ended, begun) = bytes.split_at(last.map_or(0, |last| last + 1));
        if !ended.is_empty() {
            self.begun.extend_from_slice(ended);
            self.output.write_all(&finite(&self.begun))?;
            self.begun.clear();
        }
        self.begun.extend_from_slice(begun);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }
}

/// Returns true for a byte after the text of a cell.
fn ends_cell(byte: &u8) -> bool {
    b",\n".contains(byte)
}

/// Returns whole `cells` without the text of numbers that are not finite.
fn finite(cells: &[u8]) -> Cow<'_, [u8]> {
    if memmem::find(cells, b"NaN").is_none() && memmem::find(cells, b"inf").is_none() {
        return Cow::Borrowed(cells);
    }
    let each = cells.split_inclusive(ends_cell).map(|cell| {
        let (text, end) = cell.split_at(cell.len() - 1);
        let is_finite = !matches!(text, b"NaN" | b"inf" | b"-inf");
        debug_assert!(is_finite, "a row must have `None` for a number that does not exist");
        if is_finite { cell } else { end }
    });
    Cow::Owned(each.collect::<Vec<_>>().concat())
}

/// The I/O error in an error of `csv`, which hides its kind.
fn unwrapped(error: csv::Error) -> io::Error {
    let message = error.to_string();
    match error.into_kind() {
        csv::ErrorKind::Io(cause) => cause,
        _ => io::Error::other(message),
    }
}
