//! `whiskmap branch`.

use super::columns;
use super::failure::Failure;
use super::numbers::whole;
use super::outputs::Outputs;
use super::pole::Pole;
use clap::{Args, ValueEnum};
use whiskmap::render::{BranchAxis, branches};
use whiskmap::rod::Side;
use whiskmap::trace::{Branch, BranchPoint};

const EXAMPLES: &str = "\
Examples:
  whiskmap branch scenes/cone.toml --distance 15.66 | less
  whiskmap branch scenes/cone.toml --distance 15.66 --side cb --csv branch.csv --plot branch.png

Points are evenly spaced in push angle, contact angle and arclength together, from first touch (mark: touch) \
through the fold (fold), where stable and unstable states meet, to the tip (tip) or the end of the unstable states \
(second-fold). Lengths in det are whisker lengths.";

/// Options of `branch`.
#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = columns::help(EXAMPLES, &[("Columns", BranchPoint::COLUMNS)])
)]
pub struct Options {
    #[command(flatten)]
    pole: Pole,
    /// Side of the whisker that the pole is on
    #[arg(long, value_enum, default_value = "both")]
    side: Choice,
    /// Points per side
    #[arg(long, value_name = "N", default_value = "200", value_parser = whole(3..=1_000_000))]
    points: u32,
    #[command(flatten)]
    outputs: Outputs,
}

/// Sides by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Choice {
    /// Concave backward: the pole is on the convex side
    Cb,
    /// Concave forward: the pole is on the concave side
    Cf,
    /// CF, then CB
    Both,
}

/// Runs `branch`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let (scene, whisker) = options.pole.read("branch")?;
    let mut outputs = options.outputs.open()?;
    let sides: &[Side] = match options.side {
        Choice::Cb => &[Side::Cb],
        Choice::Cf => &[Side::Cf],
        Choice::Both => &Side::BOTH,
    };
    let mut points = Vec::new();
    for side in sides {
        let branch = Branch::new(&whisker, &scene.pole, *side, options.pole.distance);
        let followed = branch.and_then(|branch| branch.points(options.points as usize));
        points.extend(followed.map_err(|why| options.pole.refuse(why))?);
    }
    outputs.rows(&points)?;
    outputs.finish(options.pole.title(&scene), || branches("", &points, AXES))
}

const AXES: [BranchAxis; 2] = [
    BranchAxis {
        label: "push angle (deg)   CF < 0 < CB",
        value: |point| point.push_angle_deg,
    },
    BranchAxis {
        label: "arc length of contact (mm)",
        value: |point| point.arc_length_mm,
    },
];
