//! `whiskmap curve`.

use super::columns;
use super::failure::{Failure, check_resolved};
use super::outputs::{Opened, Outputs};
use super::progress;
use super::tolerance::Tolerance;
use clap::Args;
use serde::Serialize;
use std::path::PathBuf;
use whiskmap::render::{CurveAxis, curves};
use whiskmap::rod::Side;
use whiskmap::scene::{Place, Scene, Swept};
use whiskmap::shooting::Resolution;
use whiskmap::trace::{self, Corner, Detachment, DetachmentKind};

const EXAMPLES: &str = "\
Examples:
  whiskmap curve scenes/cone.toml | head
  whiskmap curve scenes/cone.toml --csv curve.csv --plot curve.svg
  whiskmap curve scenes/cone.toml --tolerance 1e-4deg
  whiskmap curve scenes/cone.toml --corner

One line per side and distance of the scene, CF before CB; angles are positive for CB and negative for CF. Ends \
without values are out of reach, or unresolved, which is said on standard error. A scene with sweep axes, such as \
grid.taper, gives the curve of every whisker, with a leading column for each; a plot shows one whisker.";

const TABLES: &[(&str, &[(&str, &str)])] = &[
    ("Columns", Detachment::COLUMNS),
    ("Columns with --corner", Corner::COLUMNS),
];

/// Options of `curve`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, after_long_help = columns::help(EXAMPLES, TABLES))]
pub struct Options {
    /// Scene file; - reads it from standard input
    scene: PathBuf,
    /// Tell only where slip-off turns into pull-off, or why it does not
    #[arg(long, conflicts_with_all = ["plot", "tolerance"])]
    corner: bool,
    #[command(flatten)]
    tolerance: Tolerance,
    #[command(flatten)]
    outputs: Outputs,
}

/// Runs `curve`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let scene = Scene::read(&options.scene)?;
    let whiskers = scene.whisker_count();
    if options.outputs.has_plot() && whiskers > 1 {
        return Err(Failure::Input(format!(
            "--plot: the scene sweeps {whiskers} whiskers over {}; a plot shows one",
            axes(&scene)
        )));
    }
    let mut outputs = options.outputs.open()?;
    let accuracy = options.tolerance.choose(&scene, &Side::BOTH)?;
    let resolution = accuracy.map_or(Resolution::FINE, |accuracy| accuracy.resolution);
    let mut drawn = Vec::new();
    let (mut unresolved, mut all) = (0, 0);
    let distances = &scene.grid.distance_mm;
    let of_side = if options.corner { 1 } else { distances.len() };
    let bar = progress::bar(whiskers * Side::BOTH.len() * of_side, "ends");
    bar.tick();
    let at_once = trace::whiskers_at_once(distances.len());
    for group in scene.whisker_groups(at_once) {
        if options.corner {
            let corner = |own: &Swept, side| {
                let corner = trace::corner(&own.whisker, &own.pole, side);
                bar.inc(1);
                vec![corner]
            };
            write(&scene, &mut outputs, &trace::sides(&group, corner))?;
            continue;
        }
        let curve = |own: &Swept, side| {
            let ends = trace::curve_at(resolution, &own.whisker, &own.pole, side, distances);
            bar.inc(ends.len() as u64);
            ends
        };
        let rows = trace::sides(&group, curve);
        write(&scene, &mut outputs, &rows)?;
        let kinds = rows.iter().map(|(_, row)| row.kind);
        let kinds = kinds.filter(|kind| *kind == DetachmentKind::Unresolved);
        unresolved += kinds.count() as u64;
        all += rows.len() as u64;
        if options.outputs.has_plot() {
            drawn.extend(rows.into_iter().map(|(_, row)| row));
        }
    }
    bar.finish_and_clear();
    outputs.finish(scene.title.clone(), || curves("", &drawn, AXES))?;
    check_resolved(unresolved, all, "ends", "the column `kind`")
}

/// The sweep axes by their keys.
fn axes(scene: &Scene) -> String {
    let keys = scene.grid.sweep.iter();
    let keys: Vec<String> = keys
        .map(|axis| format!("grid.{}", axis.parameter.axis()))
        .collect();
    keys.join(", ")
}

/// Writes the rows of some whiskers, with a leading column for each sweep axis.
fn write<R: Serialize>(
    scene: &Scene,
    outputs: &mut Opened,
    rows: &[(Place, R)],
) -> Result<(), Failure> {
    if scene.is_sweep() {
        outputs.rows(rows)
    } else {
        outputs.rows(rows.iter().map(|(_, row)| row))
    }
}

const AXES: [CurveAxis; 2] = [
    CurveAxis {
        label: "distance at first touch (mm)",
        value: |end| Some(end.distance_mm),
    },
    CurveAxis {
        label: "push angle at detachment (deg)   CF < 0 < CB",
        value: |end| end.push_angle_deg,
    },
];
