//! Command `whiskmap branch`.

use super::arguments::{column_help, whole};
use super::failure::Failure;
use super::files::Files;
use super::outputs::OutputArgs;
use super::pole::{self, PolesArgs, refuse, title};
use clap::{Args, ValueEnum};
use whiskmap::render::{BranchAxis, Ink, Note, Plot, branches};
use whiskmap::rod::Side;
use whiskmap::trace::{Branch, BranchMark, BranchPoint};

const EXAMPLES: &str = "\
Examples:
  whiskmap branch scenes/cone.toml --distance 15.66 | less
  whiskmap branch scenes/cone.toml --distance 15.66 --side cb --csv branch.csv --plot branch.png
  whiskmap branch scenes/cone.toml --distance 10,13,15.66 --y force_un --plot force.svg

Points are evenly spaced in push angle, contact angle and arclength together, from first touch (mark: first-touch) on. \
Stable states end where they meet the unstable ones (slip-off), or with the tip at the pole (pull-off). Unstable states end \
at their own fold (second-fold) or with the tip at the pole (tip). Lengths in det are whisker lengths.";

#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", BranchPoint::COLUMNS)])
)]
pub struct BranchArgs {
    #[command(flatten)]
    poles: PolesArgs,
    /// Side of the whisker that the pole is on
    #[arg(long, value_enum, default_value = "both")]
    side: SideChoice,
    /// Number of points per side and distance
    #[arg(long, value_name = "N", default_value = "200", value_parser = whole(3..=1_000_000))]
    points: u32,
    /// Column on the vertical axis of the plot
    #[arg(
        long,
        value_name = "COLUMN",
        value_enum,
        default_value = "arc_length_mm"
    )]
    y: BranchColumn,
    #[command(flatten)]
    outputs: OutputArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SideChoice {
    /// Concave backward: the pole is on the convex side
    Cb,
    /// Concave forward: the pole is on the concave side
    Cf,
    /// CF, then CB
    Both,
}

/// Columns that a plot can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
enum BranchColumn {
    /// Size of the force
    ForceUn,
    /// Moment at the base
    BaseMomentNnm,
    /// Angle of the tangent at the contact, from the base's tangent
    ContactAngleDeg,
    /// Arclength from the base to the contact
    ArcLengthMm,
}

impl BranchColumn {
    fn axis(self) -> BranchAxis {
        match self {
            Self::ForceUn => BranchAxis {
                label: "force (\u{b5}N)",
                value: |point| point.force_un,
            },
            Self::BaseMomentNnm => BranchAxis {
                label: "moment at the base (nN m)",
                value: |point| point.base_moment_nnm,
            },
            Self::ContactAngleDeg => BranchAxis {
                label: "contact angle from the base's tangent (deg)",
                value: |point| point.contact_angle_deg,
            },
            Self::ArcLengthMm => BranchAxis {
                label: "arc length of contact (mm)",
                value: |point| point.arc_length_mm,
            },
        }
    }
}

const PUSH: BranchAxis = BranchAxis {
    label: "push angle (deg)   CF < 0 < CB",
    value: |point| point.push_angle_deg,
};

pub fn run(args: &BranchArgs, files: &mut Files) -> Result<(), Failure> {
    let distances = &args.poles.distance;
    let (scene, whisker) = pole::read(files, &args.poles.scene, "branch", distances)?;
    let mut outputs = args.outputs.open(files)?;
    let sides: &[Side] = match args.side {
        SideChoice::Cb => &[Side::Cb],
        SideChoice::Cf => &[Side::Cf],
        SideChoice::Both => &Side::BOTH,
    };
    let mut points = Vec::new();
    for &distance in distances {
        for side in sides {
            let branch = Branch::new(&whisker, &scene.pole, *side, distance);
            let followed = branch.and_then(|branch| branch.points(args.points as usize));
            points.extend(followed.map_err(|why| refuse(distance, why))?);
        }
    }
    outputs.rows(&points)?;
    outputs.finish(title(&scene, distances), || {
        plot(&points, args.y.axis(), distances.len() > 1)
    })
}

/// Plots branches; with several poles, labels each detachment with its distance.
fn plot(points: &[BranchPoint], y: BranchAxis, has_distances: bool) -> Plot {
    let mut plot = branches("", &[(Ink::Black, points)], [PUSH, y]);
    let is_end = |point: &&BranchPoint| {
        matches!(point.mark, Some(BranchMark::SlipOff | BranchMark::PullOff))
    };
    let ends = points.iter().filter(is_end).filter(|_| has_distances);
    plot.notes.extend(ends.map(|end| {
        let at = [end.push_angle_deg, (y.value)(end)];
        Note::text(at, format!("{} mm", end.distance_mm))
    }));
    plot
}
