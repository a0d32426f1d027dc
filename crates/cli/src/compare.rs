//! Command `whiskmap compare`.

use super::failure::Failure;
use super::files::{Files, STDOUT};
use super::outputs::write;
use super::solver::SolverArgs;
use super::source::{channel_names, computed, is_scene, stored, warn};
use clap::Args;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use whiskmap::compare::{
    CompareError, MapComparison, QuantityComparison, Within, check_same, compare,
};
use whiskmap::plan::{Channels, Digits};
use whiskmap::scene::Scene;
use whiskmap::store::{MapSource, StoreError};
use whiskmap::terminal::StandardOutput;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap map scenes/cone.toml --engine cpu -o cpu
  whiskmap map scenes/cone.toml --engine spectral -o spectral
  whiskmap compare cpu/cone.exr spectral/cone.exr
  whiskmap compare cpu/cone.exr spectral/cone.exr --within 1e-5 --json difference.json
  whiskmap compare cpu/cone.exr scenes/cone.toml --engine spectral
  whiskmap map scenes/cone.toml --engine cpu --format zarr --digits 4 -o rounded
  whiskmap compare cpu/cone.exr rounded/cone.zarr --within force_un=0.1,regime=0

Both maps need the same scene and grid; engines, tolerances, channels, digits and formats may differ. Channels that only one \
map has are named. The map of a scene is computed, with the channels of the other map.

The exit code is 1 if a difference exceeds --within. N is the allowed difference of channels of states and of margin_deg, as \
a fraction of the channel's largest value; then no regime may differ. NAME=VALUE is the allowed difference of one channel, in \
its unit, and of regime or status the number of cells that may differ. What rounding by --digits explains is not a \
difference.")]
pub struct CompareArgs {
    /// First map: a map or store written by `whiskmap map`, or a scene file (.toml); - is a scene on standard input
    first: PathBuf,
    /// Second map, as the first
    second: PathBuf,
    /// Largest allowed differences: N relative for all states, NAME=VALUE for one channel; separated by commas
    #[arg(long, value_name = "LIST", value_parser = Within::from_str, allow_hyphen_values = true)]
    within: Option<Within>,
    /// Write the comparison to FILE, as JSON; - is standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Options for a scene")]
    solver: SolverArgs,
}

pub fn run(args: &CompareArgs, files: &mut Files) -> Result<(), Failure> {
    let paths = [&args.first, &args.second];
    let maps = open(args, files)?;
    let json = args.json.as_deref();
    let json = json.map(|path| files.output("--json", path)).transpose()?;
    if let Some(within) = &args.within {
        check(within, paths, &maps)?;
    }
    let comparison = compare(maps.each_ref())?;
    maps.iter().for_each(warn);
    let within = args.within.as_ref();
    let exceeded = within.map_or_else(Vec::new, |within| within.exceeded(&comparison));
    if args.json.as_deref() != Some(Path::new(STDOUT)) {
        print(paths, &maps, &comparison)?;
    }
    if let Some(output) = json {
        let document = document(paths, &comparison, &exceeded);
        write(output, format!("{document:#}\n").as_bytes())?;
    }
    match &exceeded[..] {
        [] => Ok(()),
        channels => Err(Failure::Different(channels.join(", "))),
    }
}

/// Opens both maps. For a scene, the channels that the other map has are computed. Other scenes are refused before an engine is opened.
fn open(args: &CompareArgs, files: &mut Files) -> Result<[MapSource; 2], Failure> {
    let CompareArgs { first, second, solver, .. } = args;
    let of_scene = |scene: Scene, other: Option<&MapSource>| {
        let known = channel_names(&scene);
        let channels = other.map_or(Channels::STANDARD, |other| {
            let others = other.channels();
            Channels::those(|name| known.contains(&name) && others.contains(&name))
        });
        let whiskers = scene.whisker_count();
        computed(scene, solver, channels, whiskers).map(MapSource::from)
    };
    // Options of the solver are for the scene, if there is one.
    let unused = SolverArgs::default();
    Ok(match [first, second].map(|path| is_scene(path)) {
        [false, false] => [stored(files, first, solver)?, stored(files, second, solver)?],
        [true, true] => {
            let scenes = [files.scene(first)?, files.scene(second)?];
            check_same(scenes.each_ref()).map_err(CompareError::from)?;
            let [first_map, second_map] = scenes.map(|scene| of_scene(scene, None));
            [first_map?, second_map?]
        }
        [is_first, _] => {
            let (stored_path, scene_path) =
                if is_first { (second, first) } else { (first, second) };
            let stored_map = stored(files, stored_path, &unused)?;
            let scene = files.scene(scene_path)?;
            if let Ok(stored_scene) = stored_map.scene()? {
                let scenes = [&stored_scene, &scene];
                check_same(in_order(scenes, is_first)).map_err(CompareError::from)?;
            }
            let scene_map = of_scene(scene, Some(&stored_map))?;
            in_order([stored_map, scene_map], is_first)
        }
    })
}

/// Returns a pair in reverse order if `is_reversed` is true.
fn in_order<T>([one, other]: [T; 2], is_reversed: bool) -> [T; 2] {
    if is_reversed { [other, one] } else { [one, other] }
}

/// Returns an error if a map lacks a channel that --within names.
fn check(within: &Within, paths: [&PathBuf; 2], maps: &[MapSource; 2]) -> Result<(), Failure> {
    for name in within.channels() {
        for (path, map) in paths.into_iter().zip(maps) {
            let known = map.channels();
            if !known.contains(&name) {
                let (path, known) = (path.display(), known.join(", "));
                let why = format!("--within {name}: {path} has no such channel; it has {known}");
                return Err(Failure::Input(why));
            }
        }
    }
    Ok(())
}

fn document(paths: [&PathBuf; 2], comparison: &MapComparison, exceeded: &[&str]) -> Value {
    let mut document = json!(comparison);
    document["maps"] = json!(paths);
    document["exceeded"] = json!(exceeded);
    document
}

fn print(
    paths: [&PathBuf; 2],
    maps: &[MapSource; 2],
    found: &MapComparison,
) -> Result<(), Failure> {
    let mut out = StandardOutput::open();
    for (path, map) in paths.into_iter().zip(maps) {
        writeln!(out, "{}: {}", path.display(), settings(map)?)?;
    }
    writeln!(out, "{:>12}  cells", found.cells)?;
    for codes in &found.codes {
        writeln!(out, "{:>12}  cells differ in {}", codes.differing, codes.channel)?;
        for pair in &codes.pairs {
            let [first, second] = &pair.names;
            writeln!(out, "{:>12}  {first} / {second}", pair.cells)?;
        }
        for cell in &codes.first {
            let [first, second] = &cell.names;
            writeln!(out, "{:14}at {}: {first} / {second}", "", cell.place)?;
        }
    }
    if !found.quantities.is_empty() {
        table(&mut out, &found.quantities)?;
    }
    for (path, names) in paths.into_iter().zip(&found.only_in) {
        if !names.is_empty() {
            writeln!(out, "only in {}: {}", path.display(), names.join(", "))?;
        }
    }
    Ok(())
}

/// Returns engine, arithmetic and digits of a map.
fn settings(map: &MapSource) -> Result<String, StoreError> {
    let engine = map.attribute("engine")?;
    let digits = match map.digits()? {
        Digits::ALL => "all digits".to_owned(),
        digits => format!("digits {digits}"),
    };
    let engine = engine.as_str().unwrap_or_default();
    // Maps of older versions do not have it.
    let arithmetic = map.attribute("arithmetic").unwrap_or_default();
    Ok(format!(
        "engine {engine}, arithmetic {}, {digits}",
        arithmetic.as_str().unwrap_or("unknown")
    ))
}

/// Prints a line for each channel of quantities. Differences beyond the rounding are only shown if a map is rounded.
fn table(out: &mut impl Write, quantities: &[QuantityComparison]) -> io::Result<()> {
    let has_rounding = quantities.iter().any(QuantityComparison::is_rounded);
    let rounding = if has_rounding { "  beyond digits" } else { "" };
    writeln!(
        out,
        "{:19}  {:>10}  {:>10}  {:>8}  {:>8}  {:>8}{rounding}  place of the largest",
        "channel", "cells", "differing", "median", "largest", "relative"
    )?;
    for quantity in quantities {
        let rounding = match has_rounding {
            true => format!("  {:>13.1e}", quantity.beyond_rounding),
            false => String::new(),
        };
        let place = quantity.place.as_ref().map(ToString::to_string).unwrap_or_default();
        let line = format!(
            "{:19}  {:>10}  {:>10}  {:>8.1e}  {:>8.1e}  {:>8.1e}{rounding}  {place}",
            quantity.channel,
            quantity.cells,
            quantity.differing,
            quantity.median,
            quantity.largest,
            quantity.relative(quantity.largest)
        );
        writeln!(out, "{}", line.trim_end())?;
        let [first, second] = quantity.only_in;
        if first + second > 0 {
            writeln!(
                out,
                "{:19}  {first} cells have a value only in the first map, {second} only in the second",
                ""
            )?;
        }
    }
    Ok(())
}
