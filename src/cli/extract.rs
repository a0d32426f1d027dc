//! `whiskmap extract`.

use super::failure::{Failure, say};
use super::files::{Files, unwritten};
use super::selection::{Selection, channels, with_marks};
use clap::Args;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::io::{self, BufWriter, IntoInnerError, Write};
use std::path::{Path, PathBuf};
use whiskmap::classify::Status;
use whiskmap::integrate;
use whiskmap::map::{Audit, Channels, EngineCells};
use whiskmap::scene::{Scene, Setup};
use whiskmap::store::{
    Description, MapWriter, Output, Samples, Slice, Table, UnfinishedFolder, ZarrStore,
};

/// Options of `extract`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap extract outputs/sweep.zarr --at taper=0.9 --at pole_radius_mm=0.25 -o slice.csv
  whiskmap extract outputs/sweep.zarr --at friction=0.2 --channel force_un -o force.npy
  whiskmap extract outputs/sweep.zarr --at friction=0.2 -o slice.zarr
  whiskmap extract outputs/sweep.zarr -o map.exr
  whiskmap extract outputs/cone.exr --at distance_mm=15.66 --channel regime --channel force_un -o row.csv

A table has a line for each cell, with the values of all axes first; a quantity that there is not is left empty. An array \
has the axes that are left, in the order of the grid, then distance and push angle. A store keeps every axis, those of \
--at with one value. A map has at most two sweep axes.")]
pub struct Options {
    /// Map or store written by `whiskmap map`
    source: PathBuf,
    #[command(flatten)]
    selection: Selection,
    /// Channel to extract, more than one if repeated; with friction, one of a state brings status, but for an array [default: all]
    #[arg(long, value_name = "NAME")]
    channel: Vec<String>,
    /// What to write: a table, an array of one channel, a store or a map, by its ending .csv, .npy, .zarr or .exr
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Runs `extract`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let mut files = Files::default();
    let slice = options.selection.open(&mut files, &options.source)?;
    let channels = channels(&slice, &options.channel)?;
    let marked = with_marks(&options.source, &slice, &channels)?;
    let path = &options.output;
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => table(&slice, &marked, path, &mut files)?,
        Some("npy") => {
            array(&slice, &channels, path, &mut files)?;
            warn_of_marks(&slice, &channels, &marked)?;
        }
        Some("zarr") => store(&slice, &marked, path, &mut files)?,
        Some("exr") => map(&slice, &marked, path, &mut files)?,
        _ => return refuse(path, "must end in .csv, .npy, .zarr or .exr"),
    }
    writeln!(io::stdout(), "{}", path.display())?;
    Ok(())
}

fn refuse(path: &Path, why: &str) -> Result<(), Failure> {
    let path = path.display();
    Err(Failure::Input(format!("--output {path}: {why}")))
}

/// A line of a table.
struct Line<'a> {
    axes: &'a [(&'static str, f64)],
    channels: &'a [&'static str],
    samples: &'a [Samples],
    cell: usize,
}

impl Serialize for Line<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let count = self.axes.len() + self.channels.len();
        let mut columns = serializer.serialize_struct("Line", count)?;
        for (name, value) in self.axes {
            columns.serialize_field(name, value)?;
        }
        for (name, samples) in self.channels.iter().zip(self.samples) {
            match samples {
                Samples::U32(codes) => columns.serialize_field(name, &codes[self.cell])?,
                Samples::F32(values) => {
                    let value = Some(values[self.cell]).filter(|value| !value.is_nan());
                    columns.serialize_field(name, &value)?;
                }
            }
        }
        columns.end()
    }
}

fn table(
    slice: &Slice,
    channels: &[&'static str],
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    let mut table = Table::new(files.output("--output", path)?);
    let grid = slice.grid();
    for whisker in slice.whiskers() {
        let samples = channels.iter().map(|name| slice.read_panel(name, whisker));
        let samples: Vec<Samples> = samples.collect::<Result<_, _>>()?;
        let place = slice.place(whisker);
        let rows = grid.distance_mm.iter();
        let cells =
            rows.flat_map(|row| grid.push_angle_deg.iter().map(move |column| (row, column)));
        for (cell, (distance, push_angle)) in cells.enumerate() {
            let mut axes = place.clone();
            axes.push(("distance_mm", *distance));
            axes.push(("push_angle_deg", *push_angle));
            let line = Line {
                axes: &axes,
                channels,
                samples: &samples,
                cell,
            };
            table.rows([line]).map_err(|cause| unwritten(path, cause))?;
        }
    }
    table.finish().map_err(|cause| unwritten(path, cause))
}

fn array(
    slice: &Slice,
    channels: &[&'static str],
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    let [channel] = channels else {
        return refuse(path, "an array has one channel; give one --channel");
    };
    let mut file = BufWriter::new(files.output("--output", path)?);
    for (number, whisker) in slice.whiskers().enumerate() {
        let (kind, bytes): (_, Vec<u8>) = match slice.read_panel(channel, whisker)? {
            Samples::F32(values) => (
                "<f4",
                values.into_iter().flat_map(f32::to_le_bytes).collect(),
            ),
            Samples::U32(codes) => (
                "<u4",
                codes.into_iter().flat_map(u32::to_le_bytes).collect(),
            ),
        };
        let header = if number == 0 {
            npy(kind, &slice.shape())
        } else {
            Vec::new()
        };
        let written = file
            .write_all(&header)
            .and_then(|()| file.write_all(&bytes));
        written.map_err(|cause| unwritten(path, cause))?;
    }
    let output = file.into_inner().map_err(IntoInnerError::into_error);
    let done = output.and_then(Output::finish);
    done.map_err(|cause| unwritten(path, cause))
}

/// Warns of an array whose states `status` marks: an array has one channel, so the marks are not in it.
fn warn_of_marks(
    slice: &Slice,
    channels: &[&'static str],
    marked: &[&'static str],
) -> Result<(), Failure> {
    if channels == marked {
        return Ok(());
    }
    let marks = Status::MARKS.map(Status::code);
    let (mut off, mut cells) = (0, 0);
    for whisker in slice.whiskers() {
        if let Samples::U32(codes) = slice.read_panel("status", whisker)? {
            off += codes.iter().filter(|code| marks.contains(code)).count();
            cells += codes.len();
        }
    }
    if off > 0 {
        let [sliding, sticking] = marks;
        say(&format!(
            "warning: {off} of {cells} cells of {} are off: their friction is not as assumed; --channel status marks them by {sliding} and {sticking}",
            channels.join(", ")
        ));
    }
    Ok(())
}

/// What precedes the values in a file of NumPy, version 1.0.
fn npy(kind: &str, shape: &[usize]) -> Vec<u8> {
    let sizes: String = shape.iter().map(|size| format!("{size},")).collect();
    let about = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({sizes}), }}");
    // The values begin at a multiple of 64 bytes, after a line's end.
    let length = (about.len() + 11).next_multiple_of(64) - 10;
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend((length as u16).to_le_bytes());
    header.extend(format!("{about:<width$}\n", width = length - 1).into_bytes());
    header
}

fn map(
    slice: &Slice,
    channels: &[&'static str],
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    let missing = ["regime", "status"]
        .into_iter()
        .find(|name| !channels.contains(name));
    if let Some(missing) = missing {
        let why = format!("a map needs the channel {missing}; name a .csv or .npy");
        return refuse(path, &why);
    }
    let sweep = slice.grid().sweep.iter();
    let axes: Vec<&str> = sweep.map(|axis| axis.parameter.axis()).collect();
    if axes.len() > 2 {
        let axes = axes.join(", ");
        let why = format!(
            "a map has room for two sweep axes, there are {axes}; give --at for the others"
        );
        return refuse(path, &why);
    }
    let (scene, origin) = (scene(slice)?, Origin::of(slice)?);
    let scene = Setup {
        grid: slice.grid().clone(),
        ..Setup::clone(&scene)
    };
    let about = origin.describe(&scene, Channels::those(|name| channels.contains(&name)));
    files.output("--output", path)?;
    let mut writer = MapWriter::create(path, &about)?;
    for whisker in 0..slice.grid().whisker_count() {
        writer.write_panels(&[slice.panel(about.channels, whisker)?])?;
    }
    writer.finish(EngineCells::default(), Audit::default())?;
    Ok(())
}

fn store(
    slice: &Slice,
    channels: &[&'static str],
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    if !slice.channels().contains(&"regime") {
        return refuse(
            path,
            "a store needs the channel regime; name a .csv or .npy",
        );
    }
    let (scene, origin) = (scene(slice)?, Origin::of(slice)?);
    let chosen = Channels::those(|name| channels.contains(&name));
    let about = origin.describe(&scene, chosen.with("regime"));
    files.store("--output", path)?;
    // A new store appears when it is complete; one that is there is written again, block by block.
    let folder = (!ZarrStore::is_at(path)).then(|| UnfinishedFolder::create(path));
    let folder = folder.transpose().map_err(|cause| unwritten(path, cause))?;
    let place = folder.as_ref().map_or(path, UnfinishedFolder::path);
    let store = ZarrStore::join(place, &scene, &about, true)?;
    store.begin()?;
    for block in 0..store.block_count() {
        let whiskers = store.whiskers(block);
        let packed = whiskers.map(|whisker| store.pack(&slice.panel(about.channels, whisker)?));
        store.write(block, &packed.collect::<Result<Vec<_>, _>>()?)?;
    }
    let finished = folder.map_or(Ok(()), |folder| folder.finish(path));
    finished.map_err(|cause| unwritten(path, cause))
}

/// The scene of the slice, in which each chosen axis has one value.
fn scene(slice: &Slice) -> Result<Scene, Failure> {
    let text = slice.stored().attribute("scene")?;
    let text = text.as_str().unwrap_or_default();
    let mut scene = Scene::parse(text, "the scene of the map")?;
    scene = scene.with("title", slice.title())?;
    for (axis, value) in slice.chosen() {
        scene = scene.with(&format!("grid.{axis}"), [*value])?;
    }
    Ok(scene)
}

/// What computed the whole, and how exactly.
struct Origin {
    engine: integrate::Description,
    arithmetic: String,
    tolerances: serde_json::Value,
}

impl Origin {
    fn of(slice: &Slice) -> Result<Self, Failure> {
        let text = |name: &str| {
            let text = slice.stored().attribute(name)?;
            Ok::<_, whiskmap::store::Error>(text.as_str().unwrap_or_default().to_owned())
        };
        let engine = integrate::Description {
            engine: text("engine")?,
            // A store, which many machines may have filled, has none.
            adapter: text("adapter").unwrap_or_default(),
        };
        Ok(Self {
            engine,
            // Maps of older versions do not have it.
            arithmetic: text("arithmetic").unwrap_or_default(),
            tolerances: slice.stored().attribute("tolerances")?,
        })
    }

    fn describe<'a>(&'a self, scene: &'a Setup, channels: Channels) -> Description<'a> {
        Description {
            scene,
            engine: &self.engine,
            tolerances: &self.tolerances,
            channels,
            arithmetic: &self.arithmetic,
        }
    }
}
