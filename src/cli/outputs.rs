//! Where the tables and plots of a command go.

use super::failure::Failure;
use super::picture::save;
use clap::Args;
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use whiskmap::render::{Chart, Format, Plot};
use whiskmap::store::{Output, Table};

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
    pub fn open(&self) -> Result<Opened, Failure> {
        let stdout = self.plot.is_none().then(|| PathBuf::from(STDOUT));
        let csv = self.csv.clone().or(stdout);
        let (table, picture) = open("--csv", csv.as_deref(), self.plot.as_deref())?;
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

/// What names standard output.
pub const STDOUT: &str = "-";

/// `--plot`: a picture that can be made.
pub struct PlotFile {
    path: PathBuf,
    format: Format,
    is_regular: bool,
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
        save(&chart.picture(), &self.path, self.format)
    }
}

/// Opens the file of `option` and finds out whether the picture can be made; they must be two files.
pub fn open(
    option: &str,
    data: Option<&Path>,
    plot: Option<&Path>,
) -> Result<(Option<Output>, Option<PlotFile>), Failure> {
    let format = |path: &Path| {
        let must = || format!("--plot {}: must end in .png or .svg", path.display());
        Format::of(path).ok_or_else(|| Failure::Input(must()))
    };
    let format = plot.map(format).transpose()?;
    let output = data.map(|path| create(option, path)).transpose()?;
    let place = plot.map(|path| create("--plot", path)).transpose()?;
    if let (Some(data), Some(plot)) = (data, plot)
        && output == place
        && output.as_ref().is_some_and(Output::is_regular)
    {
        return Err(one_file((option, data), ("--plot", plot)));
    }
    let picture = plot.zip(format).zip(place);
    let picture = picture.map(|((path, format), place)| PlotFile {
        path: path.to_owned(),
        format,
        is_regular: place.is_regular(),
    });
    Ok((output, picture))
}

/// Two options name one file.
pub fn one_file((option, path): (&str, &Path), (other, same): (&str, &Path)) -> Failure {
    let (path, same) = (path.display(), same.display());
    Failure::Input(format!(
        "{option} {path} and {other} {same}: must be two files"
    ))
}

/// Writes all of the file at `path`.
pub fn write(mut output: Output, path: &Path, text: &str) -> Result<(), Failure> {
    let written = output.write_all(text.as_bytes());
    let finished = written.and_then(|()| output.finish());
    finished.map_err(|cause| unwritten(path, cause))
}

/// The output that `option` names.
pub fn create(option: &str, path: &Path) -> Result<Output, Failure> {
    if path == Path::new(STDOUT) {
        return Ok(Output::stdout());
    }
    let advice = "name a file in a folder that can be written";
    Output::create(path).map_err(impossible(option, path, advice))
}

/// Makes the folder that `option` names, and finds out whether files can be made in it.
pub fn folder(option: &str, path: &Path) -> Result<(), Failure> {
    let any = path.join(".whiskmap");
    let made = std::fs::create_dir_all(path).and_then(|()| Output::create(&any));
    let advice = "give a folder that can be written";
    made.map(drop).map_err(impossible(option, path, advice))
}

fn impossible(option: &str, path: &Path, advice: &str) -> impl FnOnce(io::Error) -> Failure {
    move |error| Failure::Input(format!("{option} {}: {error}; {advice}", path.display()))
}

/// Why the file at `path` is not written.
pub fn unwritten(path: &Path, cause: io::Error) -> Failure {
    if path == Path::new(STDOUT) {
        return Failure::Output(cause);
    }
    Failure::Write {
        path: path.to_owned(),
        cause,
    }
}
