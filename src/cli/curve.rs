//! `whiskmap curve`.

use super::columns;
use super::data;
use super::failure::{Failure, check_resolved, say};
use super::files::Files;
use super::outputs::{Opened, Outputs};
use super::pole::check_single;
use super::progress::Progress;
use super::theory::{AXES, CHORD, own_curve, theory};
use super::tolerance::Tolerance;
use super::uncertainty::{self, Sampling};
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};
use whiskmap::measured::{Angle, Compared};
use whiskmap::render::{Plot, measured};
use whiskmap::rod::Side;
use whiskmap::scene::{Place, Scene, Swept};
use whiskmap::shooting::Resolution;
use whiskmap::trace::{self, Corner, Detachment, DetachmentKind};
use whiskmap::uncertainty::Spread;

const EXAMPLES: &str = "\
Examples:
  whiskmap curve scenes/cone.toml | head
  whiskmap curve scenes/cone.toml --csv curve.csv --plot curve.svg
  whiskmap curve scenes/cone.toml --tolerance 1e-4deg
  whiskmap curve scenes/cone.toml --corner
  whiskmap curve scenes/cone.toml --data scenes/cone_points.csv --plot points.svg
  whiskmap curve scenes/uncertain.toml --samples 500 --csv bands.csv --plot bands.svg

One line per side and distance of the scene, CF before CB; angles are positive for CB and negative for CF. Ends \
without values are out of reach, or unresolved, which is said on standard error. A scene with sweep axes, such as \
grid.taper, gives the curve of every whisker, with a leading column for each; a plot shows one whisker.

With --data the table has the measured points in place of the curve: a CSV file with the columns side (cb or cf), \
distance_mm, push_angle_deg or push_chord_deg, and maybe kind (slip-off, pull-off or empty) and sd_deg. The plot has them \
on the curve, slip-offs as open circles and pull-offs as filled ones. Their RMS and bias are told on standard error.

With --samples, whiskers are drawn with the standard deviations of the scene's [uncertainty], independently and normally; \
a draw that the scene's limits refuse is drawn again, and standard error says how often. Percentiles are linear between \
neighbouring samples. Equal seeds give equal samples, whatever the number of threads.";

const TABLES: &[(&str, &[(&str, &str)])] = &[
    ("Columns", Detachment::COLUMNS),
    ("Columns with --corner", Corner::COLUMNS),
    ("Columns with --data", Compared::COLUMNS),
    ("Columns with --samples", Spread::COLUMNS),
];

/// Options of `curve`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, after_long_help = columns::help(EXAMPLES, TABLES))]
pub struct Options {
    /// Scene file; - reads it from standard input
    scene: PathBuf,
    /// Tell only where slip-off turns into pull-off, or why it does not
    #[arg(long, conflicts_with_all = ["plot", "tolerance", "samples"])]
    corner: bool,
    /// Measured detachments to compare with the curve; - reads them from standard input
    #[arg(long, value_name = "FILE", conflicts_with_all = ["corner", "tolerance", "samples"])]
    data: Option<PathBuf>,
    #[command(flatten)]
    sampling: Sampling,
    #[command(flatten)]
    tolerance: Tolerance,
    #[command(flatten)]
    outputs: Outputs,
}

/// Runs `curve`.
pub fn run(options: &Options, files: &mut Files) -> Result<(), Failure> {
    if let Some(data) = &options.data {
        data::check_stdin(&options.scene, data)?;
    }
    let scene = files.scene(&options.scene)?;
    let whiskers = scene.whisker_count();
    if options.outputs.has_plot() && whiskers > 1 {
        return Err(Failure::Input(format!(
            "--plot: the scene sweeps {whiskers} whiskers over {}; a plot shows one",
            axes(&scene)
        )));
    }
    if let Some(path) = &options.data {
        return beside_points(options, &scene, path, files);
    }
    let draws = options.sampling.draw(&scene)?;
    let mut outputs = options.outputs.open(files)?;
    let accuracy = options.tolerance.choose(&scene, &Side::BOTH)?;
    let resolution = accuracy.map_or(Resolution::FINE, |accuracy| accuracy.resolution);
    if let Some(draws) = draws {
        return uncertainty::run(&scene, &draws, resolution, outputs);
    }
    let mut drawn = Vec::new();
    let (mut unresolved, mut all) = (0, 0);
    let distances = &scene.grid.distance_mm;
    let of_side = if options.corner { 1 } else { distances.len() };
    let bar = Progress::over(whiskers * Side::BOTH.len() * of_side, "ends");
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
            bar.inc(ends.len());
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
    bar.finish();
    outputs.finish(scene.title.clone(), || theory(&drawn, AXES))?;
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

/// Compares the measured points of the file at `path` with the curve.
fn beside_points(
    options: &Options,
    scene: &Scene,
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    check_single(scene, "curve --data")?;
    let points = data::read(files, path)?;
    let Swept { whisker, pole, .. } = scene.first_whisker();
    points.check_reach(&whisker, &pole)?;
    let mut outputs = options.outputs.open(files)?;
    let comparison = points.beside(&whisker, &pole);
    data::name_left_out(&points, &comparison);
    let rows = &comparison.rows;
    outputs.rows(rows)?;
    outputs.finish(scene.title.clone(), || {
        let axes = match points.angle {
            Angle::Push => AXES,
            Angle::Chord => [AXES[0], CHORD],
        };
        Plot {
            dots: measured(rows),
            ..own_curve(scene, Resolution::FINE, axes)
        }
    })?;
    if comparison.count() == 0 {
        return Err(Failure::Unresolved {
            all: rows.len() as u64,
            what: "points",
            see: "the column `predicted_kind`",
        });
    }
    for (name, value) in data::summary(&comparison) {
        say(&format!("{name}: {value}"));
    }
    Ok(())
}
