//! Command `whiskmap extract`.

mod array;
mod table;

use self::array::array;
use self::table::table;
use super::arguments::{all_channels, completed};
use super::failure::Failure;
use super::files::{Files, unwritten};
use super::selection::{SelectionArgs, channels};
use super::solver::SolverArgs;
use super::source::warn;
use clap::Args;
use clap::builder::StringValueParser;
use std::io::Write;
use std::path::{Path, PathBuf};
use whiskmap::engine;
use whiskmap::map::{Audit, EngineCells};
use whiskmap::plan::{Channels, Digits};
use whiskmap::scene::{LONGEST_TITLE, Scene, SceneData};
use whiskmap::store::{MapDescription, MapSlice, MapWriter, TemporaryFolder, ZarrStore};
use whiskmap::terminal::StandardOutput;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap map scenes/morphology.toml --format zarr
  whiskmap extract outputs/morphology.zarr --at taper=0.95 --at push_angle_deg=10 -o slice.csv
  whiskmap extract outputs/morphology.zarr --at taper=0.95 --channel force_un -o force.npy
  whiskmap extract outputs/morphology.zarr --at taper=0.95 -o slice.zarr
  whiskmap extract outputs/morphology.zarr -o map.exr
  whiskmap map scenes/cone.toml
  whiskmap extract outputs/cone.exr --at distance_mm=15.66 --channel regime --channel force_un -o row.csv
  whiskmap extract scenes/morphology.toml --at taper=0.95 --at curvature_per_mm=0.02 -o slice.csv

A table has one line per cell, with the values of all axes first; missing values are empty. The columns regime_name and \
status_name have the names of the codes. An array has the remaining axes in \
the order of the grid, then distance and push angle. A store keeps every axis; the axes of --at have one value. A map has at \
most two sweep axes. Of a scene, only the whiskers of the part are computed: the result is that of `map` and `extract`.")]
pub struct ExtractArgs {
    /// Map or store written by `whiskmap map`, or a scene file (.toml), which is computed; - is a scene on standard input
    source: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Extract this channel; may be repeated [default: all]
    #[arg(long, value_name = "NAME", value_parser = completed(StringValueParser::new(), all_channels()), hide_possible_values = true)]
    channel: Vec<String>,
    /// Write FILE; the ending selects a table (.csv), an array of one channel (.npy), a store (.zarr) or a map (.exr)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten, next_help_heading = "Options for a scene")]
    solver: SolverArgs,
}

pub fn run(args: &ExtractArgs, files: &mut Files) -> Result<(), Failure> {
    let named: Vec<&str> = args.channel.iter().map(String::as_str).collect();
    // A store has the regimes, whatever is named.
    let regime = (!named.is_empty()).then_some("regime");
    let wanted: Vec<&str> = named.iter().copied().chain(regime).collect();
    let (source, solver) = (&args.source, &args.solver);
    let slice = args.selection.open(files, source, solver, |_| wanted)?;
    let channels = channels(&slice.channels(), &named)?;
    let path = &args.output;
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => table(&slice, &channels, path, files)?,
        Some("npy") => array(&slice, &channels, path, files)?,
        Some("zarr") => store(&slice, &channels, path, files)?,
        Some("exr") => map(&slice, &channels, path, files)?,
        _ => return refuse(path, "must end in .csv, .npy, .zarr or .exr"),
    }
    warn(slice.source());
    writeln!(StandardOutput::open(), "{}", path.display())?;
    Ok(())
}

fn refuse(path: &Path, why: &str) -> Result<(), Failure> {
    let path = path.display();
    Err(Failure::Input(format!("--output {path}: {why}")))
}

fn map(
    slice: &MapSlice,
    channels: &[&'static str],
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    let missing = ["regime", "status"].into_iter().find(|name| !channels.contains(name));
    if let Some(missing) = missing {
        let why = format!("a map needs the channel {missing}; name a .csv or .npy");
        return refuse(path, &why);
    }
    if slice.grid().sweep.len() > 2 {
        let axes = slice.grid().sweep_names();
        let why = format!(
            "a map holds at most two sweep axes, the slice has {axes}; give --at for the others"
        );
        return refuse(path, &why);
    }
    let (scene, origin) = (scene(slice)?, MapOrigin::of(slice)?);
    let scene = SceneData { grid: slice.grid().clone(), ..SceneData::clone(&scene) };
    let about = origin.describe(&scene, Channels::those(|name| channels.contains(&name)));
    let mut writer = MapWriter::create(files.file("--output", path)?, &about)?;
    for whisker in 0..slice.grid().whisker_count() {
        writer.write_panels(&[slice.panel(about.channels, whisker)?])?;
    }
    writer.finish(EngineCells::default(), Audit::default())?;
    Ok(())
}

fn store(
    slice: &MapSlice,
    channels: &[&'static str],
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    if !slice.channels().contains(&"regime") {
        return refuse(path, "a store needs the channel regime; name a .csv or .npy");
    }
    let (scene, origin) = (scene(slice)?, MapOrigin::of(slice)?);
    let chosen = Channels::those(|name| channels.contains(&name));
    let about = origin.describe(&scene, chosen.with("regime"));
    files.store("--output", path)?;
    let is_free = match path.read_dir() {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) => !path.exists() && !path.is_symlink(),
    };
    if !ZarrStore::is_at(path) && !is_free {
        return refuse(
            path,
            "exists, and is neither a store nor an empty folder; give another name",
        );
    }
    // A new store appears when it is complete; an existing one is rewritten block by block.
    let temporary = files.temporary();
    let folder = (!ZarrStore::is_at(path)).then(|| files.new_store("--output", path));
    let folder = folder.transpose()?;
    let place = folder.as_ref().map_or(path, TemporaryFolder::path);
    let store = ZarrStore::join(place, &scene, &about, true)?;
    store.begin(temporary)?;
    for block in 0..store.block_count() {
        let whiskers = store.whiskers(block);
        let packed = whiskers.map(|whisker| Ok(store.pack(&slice.panel(about.channels, whisker)?)));
        store.write(
            block,
            &packed.collect::<Result<Vec<_>, whiskmap::store::StoreError>>()?,
            temporary,
        )?;
    }
    store.sync()?;
    let finished = folder.map_or(Ok(()), |folder| folder.finish(path));
    finished.map_err(unwritten(path))
}

/// Returns the scene of the slice, in which each selected axis has one value.
fn scene(slice: &MapSlice) -> Result<Scene, Failure> {
    let text = slice.source().attribute("scene")?;
    let text = text.as_str().unwrap_or_default();
    let scene = Scene::parse(text, "the scene of the map")?;
    // The selected values can extend a title beyond its limit.
    let title: String = slice.title().chars().take(LONGEST_TITLE).collect();
    let mut builder = scene.to_builder().title(title);
    for (axis, value) in slice.chosen() {
        builder = builder.fixed(axis, value);
    }
    Ok(builder.build()?)
}

/// Engine, arithmetic, tolerances and digits of the whole map.
struct MapOrigin {
    engine: engine::EngineDescription,
    arithmetic: String,
    tolerances: serde_json::Value,
    digits: Digits,
}

impl MapOrigin {
    fn of(slice: &MapSlice) -> Result<Self, Failure> {
        let text = |name: &str| {
            let text = slice.source().attribute(name)?;
            Ok::<_, whiskmap::store::StoreError>(text.as_str().unwrap_or_default().to_owned())
        };
        let engine = engine::EngineDescription {
            engine: text("engine")?,
            // A store has no adapter, because many machines may have filled it.
            adapter: text("adapter").unwrap_or_default(),
        };
        Ok(Self {
            engine,
            // Maps of older versions do not have it.
            arithmetic: text("arithmetic").unwrap_or_default(),
            tolerances: slice.source().attribute("tolerances")?,
            digits: slice.source().digits()?,
        })
    }

    fn describe<'a>(&'a self, scene: &'a SceneData, channels: Channels) -> MapDescription<'a> {
        MapDescription {
            scene,
            engine: &self.engine,
            tolerances: &self.tolerances,
            channels,
            digits: self.digits,
            arithmetic: &self.arithmetic,
        }
    }
}
