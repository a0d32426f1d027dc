//! Options `--csv` and `--plot`, and saving of pictures.

use super::failure::{Failure, message};
use super::files::Files;
use super::output_file::STDOUT;
use super::output_file::{OutputFile, OutputTable};
use super::size::SizeArgs;
use super::units::ColumnUnits;
use clap::Args;
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};
use whiskmap::render::{Chart, Picture, PictureFormat, PictureSize, Plot};
use whiskmap::terminal::StandardOutput;

#[derive(Debug, Args)]
pub struct OutputArgs {
    /// Write the table to FILE; - is standard output [default: - without --plot]
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Units of the table, separated by commas, such as mN,Nmm or um,rad; the names of columns end in them
    #[arg(long, value_name = "UNITS", value_delimiter = ',')]
    units: Vec<String>,
    #[command(flatten)]
    picture: PlotArgs,
}

#[derive(Debug, Args)]
pub struct PlotArgs {
    /// Write a picture to FILE; the ending selects PNG, SVG or PDF
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    size: SizeArgs,
}

/// Open CSV table and plot of a command.
pub struct OpenOutputs {
    table: Option<OutputTable>,
    plot: Option<PictureFile>,
}

impl OutputArgs {
    pub fn has_plot(&self) -> bool {
        self.picture.plot.is_some()
    }

    /// Opens the CSV table and the plot, before any work.
    pub fn open(&self, files: &mut Files) -> Result<OpenOutputs, Failure> {
        let units = ColumnUnits::new(&self.units)?;
        let stdout = (!self.has_plot()).then(|| Path::new(STDOUT));
        let csv = self.csv.as_deref().or(stdout);
        let (table, plot) = open(files, "--csv", csv, &self.picture)?;
        let table = table.map(|file| file.table().in_units(units));
        Ok(OpenOutputs { table, plot })
    }

    /// Opens another CSV table, of the command-line option `option`.
    pub fn table(
        &self,
        files: &mut Files,
        option: &str,
        path: &Path,
    ) -> Result<OutputTable, Failure> {
        let units = ColumnUnits::new(&self.units)?;
        Ok(files.output(option, path)?.table().in_units(units))
    }
}

impl OpenOutputs {
    /// Appends rows to the CSV table, if there is one.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), Failure> {
        self.table.as_mut().map_or(Ok(()), |table| table.rows(rows))
    }

    /// Finishes the CSV table, draws the plot below its title, and prints the names of regular files.
    pub fn finish(self, title: String, plot: impl FnOnce() -> Plot) -> Result<(), Failure> {
        self.finish_chart(|| Chart::single(title, plot()), [])
    }

    /// Finishes the CSV table, draws the chart, and prints the names of regular files, those of `tables` too. A table on standard output
    /// stays alone there.
    pub fn finish_chart(
        self,
        chart: impl FnOnce() -> Chart,
        tables: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(), Failure> {
        let is_alone = self.table.as_ref().is_some_and(OutputTable::is_stdout);
        let table = self.table.map(OutputTable::finish).transpose()?;
        let plot = self.plot.map(|file| file.chart(&chart())).transpose()?;
        if is_alone {
            return Ok(());
        }
        let mut out = StandardOutput::open();
        let own = [table, plot].into_iter().flatten().flatten();
        for path in own.chain(tables) {
            writeln!(out, "{}", path.display())?;
        }
        Ok(())
    }
}

/// Open output file for a picture.
pub struct PictureFile {
    pub file: OutputFile,
    pub format: PictureFormat,
    pub size: PictureSize,
}

impl PictureFile {
    /// Draws one plot below its title into the file. Returns the path of a regular file, `None` for another output.
    pub fn plot(self, title: String, plot: Plot) -> Result<Option<PathBuf>, Failure> {
        self.chart(&Chart::single(title, plot))
    }

    /// Draws a chart into the file. Returns the path of a regular file, `None` for another output.
    pub fn chart(self, chart: &Chart) -> Result<Option<PathBuf>, Failure> {
        let picture = chart.picture(self.size);
        self.write(&picture.map_err(|why| Failure::Input(format!("--size: {why}")))?)
    }

    /// Writes the picture into the file; warns if a PNG or PDF lacks characters. Returns the path of a regular file, `None` for another output.
    pub fn write(self, picture: &Picture) -> Result<Option<PathBuf>, Failure> {
        let missing: String = picture.missing_glyphs().into_iter().collect();
        if self.format != PictureFormat::Svg && !missing.is_empty() {
            message(&format!(
                "warning: the built-in font lacks \u{201c}{missing}\u{201d}: the picture shows boxes; an SVG has the text itself"
            ));
        }
        self.file.write(&picture.encode(self.format)?)
    }
}

/// Opens the CSV table of `option`, and the picture of `--plot`, whose ending selects its format; `None` without one.
pub fn open(
    files: &mut Files,
    option: &str,
    data: Option<&Path>,
    PlotArgs { plot, size }: &PlotArgs,
) -> Result<(Option<OutputFile>, Option<PictureFile>), Failure> {
    let format = |path: &Path| {
        let must = || format!("--plot {}: must end in .png, .svg or .pdf", path.display());
        PictureFormat::of(path).ok_or_else(|| Failure::Input(must()))
    };
    let plot = plot.as_deref();
    let format = plot.map(format).transpose()?;
    let size = size.picture().map_err(Failure::Input)?;
    if plot.is_none() && size != PictureSize::Natural {
        return Err(Failure::Input("--size: needs --plot".to_owned()));
    }
    let output = data.map(|path| files.output(option, path)).transpose()?;
    let picture = plot.map(|path| files.output("--plot", path)).transpose()?;
    let picture = picture.zip(format);
    let picture = picture.map(|(file, format)| PictureFile { file, format, size });
    Ok((output, picture))
}
