//! Where the tables and plots of a command go.

use super::failure::Failure;
use super::render::save;
use crate::render::{Chart, Format};
use crate::store::Table;
use clap::Args;
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// `--csv` and `--plot`.
#[derive(Debug, Args)]
pub struct Outputs {
    /// Table to write; - is standard output [default: - unless there is a plot]
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Picture to write, PNG or SVG by its ending
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

/// The outputs of a run, found to be possible before any work.
pub struct Opened {
    table: Option<Table>,
    /// The table's file; standard output has none.
    csv: Option<PathBuf>,
    plot: Option<(PathBuf, Format)>,
}

impl Outputs {
    /// Whether a picture is wanted.
    pub fn has_plot(&self) -> bool {
        self.plot.is_some()
    }

    /// Opens the table, and finds out whether the picture can be made.
    pub fn open(&self) -> Result<Opened, Failure> {
        let plot = self.plot.as_deref().map(picture).transpose()?;
        let stdout = Path::new("-");
        let csv = match (&self.csv, &plot) {
            (Some(csv), _) => Some(csv.as_path()),
            (None, None) => Some(stdout),
            (None, Some(_)) => None,
        };
        if let (Some(csv), Some((plot, _))) = (csv, &plot)
            && same(csv, plot)
        {
            let csv = csv.display();
            return Err(Failure::Input(format!(
                "--csv {csv} and --plot {csv}: must be two files"
            )));
        }
        let table = csv.map(|csv| {
            if csv == stdout {
                return Ok(Table::stream(Box::new(io::stdout().lock())));
            }
            Table::create(csv).map_err(|error| refused("--csv", csv, &error))
        });
        Ok(Opened {
            table: table.transpose()?,
            csv: csv.filter(|csv| *csv != stdout).map(Path::to_owned),
            plot,
        })
    }
}

impl Opened {
    /// Appends rows to the table, if there is one.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), Failure> {
        let written = self.table.as_mut().map_or(Ok(()), |table| table.rows(rows));
        written.map_err(|cause| self.unwritten(cause))
    }

    /// Finishes the table, draws the picture, and names the files.
    pub fn finish(mut self, chart: impl FnOnce() -> Chart) -> Result<(), Failure> {
        let finished = self.table.take().map_or(Ok(()), Table::finish);
        finished.map_err(|cause| self.unwritten(cause))?;
        if let Some((path, format)) = &self.plot {
            save(&chart().picture(), path, *format)?;
        }
        let mut out = io::stdout().lock();
        let files = [self.csv, self.plot.map(|(path, _)| path)];
        for file in files.into_iter().flatten() {
            writeln!(out, "{}", file.display())?;
        }
        Ok(())
    }

    fn unwritten(&self, cause: io::Error) -> Failure {
        match &self.csv {
            Some(path) => Failure::Write {
                path: path.clone(),
                cause,
            },
            None => Failure::Output(cause),
        }
    }
}

/// Whether two paths name one file, there or not.
pub fn same(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| {
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new(".")).canonicalize().ok();
        (folder, path.file_name().map(ToOwned::to_owned))
    };
    place(one) == place(other)
}

/// The picture's file and format; its folder must be there.
pub fn picture(path: &Path) -> Result<(PathBuf, Format), Failure> {
    let Some(format) = Format::of(path) else {
        let path = path.display();
        return Err(Failure::Input(format!(
            "--plot {path}: must end in .png or .svg"
        )));
    };
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    if path.is_dir() {
        return Err(refused("--plot", path, &io::ErrorKind::IsADirectory.into()));
    }
    tempfile::tempfile_in(folder).map_err(|error| refused("--plot", path, &error))?;
    Ok((path.to_owned(), format))
}

/// A file that cannot be made.
pub fn refused(option: &str, path: &Path, error: &io::Error) -> Failure {
    let path = path.display();
    Failure::Input(format!(
        "{option} {path}: {error}; name a file in a folder that can be written"
    ))
}
