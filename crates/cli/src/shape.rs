//! Command `whiskmap shape`.

use super::arguments::{angle, column_help, side, whole};
use super::failure::Failure;
use super::files::Files;
use super::marks::{MARKS, Marked};
use super::outputs::{OutputArgs, write_table};
use super::pole::{self, PoleArgs, refuse, title};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use whiskmap::Side;
use whiskmap::render::{Chart, Dot, DrawnShape, Ink, Line, Stroke, shapes};
use whiskmap::scene::digits;
use whiskmap::trace::{Branch, BranchPoint, NoState, SHAPE_POINTS, ShapePoint};
use whiskmap::yields::YieldMark;

const EXAMPLES: &str = "\
Examples:
  whiskmap shape scenes/cone.toml --distance 15.66 --push-angle 10 --plot shape.svg
  whiskmap shape scenes/cone.toml --distance 15.66 --push-angle 10 --branch unstable --csv shape.csv
  whiskmap shape scenes/cone.toml --distance 15.66 --push-angle -20
  whiskmap shape scenes/robot.toml --distance 60 --push-angle 20 --state loads.csv --csv shape.csv --units mN,Nmm

The origin is at the base, and the first axis is along the base's tangent at first touch. Since then, the base has turned by \
the push angle, and the pole is fixed.";

#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", ShapePoint::COLUMNS), MARKS])
)]
pub struct ShapeArgs {
    #[command(flatten)]
    pole: PoleArgs,
    /// Rotation of the base since first touch, in degrees or with a unit, such as 0.5rad: positive CB, negative CF
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = angle)]
    push_angle: f64,
    // Unstable states reach push angles of the other sign.
    /// Side of the whisker that the pole is on [default: by the sign of the push angle]
    #[arg(long, value_parser = side())]
    side: Option<Side>,
    /// State below the fold: stable or unstable
    #[arg(long, value_enum, default_value = "stable")]
    branch: BranchPart,
    /// Number of points along the whisker, besides the contact
    #[arg(long, value_name = "N", default_value = "200", value_parser = whole(SHAPE_POINTS))]
    points: u32,
    /// Write the state to FILE, as one row with the columns of `branch`: loads, energy, largest strain; - is standard output
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    #[command(flatten)]
    outputs: OutputArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BranchPart {
    /// State that a push from first touch reaches
    Stable,
    /// State that a push must not cross
    Unstable,
}

pub fn run(args: &ShapeArgs, files: &mut Files) -> Result<(), Failure> {
    let distance = args.pole.distance;
    let (scene, whisker) = pole::read(files, &args.pole.whisker, "shape", &[distance])?;
    let push_deg = args.push_angle;
    if !(-360.0..=360.0).contains(&push_deg) {
        let push = digits(push_deg);
        let why = format!("--push-angle {push} deg: must be between -360 deg and 360 deg");
        return Err(Failure::Input(why));
    }
    let mut outputs = args.outputs.open(files)?;
    let state = args.state.as_deref();
    let state_table = args.outputs.table(files, "--state", state)?;
    let side = args.side.unwrap_or(Side::of_push(push_deg));
    let stable = args.branch == BranchPart::Stable;
    let refused = |why| match why {
        NoState::OutOfReach { .. } | NoState::BeyondTurns | NoState::Failed { .. } => {
            refuse(distance, why)
        }
        NoState::SlippedOff { at_deg } | NoState::PulledOff { at_deg }
            if (at_deg - push_deg).abs() < 1e-8 =>
        {
            let before = (push_deg - at_deg).abs();
            let why = format!("{why}, {before:.0e} deg earlier");
            Failure::Input(format!("--push-angle {push_deg} deg: {why}"))
        }
        _ => Failure::Input(format!("--push-angle {push_deg} deg: {why}")),
    };
    let pushed = (&whisker, &scene.pole, side);
    let found = Branch::at_push(pushed, distance, push_deg.to_radians(), stable);
    let (branch, state) = found.map_err(refused)?;
    let count = args.points as usize;
    let shape = branch.shape(&state, count);
    let points = shape.points.iter();
    outputs.rows(points.map(|point| Marked(point, YieldMark::new(&whisker, point.strain))))?;
    let mark = YieldMark::new(&whisker, shape.state.peak_strain);
    let state_file = write_table(state_table, BranchPoint::COLUMNS, [Marked(&shape.state, mark)])?;
    let (stroke, name) =
        if stable { (Stroke::Solid, "stable") } else { (Stroke::Dashed, "unstable") };
    let drawn =
        DrawnShape { shape, ink: Ink::Black, stroke, name: format!("{name}, {push_deg} deg") };
    let plot = || {
        let mut plot = shapes("", &[drawn]);
        let at_rest = branch.at_rest(count);
        let at_rest = Line::new(at_rest, Ink::Grey, Stroke::Solid).named("first touch");
        plot.lines.insert(0, at_rest);
        let traced = scene.traced().into_iter();
        let points = traced.flat_map(|shape| shape.points_at_rest_mm(whisker.length_mm));
        plot.dots.extend(points.map(|at| Dot {
            at,
            ink: Ink::Grey,
            open: true,
            name: Some("traced points".to_owned()),
        }));
        Chart::single(title(&scene, &[distance]), plot)
    };
    outputs.finish_chart(plot, state_file)
}
