//! Command `whiskmap reproduce`.

use super::data::{self, ColumnArgs};
use super::failure::Failure;
use super::files::{Files, unwritten};
use super::outputs::PictureFile;
use super::size::SizeArgs;
use clap::{ArgGroup, Args};
use std::io::Write;
use std::path::{Path, PathBuf};
use whiskmap::measured::{MeasuredAngle, MeasuredPoint};
use whiskmap::paper::{self, FIG4_WHISKER, FIG5_LEFT, FIG5_RIGHT, Measurements, POLE};
use whiskmap::render::PictureFormat;
use whiskmap::scene::Whisker;
use whiskmap::store::TableFile;
use whiskmap::terminal::StandardOutput;

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("table").multiple(true)), after_help = "\
Examples:
  whiskmap reproduce
  whiskmap reproduce /tmp/figures --size 180mm
  whiskmap reproduce --fig5c-right scenes/cone_points.csv

Writes fig1, fig2, fig3, fig4b, fig4d, fig5b, fig5c, fig6 and fig7b as PNG, SVG and PDF, and a CSV for each panel. Solid lines are stable states or \
whiskers, dashed lines unstable states or cylinders. Slip-off is black and pull-off is blue, as in the paper. The push angle \
is the rotation of the base since first touch.")]
pub struct ReproduceArgs {
    /// Folder for the files; created if it does not exist
    #[arg(value_name = "DIR", default_value = "outputs")]
    folder: PathBuf,
    /// Add measured detachments to Fig. 4D, in the format of curve --data: slip-offs as open circles, pull-offs as filled ones
    #[arg(long, value_name = "FILE", group = "table")]
    fig4d: Option<PathBuf>,
    /// Add measured detachments to the left panel of Fig. 5C
    #[arg(long, value_name = "FILE", group = "table")]
    fig5c_left: Option<PathBuf>,
    /// Add measured detachments to the right panel of Fig. 5C
    #[arg(long, value_name = "FILE", group = "table")]
    fig5c_right: Option<PathBuf>,
    #[command(flatten)]
    columns: ColumnArgs,
    #[command(flatten)]
    size: SizeArgs,
}

impl ReproduceArgs {
    fn measurements(&self, files: &mut Files) -> Result<Measurements, Failure> {
        let mut read = |option, path: &Option<_>, whisker| {
            let table = path.as_deref().map(|path| (path, &self.columns));
            points(files, option, table, whisker)
        };
        Ok(Measurements {
            fig4d: read("--fig4d", &self.fig4d, &FIG4_WHISKER)?,
            fig5c_left: read("--fig5c-left", &self.fig5c_left, &FIG5_LEFT)?,
            fig5c_right: read("--fig5c-right", &self.fig5c_right, &FIG5_RIGHT)?,
        })
    }
}

/// Reads the points of a file with own names of columns, if there is one. All must be push angles within reach of the resting `whisker`, the longest of its
/// panel.
fn points(
    files: &mut Files,
    option: &str,
    table: Option<(&Path, &ColumnArgs)>,
    whisker: &Whisker,
) -> Result<Vec<MeasuredPoint>, Failure> {
    let Some((path, columns)) = table else {
        return Ok(Vec::new());
    };
    files.inputs(option, [path])?;
    let points = data::read(path, columns)?;
    if !points.whiskers.is_empty() {
        let path = path.display();
        let must = "has a column whisker; the points of a figure belong to one whisker";
        return Err(Failure::Input(format!("{option} {path}: {must}")));
    }
    let reach = points.check_reach(whisker, &POLE);
    reach.map_err(|why| Failure::Input(format!("{option} {why}")))?;
    match points.angle {
        MeasuredAngle::Push => Ok(points.points),
        MeasuredAngle::Chord => Err(Failure::Input(format!(
            "{option} {}: has push_chord_deg; must have push_angle_deg, which the figure shows",
            path.display()
        ))),
    }
}

pub fn run(args: &ReproduceArgs, files: &mut Files) -> Result<(), Failure> {
    let size = args.size.picture().map_err(Failure::Input)?;
    let measured = args.measurements(files)?;
    let folder = &args.folder;
    files.folder("DIR", folder)?;
    let figures = paper::figures(&measured).map_err(Failure::Figure)?;
    let mut open =
        |name: &str, ending| files.output("DIR", &folder.join(name).with_extension(ending));
    let mut opened = Vec::new();
    for figure in figures {
        let tables = figure.tables.iter().map(|(name, _)| open(name, "csv"));
        let tables = tables.collect::<Result<Vec<_>, _>>()?;
        let mut picture = |ending, format| {
            let output = open(figure.name, ending)?;
            Ok::<_, Failure>(PictureFile { output, format, size })
        };
        let pictures = [
            picture("png", PictureFormat::Png)?,
            picture("svg", PictureFormat::Svg)?,
            picture("pdf", PictureFormat::Pdf)?,
        ];
        opened.push((figure, tables, pictures));
    }
    let mut out = StandardOutput::open();
    for (figure, tables, pictures) in opened {
        for picture in pictures {
            let path = picture.output.path().to_owned();
            picture.chart(&figure.chart)?;
            writeln!(out, "{}", path.display())?;
        }
        for ((_, rows), output) in figure.tables.iter().zip(tables) {
            let path = output.path().to_owned();
            let mut table = TableFile::new(output);
            let written = rows(&mut table).and_then(|()| table.finish());
            written.map_err(unwritten(&path))?;
            writeln!(out, "{}", path.display())?;
        }
    }
    Ok(())
}
