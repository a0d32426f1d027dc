//! Command `whiskmap design`.

use super::arguments::{angle, parameter, side};
use super::failure::Failure;
use super::files::Files;
use super::outputs::{PlotArgs, open};
use super::pole::{self, PoleArgs, title};
use clap::Args;
use std::io::{self, Write};
use whiskmap::design::{self, Design, DesignError, DesignTarget};
use whiskmap::render::designs;
use whiskmap::rod::Side;
use whiskmap::scene::{Parameter, digits};
use whiskmap::trace::DetachmentKind;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap design scenes/robot.toml --distance 60 --side cb --slip-off 30deg --for taper --plot taper.svg
  whiskmap design scenes/robot.toml --distance 60 --slip-off -50deg --for parabola_per_mm
  whiskmap design scenes/cylinder.toml --distance 19 --pull-off 40deg --for length_mm

Each line is one value that makes the whisker detach at that angle, with a relative error of 1e-9; where two solutions nearly \
merge, with the root of the rounding error. The search covers the whole range that the scene accepts with 128 values; in a \
wide range, half of them are spaced logarithmically. A pair of solutions between two of these values is found if the push \
angle turns back only once there. Without any solution the exit code is 1, and standard error gives the possible push \
angles. The scene's grid is ignored.")]
pub struct DesignArgs {
    #[command(flatten)]
    pole: PoleArgs,
    /// Side of the whisker that the pole is on [default: by the sign of the angle]
    #[arg(long, value_parser = side())]
    side: Option<Side>,
    #[command(flatten)]
    end: EndArgs,
    /// Parameter of the scene to vary
    #[arg(long = "for", value_name = "NAME", value_parser = parameter())]
    parameter: Parameter,
    #[command(flatten)]
    picture: PlotArgs,
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct EndArgs {
    /// Push angle of the slip-off, such as 30deg, 30°, 30 or 0.5rad: positive CB, negative CF
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = push)]
    slip_off: Option<f64>,
    /// Push angle of the pull-off
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = push)]
    pull_off: Option<f64>,
}

fn push(text: &str) -> Result<f64, String> {
    let angle = angle(text)?;
    if angle.abs() <= 360.0 && angle != 0.0 {
        Ok(angle)
    } else {
        Err("must be between -360deg and 360deg, and not 0".to_owned())
    }
}

impl DesignArgs {
    fn target(&self) -> Result<DesignTarget, Failure> {
        let (option, kind, push) = match (self.end.slip_off, self.end.pull_off) {
            (Some(push), _) => ("--slip-off", DetachmentKind::SlipOff, Some(push)),
            (None, push) => ("--pull-off", DetachmentKind::PullOff, push),
        };
        let push_angle_deg = push.unwrap_or(f64::NAN);
        let side = Side::of_push(push_angle_deg);
        let other = match (self.side, side) {
            (Some(Side::Cf), Side::Cb) => Some("--side cf must be negative"),
            (Some(Side::Cb), Side::Cf) => Some("--side cb must be positive"),
            _ => None,
        };
        if let Some(must) = other {
            let push = digits(push_angle_deg);
            let why = format!("{option} {push} deg: a push angle of {must}");
            return Err(Failure::Input(why));
        }
        Ok(DesignTarget {
            distance_mm: self.pole.distance,
            side,
            kind,
            push_angle_deg,
        })
    }
}

pub fn run(args: &DesignArgs, files: &mut Files) -> Result<(), Failure> {
    let target = args.target()?;
    let (path, distance) = (&args.pole.scene, args.pole.distance);
    let (scene, _) = pole::read(files, path, "design", &[distance])?;
    let (_, picture) = open(files, "--plot", None, &args.picture)?;
    let found = design::design(&scene, args.parameter, &target);
    let found = found.map_err(|why| match why {
        DesignError::Sweep(_) => Failure::Input(why.to_string()),
        DesignError::Distance(why) => Failure::Scene(why),
        _ => Failure::Input(format!("{}: --for {why}", path.display())),
    })?;
    if let Some(picture) = picture {
        let plot = designs(args.parameter, &target, &found);
        picture.plot(title(&scene, &[distance]), plot)?;
    }
    if found.values.is_empty() {
        let why = unreached(args.parameter, &target, &found);
        return Err(Failure::NoValue(why));
    }
    let mut out = io::stdout().lock();
    for value in &found.values {
        writeln!(out, "{}", digits(*value))?;
    }
    Ok(())
}

/// Returns the message for a target without a solution, with the push angles that are possible.
fn unreached(parameter: Parameter, target: &DesignTarget, design: &Design) -> String {
    let name = parameter.name();
    let [from, to] = design.range.map(digits);
    let ways = [
        (DetachmentKind::SlipOff, "slips off"),
        (DetachmentKind::PullOff, "is pulled off"),
    ];
    let reached = ways.iter().filter_map(|(kind, way)| {
        let [low, high] = design.reached_deg(*kind)?;
        Some(if high - low < 1e-6 {
            format!("it {way} at {low:.6} deg for every value")
        } else {
            format!("it {way} between {low:.6} and {high:.6} deg")
        })
    });
    let reached: Vec<_> = reached.collect();
    let reached = match reached.join(", and ") {
        nothing if nothing.is_empty() => "it does not reach the pole".to_owned(),
        reached => reached,
    };
    let wanted = match target.kind {
        DetachmentKind::PullOff => "pulls the whisker off",
        _ => "makes the whisker slip off",
    };
    let push = digits(target.push_angle_deg);
    format!("no {name} between {from} and {to} {wanted} at {push} deg: {reached}")
}
