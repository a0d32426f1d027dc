//! Command `whiskmap render`.

use super::arguments::{all_channels, completed, whole};
use super::failure::{Failure, message};
use super::files::{Files, STDOUT};
use super::outputs::PictureFile;
use super::selection::{SelectionArgs, channels};
use super::size::SizeArgs;
use super::solver::SolverArgs;
use super::source::warn;
use clap::Args;
use clap::builder::StringValueParser;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use whiskmap::input::Quantity;
use whiskmap::render::{self, MapOptions, PictureFormat, PictureSize};
use whiskmap::scene::Scene;
use whiskmap::store::{MapSlice, MapSource};
use whiskmap::terminal::StandardOutput;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap map scenes/cone.toml
  whiskmap render outputs/cone.exr
  whiskmap render outputs/cone.exr -o cone.svg
  whiskmap render outputs/cone.exr -o cone.pdf --size 85mm
  whiskmap render outputs/cone.exr --channel force_un -o force.png --width 3000
  whiskmap render outputs/cone.exr --channel force_un --log --range 1,1000
  whiskmap render outputs/cone.exr -o - | display
  whiskmap map scenes/morphology.toml --format zarr
  whiskmap render outputs/morphology.zarr --at taper=0.95 --at curvature_per_mm=0.02
  whiskmap render scenes/morphology.toml --at taper=0.95 --channel force_un
  whiskmap render - -o map.png --engine cpu < scenes/cone.toml

A picture has at most two sweep axes; give a value of each other axis with --at. A slice of one distance, or of one push angle, is \
drawn as a line chart of the channel. Of a scene, only the whiskers of the picture are computed. An SVG or PDF contains the cells as pixels, and text and lines as vectors.

The ends of --range have the unit in the channel's name, or a given unit, such as 5mm,1cm. The colour bar selects its own unit.")]
pub struct RenderArgs {
    /// Map or store written by `whiskmap map`, or a scene file (.toml), which is computed; - is a scene on standard input
    file: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Draw this channel with a colour bar [default: the regimes]
    #[arg(long, value_name = "NAME", value_parser = completed(StringValueParser::new(), all_channels()), hide_possible_values = true)]
    channel: Option<String>,
    /// Use a logarithmic scale from the 1st percentile of the values above 0; cells at or below 0 stay blank, and moments have their size [default: for loads and
    /// energies that span more than two decades]
    #[arg(long, requires = "channel")]
    log: bool,
    /// Use a linear scale
    #[arg(long, requires = "channel", conflicts_with = "log")]
    linear: bool,
    /// Ends of the colour bar; values beyond them have the colours of the ends
    #[arg(long, value_name = "A,B", requires = "channel", allow_hyphen_values = true)]
    range: Option<String>,
    /// Width of the picture in pixels, from 300 to 8000 [default: by the map, about 1500]
    #[arg(long, value_name = "PX", conflicts_with = "size", value_parser = whole(300..=8000))]
    width: Option<u32>,
    /// Draw no title
    #[arg(long)]
    no_title: bool,
    #[command(flatten)]
    size: SizeArgs,
    /// Write the picture to FILE; the ending selects PNG, SVG or PDF; - is PNG on standard output [default: beside the map, or in
    /// outputs for a scene; named by the map, --at and the channel]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Options for a scene")]
    solver: SolverArgs,
}

/// Parses two numbers that are separated by a comma, in the unit of `channel` or with a unit.
fn range(text: &str, channel: &str) -> Result<[f64; 2], Failure> {
    let refuse = |why: &str| Failure::Input(format!("--range {text}: {why}"));
    let ends = text.split_once(',');
    let (low, high) =
        ends.ok_or_else(|| refuse("must be two numbers, separated by a comma, such as 0,100"))?;
    let end = |end: &str| {
        let number = Quantity::of(channel).parse(end);
        number.map_err(|why| refuse(&format!("{end}: {why}")))
    };
    let ends = [end(low)?, end(high)?];
    if ends[0] < ends[1] {
        Ok(ends)
    } else {
        Err(refuse("must be two different numbers, the smaller one first"))
    }
}

pub fn run(args: &RenderArgs, files: &mut Files) -> Result<(), Failure> {
    let channel = args.channel.as_deref();
    let wanted = |scene: &Scene| {
        let strain = scene.has_yield_strain().then_some("peak_strain");
        let wanted = ["regime", "status", "margin_deg"].into_iter();
        wanted.chain(channel).chain(strain).collect()
    };
    let (file, solver) = (&args.file, &args.solver);
    let mut map = args.selection.open(files, file, solver, wanted)?;
    if map.grid().sweep.len() > 2 {
        map.fix_single_axes();
    }
    let missing = map.blank_missing()?;
    if let Some(name) = channel {
        channels(&map.channels(), &[name])?;
    }
    let ends = args.range.as_deref().zip(channel);
    let range = ends.map(|(text, channel)| range(text, channel)).transpose()?;
    let size = match args.width {
        Some(pixels) => PictureSize::Width(pixels),
        None => args.size.picture().map_err(Failure::Input)?,
    };
    let target = target(args, size, &map, files)?;
    let picture = render::map(
        &map,
        &MapOptions {
            channel,
            log: (args.log || args.linear).then_some(args.log),
            range,
            without_title: args.no_title,
            size,
        },
    )?;
    let path = target.output.path().to_owned();
    target.write(&picture)?;
    warn(map.source());
    if missing > 0 {
        message(&format!(
            "warning: {} is not finished: {missing} of {} panels are not computed and are drawn without values; `whiskmap status` lists \
             their blocks",
            args.file.display(),
            map.grid().whisker_count()
        ));
    }
    if !map.channels().contains(&"margin_deg") {
        message("note: no detachment line is drawn: the map has no channel margin_deg");
    }
    let has_yield_strain = map.yield_strains()?.iter().any(Option::is_some);
    if has_yield_strain && !map.channels().contains(&"peak_strain") {
        message(
            "note: no cell is hatched beyond the yield strain: the map has no channel peak_strain",
        );
    }
    if path != Path::new(STDOUT) {
        writeln!(StandardOutput::open(), "{}", path.display())?;
    }
    Ok(())
}

/// Opens the output; on standard output, a picture is PNG.
fn target(
    args: &RenderArgs,
    size: PictureSize,
    map: &MapSlice,
    files: &mut Files,
) -> Result<PictureFile, Failure> {
    let path = match &args.output {
        Some(path) => path.clone(),
        None => {
            let chosen = map.readable().map(|(name, value)| format!("{name}={value}"));
            // The name of a whisker may have separators of paths.
            let chosen = chosen.map(|part| part.replace(['/', '\\'], "-"));
            let parts = chosen.chain(args.channel.clone());
            let parts: Vec<String> = parts.chain(["png".to_owned()]).collect();
            beside(args, map, files)?.with_extension(parts.join("."))
        }
    };
    let refuse = |why: &str| {
        let path = path.display();
        Err(Failure::Input(format!("--output {path}: {why}")))
    };
    let is_stdout = path == Path::new(STDOUT);
    if is_stdout && std::io::stdout().is_terminal() {
        return refuse("standard output is a terminal; redirect it to a file or a program");
    }
    let output = files.output("--output", &path)?;
    match PictureFormat::of(&path).or(is_stdout.then_some(PictureFormat::Png)) {
        Some(format) => Ok(PictureFile { output, format, size }),
        None => refuse("must end in .png, .svg or .pdf, or be - for PNG on standard output"),
    }
}

/// Returns the path of the map beside which a picture without a name is written; of a scene, the path that `map` gives its map.
fn beside(args: &RenderArgs, map: &MapSlice, files: &Files) -> Result<PathBuf, Failure> {
    match map.source() {
        MapSource::Computed(map) => files.unnamed(&format!("{}.exr", map.scene.name)),
        _ => Ok(args.file.clone()),
    }
}
