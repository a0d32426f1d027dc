//! Command `whiskmap curve`.

mod plot;
mod points;

use super::arguments::{column_help, length};
use super::data::ColumnArgs;
use super::derivatives::{DerivativeArgs, DerivativeColumns};
use super::failure::{Failure, check_resolved};
use super::files::Files;
use super::marks::{Marked, PUSH_MARKS};
use super::outputs::{OpenOutputs, OutputArgs};
use super::pole;
use super::progress::Progress;
use super::scene::check_strict;
use super::selection::SelectionArgs;
use super::tolerance::ToleranceArgs;
use super::uncertainty::{self, SampleArgs};
use clap::Args;
use plot::{CurveColumn, MOST_WHISKERS, UPWARD, plot_title, scene_curves};
use rayon::prelude::*;
use serde::Serialize;
use std::path::PathBuf;
use whiskmap::Side;
use whiskmap::measured::ComparedPoint;
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::render::{Plot, bands, yielding_ends};
use whiskmap::scene::{Scene, SweepPlace, SweptWhisker};
use whiskmap::sensitivity::{DetachmentDerivatives, Variable, detachments_of_sides};
use whiskmap::trace::{self, Corner, Detachment, DetachmentKind, SweptSide};
use whiskmap::uncertainty::{Draws, EndSpread, LargestSpread, PointSpread};
use whiskmap::yields::{PushMark, YieldMark};

const EXAMPLES: &str = "\
Examples:
  whiskmap curve scenes/cone.toml | head
  whiskmap curve scenes/cone.toml --csv curve.csv --plot curve.svg
  whiskmap curve scenes/cone.toml --tolerance 1e-4deg
  whiskmap curve scenes/robot.toml --distance 60 --units mN,Nmm
  whiskmap curve scenes/cone.toml --derivatives=taper,length_mm --csv curve.csv
  whiskmap curve scenes/cone.toml --corner
  whiskmap curve scenes/morphology.toml --at taper=0.95 --at curvature_per_mm=0.02 --plot curve.svg
  whiskmap curve scenes/pad.toml --csv pad.csv --plot pad.svg
  whiskmap curve scenes/pad.toml --at whisker=C2 --plot C2.svg
  whiskmap curve scenes/cone.toml --data scenes/cone_points.csv --plot points.svg
  whiskmap curve scenes/uncertain.toml --samples 500 --csv bands.csv --plot bands.svg
  whiskmap curve scenes/uncertain.toml --samples 500 --x force_un --plot forces.svg
  whiskmap curve scenes/uncertain.toml --samples 500 --data scenes/cone_points.csv --csv beside.csv

The table has one line per side and distance of the scene, CF before CB. Angles are positive for CB and negative for CF. \
Lines without values are out of reach or unresolved; standard error gives the number of unresolved ones. For a scene with \
sweep axes, such as grid.taper, the table has the curve of every whisker, with a leading column for each axis. With a table of \
whiskers, the column whisker has their names, and no_whisker the reason why a row has no whisker. The colours of a plot \
show the values of the first sweep axis, or the whiskers of the table.

With --derivatives, columns such as d_push_d_taper follow: exact derivatives of the push angle, force, moment, energy, arc length \
and contact angle at detachment, each in the unit of its quantity per unit of the variable. Without a derivative, they are empty.

With --data, the table has measured points instead of the curve. They are read from a CSV file with the columns side (cb or \
cf), distance_mm, push_angle_deg or push_chord_deg, and optionally kind (slip-off, pull-off or empty) and sd_deg. The plot \
shows them on the curve, slip-offs as open circles and pull-offs as filled ones, with error bars of one standard deviation. \
The curve reaches the distances of all points. Their RMS and bias are printed on standard error. With --samples, the plot shows \
the bands, too, and the table has the percentiles at the distance of each point.

With --samples, whiskers are drawn from the standard deviations in the scene's [uncertainty], independently and with normal \
distributions. A draw outside the limits of the scene is repeated; standard error gives the number of such draws. \
Percentiles are linear between neighbouring samples. The samples depend on the seed alone, not on the number of threads.";

const TABLES: &[(&str, &[(&str, &str)])] = &[
    ("Columns", Detachment::COLUMNS),
    ("Columns with --corner", Corner::COLUMNS),
    PUSH_MARKS,
    ("Columns with --data", ComparedPoint::COLUMNS),
    ("Columns with --samples", EndSpread::COLUMNS),
    ("More columns with --largest", LargestSpread::COLUMNS),
    ("More columns with --largest and whisker.yield_strain", YieldMark::COLUMNS),
    ("More columns with --data and --samples", PointSpread::COLUMNS),
];

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, after_long_help = column_help(EXAMPLES, TABLES))]
pub struct CurveArgs {
    /// Scene file; - is standard input
    scene: PathBuf,
    /// Print only where slip-off turns into pull-off, or why it does not
    #[arg(long, conflicts_with_all = ["plot", "tolerance", "samples", "derivatives", "distance"])]
    corner: bool,
    /// Compare the measured detachments in FILE with the curve; - is standard input
    #[arg(long, value_name = "FILE", group = "table", conflicts_with_all = ["corner", "tolerance", "derivatives"])]
    data: Option<PathBuf>,
    #[command(flatten)]
    columns: ColumnArgs,
    /// Column on the horizontal axis of the plot
    #[arg(
        long,
        value_name = "COLUMN",
        value_enum,
        default_value = "push_angle_deg",
        requires = "plot",
        conflicts_with = "data"
    )]
    x: CurveColumn,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Refuse a table of whiskers that has a row without a whisker
    #[arg(long)]
    strict: bool,
    /// Distances from the base to the contact at first touch in place of the scene's, in mm or with a unit, such as 1.5cm; several
    /// are separated by commas
    #[arg(long, value_name = "LENGTH", value_delimiter = ',', allow_hyphen_values = true, value_parser = length)]
    distance: Vec<f64>,
    #[command(flatten)]
    derivatives: DerivativeArgs,
    #[command(flatten)]
    sampling: SampleArgs,
    #[command(flatten)]
    tolerance: ToleranceArgs,
    #[command(flatten)]
    outputs: OutputArgs,
}

pub fn run(args: &CurveArgs, files: &mut Files) -> Result<(), Failure> {
    files.inputs("--data", &args.data)?;
    let mut scene = args.selection.of_scene(&files.scene(&args.scene)?)?;
    check_strict(args.strict, &scene)?;
    if !args.distance.is_empty() {
        pole::check_distances(&scene, &args.distance)?;
        let mut distances = args.distance.clone();
        distances.sort_by(f64::total_cmp);
        distances.dedup();
        scene = scene.to_builder().distance_mm(distances).build()?;
    }
    if args.sampling.draws() && scene.whisker_count() == 1 {
        scene = scene.of_whisker(0)?;
    }
    let variables = args.derivatives.variables(&scene, &[])?;
    if args.outputs.picture.plot.is_some() {
        check_whiskers_of_plot(&scene)?;
    }
    if let Some(path) = &args.data {
        return points::compare(args, &scene, path, files);
    }
    let draws = args.sampling.draw(&scene)?;
    let outputs = args.outputs.open(files)?;
    let accuracy = args.tolerance.find(&scene, &Side::BOTH)?;
    args.tolerance.report(accuracy);
    let resolution = accuracy.map_or(Resolution::FINE, |accuracy| accuracy.resolution);
    match draws {
        Some(draws) => samples(args, &scene, &draws, resolution, outputs),
        None if args.corner => corners(&scene, outputs),
        None => detachments(args, &scene, &variables, resolution, outputs),
    }
}

/// Refuses a scene with more whiskers than a plot shows.
fn check_whiskers_of_plot(scene: &Scene) -> Result<(), Failure> {
    let whiskers = scene.whisker_count();
    if whiskers <= MOST_WHISKERS {
        return Ok(());
    }
    let axes = scene.grid.sweep.iter().filter(|axis| axis.values.len() > 1);
    let (keys, values): (Vec<_>, Vec<_>) = axes
        .map(|axis| {
            let value = axis.variable.coordinate(axis.values[axis.values.len() / 2]);
            let at = format!("--at {}={value}", axis.variable.name());
            (axis.variable.key(), at)
        })
        .unzip();
    Err(Failure::Input(format!(
        "--plot: the scene sweeps {whiskers} whiskers over {}; a plot shows at most {MOST_WHISKERS}: choose some, such as by {}",
        keys.join(", "),
        values.join(" ")
    )))
}

/// Writes the spread of the ends of pushes of the random whiskers `draws`, with --largest also that of their largest loads.
fn samples(
    args: &CurveArgs,
    scene: &Scene,
    draws: &Draws,
    resolution: Resolution,
    mut outputs: OpenOutputs,
) -> Result<(), Failure> {
    let rows = uncertainty::spread(draws, resolution);
    match args.sampling.largest {
        true => {
            let largest = uncertainty::largest(draws).into_iter();
            let rows = rows.iter().zip(largest).map(|(row, largest)| {
                let mark = YieldMark::new(&scene.whisker, largest.max_strain);
                Marked((row, largest), mark)
            });
            outputs.rows(rows)?;
        }
        false => outputs.rows(&rows)?,
    }
    outputs.finish(scene.title.clone(), || Plot {
        bands: bands(&rows, args.x.percentiles()),
        ..scene_curves(scene, resolution, args.x.axis())
    })?;
    uncertainty::check(&rows, draws)
}

/// Writes the ends of the pushes of each whisker, with their derivatives by `variables`.
fn detachments(
    args: &CurveArgs,
    scene: &Scene,
    variables: &[Variable],
    resolution: Resolution,
    mut outputs: OpenOutputs,
) -> Result<(), Failure> {
    let unmarked = scene.has_yield_strain().then(PushMark::default);
    let (mut unresolved, mut all) = (0, 0);
    let mut yielding = Vec::new();
    let distances = &scene.grid.distance_mm;
    let ends = scene.whisker_count() * Side::BOTH.len() * distances.len();
    let bar = Progress::over(ends, "ends");
    let at_once = trace::whiskers_at_once(distances.len());
    for group in scene.whisker_groups(at_once) {
        let row = |DetachmentDerivatives { end, by }, mark: Option<PushMark>| {
            let columns = DerivativeColumns { variables, by, first: 0 };
            Marked((end, columns), mark)
        };
        let ends = |sides: &[SweptSide]| {
            let found = detachments_of_sides(resolution, sides, distances, variables);
            bar.inc(sides.len() * distances.len());
            let of_side = |(side, found): (&SweptSide, Vec<DetachmentDerivatives>)| {
                let marks = side.swept.map_or_else(
                    |_| vec![None; found.len()],
                    |SweptWhisker { whisker, pole, .. }| {
                        let ends = found.iter().map(|derivatives| &derivatives.end);
                        PushMark::of_ends(whisker, pole, ends)
                    },
                );
                let rows = found.into_iter().zip(marks);
                rows.map(|(end, mark)| row(end, mark.or(unmarked))).collect()
            };
            sides.iter().zip(found).map(of_side).collect()
        };
        let rows: Vec<(SweepPlace, MarkedEnd)> = trace::sides(&group, distances.len(), ends);
        write(scene, &mut outputs, &rows)?;
        let ends = rows.iter().map(|(_, Marked((end, _), mark))| (end, *mark));
        yielding.extend(yielding_ends(ends, [args.x.axis(), UPWARD]));
        let kinds = rows.iter().map(|(_, Marked((end, _), _))| end.kind);
        let kinds = kinds.filter(|kind| *kind == DetachmentKind::Unresolved);
        unresolved += kinds.count() as u64;
        all += rows.len() as u64;
    }
    bar.finish();
    outputs.finish(plot_title(scene), || {
        let mut plot = scene_curves(scene, resolution, args.x.axis());
        plot.lines.extend(yielding);
        plot
    })?;
    check_resolved(unresolved, all, "ends", "the column `kind`")
}

/// Writes the corner of each side of each whisker.
fn corners(scene: &Scene, mut outputs: OpenOutputs) -> Result<(), Failure> {
    let unmarked = scene.has_yield_strain().then(PushMark::default);
    let bar = Progress::over(scene.whisker_count() * Side::BOTH.len(), "corners");
    for group in scene.whisker_groups(trace::whiskers_at_once(1)) {
        let corner = |SweptSide { swept, side }: &SweptSide| {
            bar.inc(1);
            vec![match swept {
                Ok(SweptWhisker { whisker, pole, .. }) => {
                    let corner = trace::corner(whisker, pole, *side);
                    let mark = PushMark::of_corner(whisker, pole, &corner);
                    Marked(corner, mark.or(unmarked))
                }
                Err(_) => Marked(Corner::without_whisker(*side), unmarked),
            }]
        };
        let corners = |sides: &[SweptSide]| sides.par_iter().map(corner).collect();
        write(scene, &mut outputs, &trace::sides(&group, 1, corners))?;
    }
    bar.finish();
    // Options refuse a plot of corners.
    outputs.finish(String::new(), Plot::default)
}

/// Detachment with its derivatives, and its mark.
type MarkedEnd<'a> = Marked<(Detachment, DerivativeColumns<'a>), PushMark>;

/// Column of a table with the reason why a row of the table of whiskers has no whisker.
#[derive(Serialize)]
struct Reason<'a> {
    no_whisker: Option<&'a str>,
}

/// Writes the rows of some whiskers, with a leading column for each sweep axis. With a table of whiskers, the next column has the reason
/// why there is no whisker.
fn write<R: Serialize>(
    scene: &Scene,
    outputs: &mut OpenOutputs,
    rows: &[(SweepPlace, R)],
) -> Result<(), Failure> {
    if !scene.table.is_empty() {
        outputs.rows(rows.iter().map(|(place, row)| {
            let whisker = place.row().and_then(|row| scene.table.get(row));
            let reason = whisker.and_then(|whisker| whisker.found.as_ref().err());
            let no_whisker = reason.map(String::as_str);
            (place, Reason { no_whisker }, row)
        }))
    } else if scene.is_sweep() {
        outputs.rows(rows)
    } else {
        outputs.rows(rows.iter().map(|(_, row)| row))
    }
}
