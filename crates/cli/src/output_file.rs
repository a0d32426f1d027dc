//! Open output file of a command, as a whole or as a CSV table.

use super::failure::Failure;
use super::units::ColumnUnits;
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use whiskmap::paper::TableRows;
use whiskmap::store::{Output, TableFile};

/// Path that stands for standard input or output.
pub const STDOUT: &str = "-";

/// Open output file of a command, and its path.
pub struct OutputFile {
    pub output: Output,
    pub path: PathBuf,
}

impl OutputFile {
    /// Writes `bytes` as the whole output file. Returns the path of a regular file, `None` for another output.
    pub fn write(mut self, bytes: &[u8]) -> Result<Option<PathBuf>, Failure> {
        let is_regular = self.output.is_regular();
        let written = self.output.write_all(bytes);
        written
            .and_then(|()| self.output.finish())
            .map_err(unwritten(&self.path))?;
        Ok(Some(self.path).filter(|_| is_regular))
    }

    /// Begins a CSV table in the output file.
    pub fn table(self) -> OutputTable {
        OutputTable {
            is_regular: self.output.is_regular(),
            table: TableFile::new(self.output),
            path: self.path,
            units: ColumnUnits::default(),
            has_header: false,
        }
    }
}

/// Open CSV table of a command's output.
pub struct OutputTable {
    table: TableFile,
    path: PathBuf,
    is_regular: bool,
    units: ColumnUnits,
    has_header: bool,
}

impl OutputTable {
    /// Sets the units of the table's columns.
    pub fn in_units(self, units: ColumnUnits) -> Self {
        Self { units, ..self }
    }

    /// Appends `rows` to the CSV table.
    ///
    /// # Errors
    /// The output cannot be written; the message names the file.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), Failure> {
        let written = if self.units.are_own() {
            self.table.rows(rows)
        } else {
            let lines = self.units.converted(rows);
            let skipped = usize::from(self.has_header);
            self.has_header = true;
            lines.and_then(|lines| self.table.rows(lines.iter().skip(skipped)))
        };
        written.map_err(unwritten(&self.path))
    }

    /// Appends to the CSV table the rows that `write` makes.
    pub fn write(&mut self, write: &TableRows) -> Result<(), Failure> {
        write(&mut self.table).map_err(unwritten(&self.path))
    }

    /// Returns true for a table on standard output.
    pub fn is_stdout(&self) -> bool {
        self.path == Path::new(STDOUT)
    }

    /// Finishes the CSV table. Returns the path of a regular file, `None` for another output.
    pub fn finish(self) -> Result<Option<PathBuf>, Failure> {
        self.table.finish().map_err(unwritten(&self.path))?;
        Ok(Some(self.path).filter(|_| self.is_regular))
    }
}

/// Returns a converter of errors from writing the file at `path`.
pub fn unwritten(path: &Path) -> impl FnOnce(io::Error) -> Failure {
    move |cause| {
        if path == Path::new(STDOUT) {
            return Failure::Output(cause);
        }
        let path = path.to_owned();
        Failure::Write { path, cause }
    }
}
