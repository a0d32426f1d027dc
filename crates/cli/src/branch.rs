//! Command `whiskmap branch`.

use super::arguments::{column_help, whole};
use super::derivatives::{DerivativeArgs, DerivativeColumns};
use super::failure::Failure;
use super::files::Files;
use super::marks::{MARKS, Marked};
use super::outputs::OutputArgs;
use super::pole::{self, PolesArgs, refuse, title};
use clap::{Args, ValueEnum};
use whiskmap::Side;
use whiskmap::input::each_once;
use whiskmap::render::{
    BranchAxis, DrawnBranch, Ink, PUSH_ANGLE, Plot, branches, column_label, regions,
};
use whiskmap::scene::Scene;
use whiskmap::sensitivity::{Variable, branch};
use whiskmap::trace::{BRANCH_POINTS, BranchPoint};
use whiskmap::yields::YieldMark;

const EXAMPLES: &str = "\
Examples:
  whiskmap branch scenes/cone.toml --distance 15.66 | less
  whiskmap branch scenes/cone.toml --distance 15.66 --side cb --csv branch.csv --plot branch.png
  whiskmap branch scenes/cone.toml --distance 15.66 --side cb --derivatives=taper,push_angle_deg --csv branch.csv
  whiskmap branch scenes/cone.toml --distance 10,13,15.66 --y force_un --plot force.svg
  whiskmap branch scenes/cone.toml --distance 15.66 --y force_un --whole --plot force.pdf --size 85mm

Points are evenly spaced in push angle, contact angle and arclength together, from first touch (mark: first-touch) on. \
Stable states end where they meet the unstable ones (slip-off), or with the tip at the pole (pull-off). Unstable states end \
at their own fold (second-fold) or with the tip at the pole (tip). Lengths in det are whisker lengths.

With --derivatives, columns such as d_force_d_taper follow: exact derivatives of force, moment, energy, arc length and contact \
angle at a fixed push angle. At a fold they are infinite, and the columns are empty.";

#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    after_long_help = column_help(EXAMPLES, &[("Columns", BranchPoint::COLUMNS), MARKS])
)]
pub struct BranchArgs {
    #[command(flatten)]
    poles: PolesArgs,
    /// Side of the whisker that the pole is on
    #[arg(long, value_enum, default_value = "both")]
    side: SideChoice,
    /// Number of points per side and distance
    #[arg(long, value_name = "N", default_value = "200", value_parser = whole(BRANCH_POINTS))]
    points: u32,
    /// Column on the vertical axis of the plot
    #[arg(
        long,
        value_name = "COLUMN",
        value_enum,
        default_value = "arc_length_mm",
        requires = "plot"
    )]
    y: BranchColumn,
    /// Show unstable states whole; otherwise the vertical axis of a force or a moment ends with the stable states
    #[arg(long, requires = "plot")]
    whole: bool,
    #[command(flatten)]
    derivatives: DerivativeArgs,
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
    /// Normal part of the contact force
    ForceUn,
    /// Whole contact force, with friction
    ContactForceUn,
    /// Moment at the base
    BaseMomentNnm,
    /// Angle of the tangent at the contact, from the base's tangent
    ContactAngleDeg,
    /// Arclength from the base to the contact
    ArcLengthMm,
}

impl BranchColumn {
    /// Returns true for a load, which grows far beyond the stable states.
    const fn is_load(self) -> bool {
        matches!(self, Self::ForceUn | Self::ContactForceUn | Self::BaseMomentNnm)
    }

    fn axis(self) -> BranchAxis {
        macro_rules! column {
            ($name:ident) => {
                BranchAxis {
                    label: column_label(stringify!($name)).unwrap_or_default(),
                    value: |point| point.$name,
                }
            };
        }
        match self {
            Self::ForceUn => column!(force_un),
            Self::ContactForceUn => column!(contact_force_un),
            Self::BaseMomentNnm => column!(base_moment_nnm),
            Self::ContactAngleDeg => column!(contact_angle_deg),
            Self::ArcLengthMm => column!(arc_length_mm),
        }
    }
}

const PUSH: BranchAxis = BranchAxis { label: PUSH_ANGLE, value: |point| point.push_angle_deg };

pub fn run(args: &BranchArgs, files: &mut Files) -> Result<(), Failure> {
    let distances = &each_once(&args.poles.distance);
    let (scene, whisker) = pole::read(files, &args.poles.whisker, "branch", distances)?;
    let mut outputs = args.outputs.open(files)?;
    let sides: &[Side] = match args.side {
        SideChoice::Cb => &[Side::Cb],
        SideChoice::Cf => &[Side::Cf],
        SideChoice::Both => &Side::BOTH,
    };
    let variables = args.derivatives.variables(&scene, &[Variable::PushAngleDeg])?;
    let mut states = Vec::new();
    for &distance in distances {
        for side in sides {
            let (pole, count) = (&scene.pole, args.points as usize);
            let followed = branch(&whisker, pole, *side, distance, count, &variables);
            states.extend(followed.map_err(|why| refuse(distance, why))?);
        }
    }
    let points: Vec<BranchPoint> = states.iter().map(|state| state.point).collect();
    outputs.rows(states.into_iter().map(|state| {
        let columns = DerivativeColumns { variables: &variables, by: state.by, first: 1 };
        Marked((state.point, columns), YieldMark::new(&whisker, state.point.peak_strain))
    }))?;
    outputs.finish(title(&scene, distances), || plot(&scene, &points, args))
}

/// Plots branches. Each of several poles has its own colour.
fn plot(scene: &Scene, points: &[BranchPoint], args: &BranchArgs) -> Plot {
    let y = args.y.axis();
    let at_poles: Vec<_> = points.chunk_by(|a, b| a.distance_mm == b.distance_mm).collect();
    let named: Vec<_> = match &at_poles[..] {
        [only] => vec![(Ink::Black, "stable".to_owned(), *only)],
        poles => {
            let name = |points: &[BranchPoint]| format!("{} mm, stable", points[0].distance_mm);
            let poles = poles.iter().enumerate();
            poles
                .map(|(index, points)| {
                    (Ink::of_series(index, at_poles.len()), name(points), *points)
                })
                .collect()
        }
    };
    let drawn = named.iter().map(|(ink, name, points)| DrawnBranch { points, ink: *ink, name });
    let stable = points.iter().filter(|point| point.stable).map(y.value);
    let ends = stable.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [value.min(low), value.max(high)]
    });
    Plot {
        regions: Some(regions(scene.is_straight())),
        y_range: (args.y.is_load() && !args.whole).then_some(ends),
        ..branches("", &drawn.collect::<Vec<_>>(), [PUSH, y])
    }
}
