//! `whiskmap extract`.

use super::failure::{Failure, say};
use super::outputs::{create, unwritten};
use super::selection::{At, Selection};
use clap::Args;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::io::{self, BufWriter, IntoInnerError, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use whiskmap::integrate;
use whiskmap::map::{Audit, Channels, EngineCells, Panel, STATE_CHANNELS};
use whiskmap::scene::{Scene, Setup, digits};
use whiskmap::store::{Description, MapWriter, Output, Samples, Stored, Table};

/// Options of `extract`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap extract outputs/sweep.zarr --at taper=0.9 --at pole_radius_mm=0.25 -o slice.csv
  whiskmap extract outputs/sweep.zarr --at friction=0.2 --channel force_un -o force.npy
  whiskmap extract outputs/sweep.zarr -o map.exr
  whiskmap extract outputs/cone.exr --at distance_mm=15.66 --channel regime --channel force_un -o row.csv

A table has a line for each cell, with the values of all axes first; a quantity that there is not is left empty. An array \
has the axes that are left, in the order of the grid, then distance and push angle. A map has at most two sweep axes.")]
pub struct Options {
    /// Map or store written by `whiskmap map`
    source: PathBuf,
    /// Value of an axis to stay at: the nearest there is
    #[arg(long, value_name = "AXIS=VALUE", value_parser = At::from_str, allow_hyphen_values = true)]
    at: Vec<At>,
    /// Take the values of --at alone, not the nearest
    #[arg(long)]
    exact: bool,
    /// Channel to extract, more than one if repeated [default: all]
    #[arg(long, value_name = "NAME")]
    channel: Vec<String>,
    /// File to write: a table, an array of one channel or a map, by its ending .csv, .npy or .exr
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Runs `extract`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let stored = Stored::open(&options.source)?;
    let selection = Selection::new(stored.grid(), &options.at, options.exact)?;
    let channels = channels(&stored, &options.channel)?;
    let path = &options.output;
    for (name, value) in &selection.taken {
        say(&format!("{name} = {}", digits(*value)));
    }
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => table(&stored, &selection, &channels, path)?,
        Some("npy") => array(&stored, &selection, &channels, path)?,
        Some("exr") => map(&stored, &selection, &channels, path)?,
        _ => {
            let path = path.display();
            return Err(Failure::Input(format!(
                "--output {path}: must end in .csv, .npy or .exr"
            )));
        }
    }
    writeln!(io::stdout(), "{}", path.display())?;
    Ok(())
}

/// The channels that were asked for, or all.
fn channels(stored: &Stored, asked: &[String]) -> Result<Vec<&'static str>, Failure> {
    let known = stored.channels();
    if let Some(name) = asked.iter().find(|name| !known.contains(&name.as_str())) {
        let known = known.join(", ");
        return Err(Failure::Input(format!(
            "--channel {name}: must be one of {known}"
        )));
    }
    let is_wanted = |name: &&str| asked.is_empty() || asked.iter().any(|own| own == name);
    Ok(known.into_iter().filter(is_wanted).collect())
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
    stored: &Stored,
    selection: &Selection,
    channels: &[&'static str],
    path: &Path,
) -> Result<(), Failure> {
    let mut table = Table::new(create("--output", path)?);
    let (grid, width) = (stored.grid(), stored.grid().push_angle_deg.len());
    for whisker in selection.whiskers() {
        let samples = read(stored, channels, whisker)?;
        let place = selection.place(whisker);
        for cell in selection.cells() {
            let mut axes = place.clone();
            axes.push(("distance_mm", grid.distance_mm[cell / width]));
            axes.push(("push_angle_deg", grid.push_angle_deg[cell % width]));
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

/// The channels of a whisker.
fn read(stored: &Stored, channels: &[&str], whisker: usize) -> Result<Vec<Samples>, Failure> {
    let read = channels.iter().map(|name| stored.read_panel(name, whisker));
    Ok(read.collect::<Result<_, _>>()?)
}

fn array(
    stored: &Stored,
    selection: &Selection,
    channels: &[&'static str],
    path: &Path,
) -> Result<(), Failure> {
    let [channel] = channels else {
        return Err(Failure::Input(format!(
            "--output {}: an array has one channel; give one --channel",
            path.display()
        )));
    };
    let mut file = BufWriter::new(create("--output", path)?);
    for (number, whisker) in selection.whiskers().into_iter().enumerate() {
        let samples = stored.read_panel(channel, whisker)?;
        let (kind, bytes): (_, Vec<u8>) = match &samples {
            Samples::F32(values) => {
                let cells = selection.cells();
                (
                    "<f4",
                    cells.flat_map(|cell| values[cell].to_le_bytes()).collect(),
                )
            }
            Samples::U32(codes) => {
                let cells = selection.cells();
                (
                    "<u4",
                    cells.flat_map(|cell| codes[cell].to_le_bytes()).collect(),
                )
            }
        };
        let header = if number == 0 {
            npy(kind, &selection.shape())
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
    stored: &Stored,
    selection: &Selection,
    channels: &[&'static str],
    path: &Path,
) -> Result<(), Failure> {
    if let Some(missing) = ["regime", "status"]
        .iter()
        .find(|name| !channels.contains(*name))
    {
        let path = path.display();
        return Err(Failure::Input(format!(
            "--output {path}: a map needs the channel {missing}; name a .csv or .npy"
        )));
    }
    let axes: Vec<&str> = selection
        .grid
        .sweep
        .iter()
        .map(|axis| axis.parameter.axis())
        .collect();
    if axes.len() > 2 {
        return Err(Failure::Input(format!(
            "--output {}: a map has room for two sweep axes, there are {}; give --at for the others",
            path.display(),
            axes.join(", ")
        )));
    }
    let text = |name: &str| -> Result<String, Failure> {
        let text = stored.attribute(name)?;
        Ok(text.as_str().unwrap_or_default().to_owned())
    };
    let scene = Scene::parse(&text("scene")?, "the scene of the map")?;
    let taken = selection.taken.iter();
    let taken = taken.map(|(name, value)| format!(", {name} = {}", digits(*value)));
    let scene = Setup {
        grid: selection.grid.clone(),
        title: std::iter::once(stored.title().to_owned())
            .chain(taken)
            .collect(),
        ..Setup::clone(&scene)
    };
    let about = Description {
        scene: &scene,
        engine: &integrate::Description {
            engine: text("engine")?,
            adapter: text("adapter").unwrap_or_default(),
        },
        tolerances: &stored.attribute("tolerances")?,
        channels: Channels::those(|name| channels.contains(&name)),
    };
    let mut writer = MapWriter::create(path, &about)?;
    for index in 0..selection.grid.whisker_count() {
        let samples = read(stored, channels, selection.whisker(index))?;
        let panel = panel(selection, channels, &samples, about.channels);
        writer.write_panels(&[panel])?;
    }
    writer.finish(EngineCells::default(), Audit::default())?;
    Ok(())
}

/// The panel of a whisker, as far as its channels are known.
fn panel(selection: &Selection, channels: &[&str], samples: &[Samples], chosen: Channels) -> Panel {
    let cells: Vec<usize> = selection.cells().collect();
    let mut panel = Panel::unresolved(cells.len(), chosen);
    for (name, samples) in channels.iter().zip(samples) {
        let state = STATE_CHANNELS.iter().position(|own| own == name);
        match (samples, *name, state) {
            (Samples::U32(codes), name, _) => {
                let codes = cells.iter().map(|cell| codes[*cell]).collect();
                match name {
                    "regime" => panel.regime = codes,
                    "status" => panel.status = codes,
                    _ => panel.newton_steps = codes,
                }
            }
            (Samples::F32(values), name, state) => {
                let values = cells.iter().map(|cell| values[*cell]).collect();
                match (name, state) {
                    (_, Some(place)) => panel.state[place] = values,
                    ("margin_deg", _) => panel.margin_deg = values,
                    _ => panel.residual = values,
                }
            }
        }
    }
    panel
}
