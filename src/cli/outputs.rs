//! Where the tables and plots of a command go.

use super::failure::Failure;
use super::files::{Files, STDOUT, unwritten};
use super::picture::save;
use clap::Args;
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use whiskmap::render::{Chart, Format, Plot};
use whiskmap::store::{Output, Table, TemporaryFiles};

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
    table: Option<(Table, PathBuf)>,
    picture: Option<PlotFile>,
    /// Regular files, to be named when they are there.
    files: Vec<PathBuf>,
}

impl Outputs {
    /// Whether a picture is wanted.
    pub fn has_plot(&self) -> bool {
        self.plot.is_some()
    }

    /// Opens the table, and finds out whether the picture can be made.
    pub fn open(&self, files: &mut Files) -> Result<Opened, Failure> {
        let stdout = self.plot.is_none().then(|| PathBuf::from(STDOUT));
        let csv = self.csv.clone().or(stdout);
        let (table, picture) = open(files, "--csv", csv.as_deref(), self.plot.as_deref())?;
        let is_regular = table.as_ref().is_some_and(Output::is_regular);
        let files = [
            csv.clone().filter(|_| is_regular),
            picture
                .as_ref()
                .filter(|own| own.is_regular)
                .map(|own| own.path.clone()),
        ];
        Ok(Opened {
            table: table.map(Table::new).zip(csv),
            picture,
            files: files.into_iter().flatten().collect(),
        })
    }
}

impl Opened {
    /// Appends rows to the table, if there is one.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), Failure> {
        self.table.as_mut().map_or(Ok(()), |(table, path)| {
            table.rows(rows).map_err(|cause| unwritten(path, cause))
        })
    }

    /// Finishes the table, draws the plot below its title, and names the files.
    pub fn finish(self, title: String, plot: impl FnOnce() -> Plot) -> Result<(), Failure> {
        if let Some((table, path)) = self.table {
            table.finish().map_err(|cause| unwritten(&path, cause))?;
        }
        if let Some(picture) = self.picture {
            picture.save(title, plot())?;
        }
        let mut out = io::stdout().lock();
        for file in self.files {
            writeln!(out, "{}", file.display())?;
        }
        Ok(())
    }
}

/// `--plot`: a picture that can be made.
pub struct PlotFile {
    path: PathBuf,
    format: Format,
    is_regular: bool,
    temporary: TemporaryFiles,
}

impl PlotFile {
    /// Draws and writes it: one plot below its title.
    pub fn save(&self, title: String, plot: Plot) -> Result<(), Failure> {
        let chart = Chart {
            title,
            plots: vec![plot],
            columns: 1,
            ..Chart::default()
        };
        save(&chart.picture(), &self.path, self.format, &self.temporary)
    }
}

/// Opens the file of `option` and finds out whether the picture can be made.
pub fn open(
    files: &mut Files,
    option: &str,
    data: Option<&Path>,
    plot: Option<&Path>,
) -> Result<(Option<Output>, Option<PlotFile>), Failure> {
    let format = |path: &Path| {
        let must = || format!("--plot {}: must end in .png or .svg", path.display());
        Format::of(path).ok_or_else(|| Failure::Input(must()))
    };
    let format = plot.map(format).transpose()?;
    let output = data.map(|path| files.output(option, path)).transpose()?;
    let place = plot.map(|path| files.output("--plot", path)).transpose()?;
    let picture = plot.zip(format).zip(place);
    let picture = picture.map(|((path, format), place)| PlotFile {
        path: path.to_owned(),
        format,
        is_regular: place.is_regular(),
        temporary: files.temporary().clone(),
    });
    Ok((output, picture))
}
