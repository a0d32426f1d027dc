//! `whiskmap shape`.

use super::columns;
use super::failure::{Failure, say};
use super::files::Files;
use super::numbers::{angle, whole};
use super::outputs::Outputs;
use super::pole::{self, Pole, refuse, title};
use super::side::OneSide;
use clap::{Args, ValueEnum};
use whiskmap::classify::Sliding;
use whiskmap::render::{Drawn, Ink, Line, Stroke, shapes};
use whiskmap::rod::Side;
use whiskmap::scene::digits;
use whiskmap::trace::{Branch, NoState, Shape, ShapePoint};

const EXAMPLES: &str = "\
Examples:
  whiskmap shape scenes/cone.toml --distance 15.66 --push-angle 10 --plot shape.svg
  whiskmap shape scenes/cone.toml --distance 15.66 --push-angle 10 --branch unstable --csv shape.csv
  whiskmap shape scenes/cone.toml --distance 15.66 --push-angle -20

The origin is at the base and the first axis along the base's tangent at first touch. Since then the base has \
turned by the push angle, and the pole has stayed where it is.";

/// Options of `shape`.
#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = columns::help(EXAMPLES, &[("Columns", ShapePoint::COLUMNS)])
)]
pub struct Options {
    #[command(flatten)]
    pole: Pole,
    /// Rotation of the base since first touch, in degrees or with a unit, such as 0.5rad: positive CB, negative CF
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = angle)]
    push_angle: f64,
    // Unstable states reach push angles of the other sign.
    /// Side of the whisker that the pole is on [default: that of the push angle's sign]
    #[arg(long, value_enum)]
    side: Option<OneSide>,
    /// Which of the two states there are below the fold
    #[arg(long, value_enum, default_value = "stable")]
    branch: Part,
    /// Places along the whisker, besides the contact
    #[arg(long, value_name = "N", default_value = "200", value_parser = whole(2..=1_000_000))]
    points: u32,
    #[command(flatten)]
    outputs: Outputs,
}

/// Parts of a branch by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Part {
    /// What a push from first touch leads to
    Stable,
    /// What it must not cross
    Unstable,
}

/// Runs `shape`.
pub fn run(options: &Options, files: &mut Files) -> Result<(), Failure> {
    let (path, distance) = (&options.pole.scene, options.pole.distance);
    let (scene, whisker) = pole::read(files, path, "shape", &[distance])?;
    let push_deg = options.push_angle;
    if !(-360.0..=360.0).contains(&push_deg) {
        return Err(Failure::Input(format!(
            "--push-angle {} deg: must be between -360 deg and 360 deg",
            digits(push_deg)
        )));
    }
    let mut outputs = options.outputs.open(files)?;
    let side = options.side.map_or(Side::of_push(push_deg), Side::from);
    let stable = options.branch == Part::Stable;
    let refused = |why| match why {
        NoState::OutOfReach { .. } | NoState::Lost { .. } => refuse(options.pole.distance, why),
        _ => Failure::Input(format!("--push-angle {push_deg} deg: {why}")),
    };
    let branch =
        Branch::new(&whisker, &scene.pole, side, options.pole.distance).map_err(refused)?;
    let state = branch
        .state(push_deg.to_radians(), stable)
        .map_err(refused)?;
    let count = options.points as usize;
    let shape = Shape::new(&branch, &state, count);
    let how = match shape.sliding {
        Some(Sliding::Base) => Some("slides toward the base"),
        Some(Sliding::Sticks) => Some("sticks where it was dragged before"),
        Some(Sliding::Tip) | None => None,
    };
    if let Some(how) = how {
        say(&format!(
            "warning: the contact {how}, and friction is computed as of one that slides toward the tip"
        ));
    }
    outputs.rows(&shape.points)?;
    let (stroke, name) = if stable {
        (Stroke::Solid, "stable")
    } else {
        (Stroke::Dashed, "unstable")
    };
    let drawn = Drawn {
        shape,
        ink: Ink::Black,
        stroke,
        name: format!("{name}, {push_deg} deg"),
    };
    outputs.finish(title(&scene, &[options.pole.distance]), || {
        let mut plot = shapes("", &[drawn]);
        let at_rest = Shape::at_rest(&branch, count);
        let at_rest = Line::new(at_rest, Ink::Grey, Stroke::Solid, "first touch");
        plot.lines.insert(0, at_rest);
        plot
    })
}
