//! Outputs of a command: texts, CSV tables and pictures; options `--csv` and `--plot`.

use super::failure::{Failure, message};
use super::files::{Files, STDOUT, unwritten};
use super::size::SizeArgs;
use super::units::ColumnUnits;
use clap::Args;
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};
use whiskmap::render::{Chart, Picture, PictureFormat, PictureSize, Plot};
use whiskmap::store::{Output, TableFile};
use whiskmap::terminal::StandardOutput;

/// Writes `bytes` as the whole output. Returns the path of a regular file, `None` for another output.
pub fn write(mut output: Output, bytes: &[u8]) -> Result<Option<PathBuf>, Failure> {
    let path = output.path().to_owned();
    let written = output.write_all(bytes).and_then(|()| output.finish());
    written.map_err(unwritten(&path))
}

/// Names and meanings of the columns of a table.
pub type Columns = &'static [(&'static str, &'static str)];

/// Open CSV table of a command's output.
pub struct OutputTable {
    table: TableFile,
    units: ColumnUnits,
    has_header: bool,
}

impl OutputTable {
    /// Begins a CSV table in the output.
    pub fn new(output: Output) -> Self {
        Self { table: TableFile::new(output), units: ColumnUnits::default(), has_header: false }
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

    /// Writes the header of a CSV table with these `columns`, which has no rows.
    fn header(&mut self, columns: Columns) -> Result<(), Failure> {
        let names: Vec<String> = columns.iter().map(|(name, _)| self.units.named(name)).collect();
        self.table.rows([names]).map_err(unwritten(self.table.output().path()))
    }

    /// Finishes the CSV table. Returns the path of a regular file, `None` for another output.
    pub fn finish(self) -> Result<Option<PathBuf>, Failure> {
        let path = self.table.output().path().to_owned();
        self.table.finish().map_err(unwritten(&path))
    }
}

/// Writes the rows of a whole CSV table with these `columns`, if there is one; without rows, the header alone. Returns the path of a regular file.
pub fn write_table<R: Serialize>(
    table: Option<OutputTable>,
    columns: Columns,
    rows: impl IntoIterator<Item = R>,
) -> Result<Option<PathBuf>, Failure> {
    let Some(mut table) = table else {
        return Ok(None);
    };
    let mut rows = rows.into_iter().peekable();
    if rows.peek().is_none() {
        table.header(columns)?;
    }
    table.rows(rows)?;
    table.finish()
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
    pub picture: PlotArgs,
}

#[derive(Debug, Args)]
pub struct PlotArgs {
    /// Write a picture to FILE; the ending selects PNG, SVG or PDF
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    #[command(flatten)]
    size: SizeArgs,
}

/// Open CSV table and plot of a command.
pub struct OpenOutputs {
    table: Option<OutputTable>,
    plot: Option<PictureFile>,
}

impl PlotArgs {
    /// Opens the picture, whose ending selects its format; `None` without one.
    pub fn open(&self, files: &mut Files) -> Result<Option<PictureFile>, Failure> {
        let size = self.size.picture().map_err(Failure::Input)?;
        let Some(path) = &self.plot else {
            return match size {
                PictureSize::Natural => Ok(None),
                _ => Err(Failure::Input("--size: needs --plot".to_owned())),
            };
        };
        let must = || format!("--plot {}: must end in .png, .svg or .pdf", path.display());
        let format = PictureFormat::of(path).ok_or_else(|| Failure::Input(must()))?;
        let output = files.output("--plot", path)?;
        Ok(Some(PictureFile { output, format, size }))
    }
}

impl OutputArgs {
    /// Opens the CSV table and the plot, before any work.
    pub fn open(&self, files: &mut Files) -> Result<OpenOutputs, Failure> {
        let stdout = self.picture.plot.is_none().then(|| Path::new(STDOUT));
        Ok(OpenOutputs {
            table: self.table(files, "--csv", self.csv.as_deref().or(stdout))?,
            plot: self.picture.open(files)?,
        })
    }

    /// Opens the CSV table of the command-line option `option`; `None` without a path.
    pub fn table(
        &self,
        files: &mut Files,
        option: &str,
        path: Option<&Path>,
    ) -> Result<Option<OutputTable>, Failure> {
        let units = ColumnUnits::new(&self.units)?;
        let output = path.map(|path| files.output(option, path)).transpose()?;
        Ok(output.map(|output| OutputTable { units, ..OutputTable::new(output) }))
    }
}

impl OpenOutputs {
    /// Appends rows to the CSV table, if there is one.
    pub fn rows<R: Serialize>(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), Failure> {
        self.table.as_mut().map_or(Ok(()), |table| table.rows(rows))
    }

    /// Finishes the CSV table, draws the plot below its title, and prints the names of regular files.
    pub fn finish(self, title: String, plot: impl FnOnce() -> Plot) -> Result<(), Failure> {
        let chart = || {
            let plot = plot();
            if plot.is_empty() {
                message(
                    "warning: the picture is empty: the rows of the table have no values for it",
                );
            }
            Chart::single(title, plot)
        };
        self.finish_chart(chart, [])
    }

    /// Finishes the CSV table, draws the chart, and prints the names of regular files, those of `tables` too.
    pub fn finish_chart(
        self,
        chart: impl FnOnce() -> Chart,
        tables: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(), Failure> {
        self.finish_picture(|size| Ok(chart().picture(size)?), tables)
    }

    /// Finishes the CSV table, draws a picture of the size of the plot, and prints the names of regular files, those of `tables` too. A table
    /// on standard output stays alone there.
    pub fn finish_picture(
        self,
        picture: impl FnOnce(PictureSize) -> Result<Picture, Failure>,
        tables: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(), Failure> {
        let output = self.table.as_ref().map(|table| table.table.output());
        let is_alone = output.is_some_and(Output::is_stdout);
        let table = self.table.map(OutputTable::finish).transpose()?;
        let draw = |file: PictureFile| picture(file.size).and_then(|picture| file.write(&picture));
        let plot = self.plot.map(draw).transpose()?;
        if is_alone {
            return Ok(());
        }
        let mut out = StandardOutput::open();
        for path in [table, plot].into_iter().flatten().flatten().chain(tables) {
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
    /// Draws a chart into the file. Returns the path of a regular file, `None` for another output.
    pub fn chart(self, chart: &Chart) -> Result<Option<PathBuf>, Failure> {
        let picture = chart.picture(self.size)?;
        self.write(&picture)
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
