//! Where the tables and plots of a command go.

use super::failure::Failure;
use crate::render::{Chart, ChartFormat};
use crate::store::Table;
use clap::Args;
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
    /// The table.
    pub table: Option<Table>,
    /// The picture.
    pub plot: Option<(PathBuf, ChartFormat)>,
    /// Files to be named when they are done.
    files: Vec<PathBuf>,
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
            && csv == plot
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
        let files = [csv.filter(|csv| *csv != stdout), self.plot.as_deref()];
        Ok(Opened {
            table: table.transpose()?,
            files: files.into_iter().flatten().map(Path::to_owned).collect(),
            plot,
        })
    }
}

impl Opened {
    /// Finishes the table, draws the picture, and names the files unless standard output is taken by the table.
    pub fn finish(self, chart: Option<&Chart>) -> Result<(), Failure> {
        if let Some(table) = self.table {
            table.finish()?;
        }
        if let (Some((path, format)), Some(chart)) = (&self.plot, chart) {
            chart.save(path, *format)?;
        }
        let mut out = io::stdout().lock();
        for file in &self.files {
            writeln!(out, "{}", file.display())?;
        }
        Ok(())
    }
}

/// The picture's file and format; its folder must be there.
fn picture(path: &Path) -> Result<(PathBuf, ChartFormat), Failure> {
    let Some(format) = ChartFormat::of(path) else {
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

fn refused(option: &str, path: &Path, error: &io::Error) -> Failure {
    let path = path.display();
    Failure::Input(format!(
        "{option} {path}: {error}; name a file in a folder that can be written"
    ))
}
