//! Tables as CSV: a header, then a line per row. Numbers have the fewest digits that parse to the same value.

use super::Output;
use serde::Serialize;
use std::io::{self, Write};
use std::path::PathBuf;

/// CSV table that is being written. A number that does not exist is an empty cell.
#[derive(Debug)]
pub struct TableFile(csv::Writer<FiniteCells>);

impl TableFile {
    /// Creates a CSV table that is written to `output`.
    #[must_use]
    pub fn new(output: Output) -> Self {
        Self(csv::Writer::from_writer(FiniteCells {
            output,
            cell: Vec::new(),
        }))
    }

    /// Appends `rows` to the CSV table; the names of the fields of the first one are the header.
    ///
    /// # Errors
    /// When the output takes no more.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> io::Result<()> {
        rows.into_iter()
            .try_for_each(|row| self.0.serialize(row).map_err(unwrapped))
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
    /// Cell whose end is not yet written to this.
    cell: Vec<u8>,
}

impl Write for FiniteCells {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut complete = Vec::with_capacity(self.cell.len() + bytes.len());
        for part in bytes.split_inclusive(|byte| b",\n".contains(byte)) {
            self.cell.extend_from_slice(part);
            let Some((end @ (b',' | b'\n'), text)) = self.cell.split_last() else {
                continue;
            };
            if matches!(text, b"NaN" | b"inf" | b"-inf") {
                debug_assert!(
                    false,
                    "a row must have `None` for a number that does not exist"
                );
                complete.push(*end);
            } else {
                complete.extend_from_slice(&self.cell);
            }
            self.cell.clear();
        }
        self.output.write_all(&complete)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
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
