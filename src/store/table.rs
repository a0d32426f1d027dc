//! Tables as CSV: a header, then one line per row; numbers in the fewest digits that give them back exactly.

use super::beside;
use serde::Serialize;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A table being written: to a stream as it comes, to a file whole or not at all.
pub struct Table {
    writer: csv::Writer<Sink>,
}

enum Sink {
    Stream(Box<dyn Write>),
    File(NamedTempFile, PathBuf),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Stream(stream) => stream.write(bytes),
            Self::File(file, _) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stream(stream) => stream.flush(),
            Self::File(file, _) => file.flush(),
        }
    }
}

impl Table {
    /// A table on its way to a stream.
    #[must_use]
    pub fn stream(stream: Box<dyn Write>) -> Self {
        Self::of(Sink::Stream(stream))
    }

    /// A table that will be the file `path` once it is finished.
    ///
    /// # Errors
    /// When no file can be made there.
    pub fn create(path: &Path) -> io::Result<Self> {
        if path.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        match path.canonicalize() {
            // A device or a pipe is written to, not replaced; a link keeps pointing where it does.
            Ok(real) if !real.is_file() => {
                let device = File::options().write(true).open(real)?;
                Ok(Self::stream(Box::new(device)))
            }
            Ok(real) => Ok(Self::of(Sink::File(beside(&real, ".csv")?, real))),
            Err(_) => Ok(Self::of(Sink::File(beside(path, ".csv")?, path.to_owned()))),
        }
    }

    fn of(sink: Sink) -> Self {
        Self {
            writer: csv::Writer::from_writer(sink),
        }
    }

    /// Appends `rows`; the names of the fields of the first one are the header.
    ///
    /// # Errors
    /// When the stream or the file takes no more.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> io::Result<()> {
        rows.into_iter()
            .try_for_each(|row| self.writer.serialize(row).map_err(unwrapped))
    }

    /// Writes what is left and gives the file its name.
    ///
    /// # Errors
    /// When the stream or the file takes no more.
    pub fn finish(self) -> io::Result<()> {
        match self
            .writer
            .into_inner()
            .map_err(csv::IntoInnerError::into_error)?
        {
            Sink::Stream(mut stream) => stream.flush(),
            Sink::File(file, path) => {
                file.persist(path).map_err(|error| error.error)?;
                Ok(())
            }
        }
    }
}

/// The cause of an error, whose kind `csv` would hide.
fn unwrapped(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}
