//! Outputs of a command: texts, CSV tables and pictures; options `--csv` and `--plot`.

use super::failure::{Failure, message};
use super::files::{Files, STDOUT, unwritten};
use super::size::SizeArgs;
use super::units::ColumnUnits;
use clap::Args;
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};
use whiskmap::paper::TableRows;
use whiskmap::render::{Chart, Picture, PictureFormat, PictureSize, Plot};
use whiskmap::store::{Output, TableFile};
use whiskmap::terminal::StandardOutput;

/// Writes `bytes` as the whole output. Returns the path of a regular file, `None` for another output.
pub fn write(mut output: Output, bytes: &[u8]) -> Result<Option<PathBuf>, Failure> {
    let (path, file) = (output.path().to_owned(), regular(&output));
    let written = output.write_all(bytes).and_then(|()| output.finish());
    written.map_err(unwritten(&path))?;
    Ok(file)
}

/// Returns the path of a regular file; `None` for another output.
fn regular(output: &Output) -> Option<PathBuf> {
    output.target().map(|_| output.path().to_owned())
}

/// Open CSV table of a command's output.
pub struct OutputTable {
    table: TableFile,
    units: ColumnUnits,
    has_header: bool,
}

impl OutputTable {
    /// Begins a CSV table in the output.
    pub fn new(output: Output) -> Self {
        Self {
            table: TableFile::new(output),
            units: ColumnUnits::default(),
            has_header: false,
        }
    }

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
        written.map_err(unwritten(self.table.output().path()))
    }

    /// Appends to the CSV table the rows that `write` makes.
    pub fn write(&mut self, write: &TableRows) -> Result<(), Failure> {
        let written = write(&mut self.table);
        written.map_err(unwritten(self.table.output().path()))
    }

    /// Returns true for a table on standard output.
    pub fn is_stdout(&self) -> bool {
        self.table.output().is_stdout()
    }

    /// Finishes the CSV table. Returns the path of a regular file, `None` for another output.
    pub fn finish(self) -> Result<Option<PathBuf>, Failure> {
        let output = self.table.output();
        let (path, file) = (output.path().to_owned(), regular(output));
        self.table.finish().map_err(unwritten(&path))?;
        Ok(file)
    }
}

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

impl PlotArgs {
    pub const fn is_given(&self) -> bool {
        self.plot.is_some()
    }
}

impl OutputArgs {
    pub const fn has_plot(&self) -> bool {
        self.picture.is_given()
    }

    /// Opens the CSV table and the plot, before any work.
    pub fn open(&self, files: &mut Files) -> Result<OpenOutputs, Failure> {
        let units = ColumnUnits::new(&self.units)?;
        let stdout = (!self.has_plot()).then(|| Path::new(STDOUT));
        let csv = self.csv.as_deref().or(stdout);
        let (table, plot) = open(files, "--csv", csv, &self.picture)?;
        let table = table.map(|output| OutputTable::new(output).in_units(units));
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
        let output = files.output(option, path)?;
        Ok(OutputTable::new(output).in_units(units))
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
        self.finish_files(|file| file.chart(&chart()), tables)
    }

    /// Finishes the CSV table, draws a picture of the size of the plot, and prints the names of regular files.
    pub fn finish_picture(
        self,
        picture: impl FnOnce(PictureSize) -> Result<Picture, Failure>,
    ) -> Result<(), Failure> {
        let draw = |file: PictureFile| {
            let picture = picture(file.size)?;
            file.write(&picture)
        };
        self.finish_files(draw, [])
    }

    fn finish_files(
        self,
        draw: impl FnOnce(PictureFile) -> Result<Option<PathBuf>, Failure>,
        tables: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(), Failure> {
        let is_alone = self.table.as_ref().is_some_and(OutputTable::is_stdout);
        let table = self.table.map(OutputTable::finish).transpose()?;
        let plot = self.plot.map(draw).transpose()?;
        if is_alone {
            return Ok(());
        }
        let mut out = StandardOutput::open();
        let paths = [table, plot].into_iter().flatten().flatten();
        for path in paths.chain(tables) {
            writeln!(out, "{}", path.display())?;
        }
        Ok(())
    }
}

/// Open output file for a picture.
pub struct PictureFile {
    pub output: Output,
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
        write(self.output, &picture.encode(self.format)?)
    }
}

/// Opens the CSV table of `option`, and the picture of `--plot`, whose ending selects its format; `None` without one.
pub fn open(
    files: &mut Files,
    option: &str,
    data: Option<&Path>,
    PlotArgs { plot, size }: &PlotArgs,
) -> Result<(Option<Output>, Option<PictureFile>), Failure> {
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
    let data = data.map(|path| files.output(option, path)).transpose()?;
    let picture = plot.map(|path| files.output("--plot", path)).transpose()?;
    let picture = picture.zip(format).map(|(output, format)| PictureFile {
        output,
        format,
        size,
    });
    Ok((data, picture))
}
