//! `--csv` and `--plot`, and saving of pictures.

use super::failure::{Failure, message};
use super::files::{Files, STDOUT, unwritten};
use clap::Args;
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use whiskmap::render::{Chart, Picture, PictureFormat, Plot};
use whiskmap::store::{Output, TableFile, TemporaryFiles};

#[derive(Debug, Args)]
pub struct OutputArgs {
    /// Write the table to FILE; - is standard output [default: - without --plot]
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write a picture to FILE; the ending selects PNG or SVG
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

/// Open table and plot of a run.
pub struct OpenOutputs {
    table: Option<(TableFile, PathBuf)>,
    is_regular: bool,
    plot: Option<PlotFile>,
}

impl OutputArgs {
    pub fn has_plot(&self) -> bool {
        self.plot.is_some()
    }

    /// Opens the table and checks the plot, before any work.
    pub fn open(&self, files: &mut Files) -> Result<OpenOutputs, Failure> {
        let stdout = self.plot.is_none().then(|| PathBuf::from(STDOUT));
        let csv = self.csv.clone().or(stdout);
        let (table, plot) = open(files, "--csv", csv.as_deref(), self.plot.as_deref())?;
        Ok(OpenOutputs {
            is_regular: table.as_ref().is_some_and(Output::is_regular),
            table: table.map(TableFile::new).zip(csv),
            plot,
        })
    }
}

impl OpenOutputs {
    /// Appends rows to the table, if there is one.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), Failure> {
        self.table.as_mut().map_or(Ok(()), |(table, path)| {
            table.rows(rows).map_err(unwritten(path))
        })
    }

    /// Finishes the table, draws the plot below its title, and prints the names of regular files.
    pub fn finish(self, title: String, plot: impl FnOnce() -> Plot) -> Result<(), Failure> {
        let mut regular = Vec::new();
        if let Some((table, path)) = self.table {
            table.finish().map_err(unwritten(&path))?;
            regular.extend(Some(path).filter(|_| self.is_regular));
        }
        if let Some(file) = self.plot {
            file.save(title, plot())?;
            regular.extend(Some(file.path).filter(|_| file.is_regular));
        }
        let mut out = io::stdout().lock();
        let mut names = regular.iter();
        Ok(names.try_for_each(|path| writeln!(out, "{}", path.display()))?)
    }
}

/// File of `--plot`, which can be written.
pub struct PlotFile {
    path: PathBuf,
    format: PictureFormat,
    is_regular: bool,
    temporary: TemporaryFiles,
}

impl PlotFile {
    /// Draws and writes one plot below its title.
    pub fn save(&self, title: String, plot: Plot) -> Result<(), Failure> {
        let chart = Chart::single(title, plot);
        save(&chart.picture(), &self.path, self.format, &self.temporary)
    }
}

/// Opens the file of `option`, and checks that the plot can be written.
pub fn open(
    files: &mut Files,
    option: &str,
    data: Option<&Path>,
    plot: Option<&Path>,
) -> Result<(Option<Output>, Option<PlotFile>), Failure> {
    let format = |path: &Path| {
        let must = || format!("--plot {}: must end in .png or .svg", path.display());
        PictureFormat::of(path).ok_or_else(|| Failure::Input(must()))
    };
    let format = plot.map(format).transpose()?;
    let output = data.map(|path| files.output(option, path)).transpose()?;
    let target = plot.map(|path| files.output("--plot", path)).transpose()?;
    let plot = plot.zip(format).zip(target);
    let plot = plot.map(|((path, format), target)| PlotFile {
        path: path.to_owned(),
        format,
        is_regular: target.is_regular(),
        temporary: files.temporary().clone(),
    });
    Ok((output, plot))
}

/// Saves a picture; warns if a PNG lacks characters.
pub fn save(
    picture: &Picture,
    path: &Path,
    format: PictureFormat,
    temporary: &TemporaryFiles,
) -> Result<(), Failure> {
    if format == PictureFormat::Png {
        warn_of_boxes(picture);
    }
    let bytes = picture.encode(format)?;
    let output = Output::create(path, temporary);
    let written = output.and_then(|mut output| {
        output.write_all(&bytes)?;
        output.finish()
    });
    written.map_err(unwritten(path))
}

/// Prints the characters of a picture that a PNG shows as boxes.
pub fn warn_of_boxes(picture: &Picture) {
    let missing: String = picture.missing_glyphs().into_iter().collect();
    if !missing.is_empty() {
        message(&format!(
            "warning: the built-in font lacks \u{201c}{missing}\u{201d}: the PNG shows boxes; an SVG has the text itself"
        ));
    }
}
