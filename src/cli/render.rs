//! `whiskmap render`.

use super::failure::Failure;
use super::files::{Files, STDOUT};
use super::numbers::whole;
use super::picture::{save, warn_of_boxes};
use super::selection::{Selection, channels, with_marks};
use clap::Args;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use whiskmap::input::Quantity;
use whiskmap::render::{self, Format, MapOptions};
use whiskmap::store::Slice;

/// Options of `render`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap render outputs/cone.exr
  whiskmap render outputs/cone.exr -o cone.svg
  whiskmap render outputs/cone.exr --channel force_un -o force.png --width 3000
  whiskmap render outputs/cone.exr --channel force_un --log --range 1,1000
  whiskmap render outputs/cone.exr -o - | display
  whiskmap render outputs/sweep.zarr --at pole_radius_mm=0.25 --at friction=0.2

A picture has at most two sweep axes: choose a value of each other one by --at. An SVG has the cells as pixels, and text \
and lines as such.

The ends of --range are in the unit that the channel's name ends in, or lengths and angles with a unit, such as 5mm,1cm; \
the colour bar shows them in the unit that suits them.")]
pub struct Options {
    /// Map or store written by `whiskmap map`
    file: PathBuf,
    #[command(flatten)]
    selection: Selection,
    /// Channel to draw with a colour bar; without it the regimes are drawn
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// Logarithmic colour scale from the 1st percentile of the values above 0; cells at or below 0 stay blank
    #[arg(long, requires = "channel")]
    log: bool,
    /// Ends of the colour bar; values beyond them take the colours of the ends
    #[arg(
        long,
        value_name = "A,B",
        requires = "channel",
        allow_hyphen_values = true
    )]
    range: Option<String>,
    /// Width of the picture in pixels, from 300 to 8000 [default: by the map, about 1500]
    #[arg(long, value_name = "PX", value_parser = whole(300..=8000))]
    width: Option<u32>,
    /// Picture to write, PNG or SVG by its ending; - is PNG on standard output [default: beside the map, by its
    /// name, those of --at and the channel's]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Two numbers with a comma between them, with the unit of the channel or another one.
fn range(text: &str, channel: &str) -> Result<[f64; 2], Failure> {
    let refuse = |why: &str| Failure::Input(format!("--range {text}: {why}"));
    let ends = text.split_once(',');
    let (low, high) =
        ends.ok_or_else(|| refuse("must be two numbers with a comma between them, such as 0,100"))?;
    let end = |end: &str| {
        let number = Quantity::of(channel).parse(end);
        number.map_err(|why| refuse(&format!("{end}: {why}")))
    };
    Ok([end(low)?, end(high)?])
}

/// Runs `render`.
pub fn run(options: &Options, files: &mut Files) -> Result<(), Failure> {
    let map = options.selection.open(files, &options.file)?;
    let channel = options.channel.as_deref();
    if let Some(name) = &options.channel {
        let drawn = channels(&map, std::slice::from_ref(name))?;
        with_marks(&options.file, &map, &drawn)?;
    }
    let ends = options.range.as_deref().zip(channel);
    let range = ends
        .map(|(text, channel)| range(text, channel))
        .transpose()?;
    let target = target(options, &map, files)?;
    let picture = render::map(
        &map,
        &MapOptions {
            channel,
            log: options.log,
            range,
            width: options.width,
        },
    )?;
    let mut out = std::io::stdout().lock();
    if let Some((path, format)) = target {
        save(&picture, &path, format, files.temporary())?;
        writeln!(out, "{}", path.display())?;
    } else {
        warn_of_boxes(&picture);
        out.write_all(&picture.encode(Format::Png)?)?;
        out.flush()?;
    }
    Ok(())
}

/// The file to write and its format, found to be possible; `None` is standard output.
fn target(
    options: &Options,
    map: &Slice,
    files: &mut Files,
) -> Result<Option<(PathBuf, Format)>, Failure> {
    let path = options.output.clone().unwrap_or_else(|| {
        let chosen = map.readable();
        let chosen = chosen.map(|(name, value)| format!("{name}={value}"));
        let parts = chosen.chain(options.channel.clone());
        let parts: Vec<String> = parts.chain(["png".to_owned()]).collect();
        options.file.with_extension(parts.join("."))
    });
    let refuse = |why: &str| {
        let path = path.display();
        Err(Failure::Input(format!("--output {path}: {why}")))
    };
    if path == Path::new(STDOUT) {
        return if std::io::stdout().is_terminal() {
            refuse("standard output is a terminal; send it to a file or a program")
        } else {
            Ok(None)
        };
    }
    files.output("--output", &path)?;
    match Format::of(&path) {
        Some(format) => Ok(Some((path, format))),
        None => refuse("must end in .png or .svg, or be - for PNG on standard output"),
    }
}
