//! `whiskmap design`.

use super::failure::Failure;
use super::files::Files;
use super::numbers::angle;
use super::outputs::open;
use super::parameter::parameter;
use super::pole::{self, Pole, title};
use super::side::OneSide;
use clap::Args;
use std::io::{self, Write};
use std::path::PathBuf;
use whiskmap::design::{self, Design, NoDesign, Target};
use whiskmap::render::designs;
use whiskmap::rod::Side;
use whiskmap::scene::{Parameter, digits};
use whiskmap::trace::DetachmentKind;

const EXAMPLES: &str = "\
Examples:
  whiskmap design scenes/robot.toml --distance 60 --side cb --slip-off 30deg --for taper --plot taper.svg
  whiskmap design scenes/robot.toml --distance 60 --slip-off -50deg --for parabola_per_mm
  whiskmap design scenes/cylinder.toml --distance 19 --pull-off 40deg --for length_mm

Every value that makes the whisker detach so, one a line, to 1e-9 of itself; where two solutions nearly meet, to the root of \
the rounding. All that the scene accepts is tried, in 128 places (in a wide range half of them even in the logarithm); a \
pair of solutions between two of them is found where the push angle turns back only once there. Without any solution the \
exit code is 1, and standard error says what can be reached. The scene's grid does not matter.";

/// Options of `design`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    #[command(flatten)]
    pole: Pole,
    /// Side of the whisker that the pole is on [default: that of the angle's sign]
    #[arg(long, value_enum)]
    side: Option<OneSide>,
    #[command(flatten)]
    end: End,
    /// Number of the scene to choose
    #[arg(long = "for", value_name = "NAME", value_parser = parameter())]
    parameter: Parameter,
    /// Picture of the push angle over that number to write, PNG or SVG by its ending
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

/// How the push is to end.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct End {
    /// Push angle at which it slips off, such as 30deg, 30°, 30 or 0.5rad: positive CB, negative CF
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = push)]
    slip_off: Option<f64>,
    /// Push angle at which it is pulled off
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

impl Options {
    /// What is asked for.
    fn target(&self) -> Result<Target, Failure> {
        let (option, kind, push_angle_deg) = match (self.end.slip_off, self.end.pull_off) {
            (Some(push), _) => ("--slip-off", DetachmentKind::SlipOff, push),
            (None, push) => (
                "--pull-off",
                DetachmentKind::PullOff,
                push.unwrap_or(f64::NAN),
            ),
        };
        let side = Side::of_push(push_angle_deg);
        let other = match (self.side, side) {
            (Some(OneSide::Cf), Side::Cb) => Some("--side cf must be negative"),
            (Some(OneSide::Cb), Side::Cf) => Some("--side cb must be positive"),
            _ => None,
        };
        if let Some(must) = other {
            return Err(Failure::Input(format!(
                "{option} {} deg: a push angle of {must}",
                digits(push_angle_deg)
            )));
        }
        Ok(Target {
            distance_mm: self.pole.distance,
            side,
            kind,
            push_angle_deg,
        })
    }
}

/// Runs `design`.
pub fn run(options: &Options, files: &mut Files) -> Result<(), Failure> {
    let target = options.target()?;
    let (path, distance) = (&options.pole.scene, options.pole.distance);
    let (scene, _) = pole::read(files, path, "design", &[distance])?;
    let (_, picture) = open(files, "--plot", None, options.plot.as_deref())?;
    let found = design::design(&scene, options.parameter, &target);
    let found = found.map_err(|why| match why {
        NoDesign::Sweep(_) => Failure::Input(why.to_string()),
        NoDesign::Lacking { .. } | NoDesign::Fixed { .. } => {
            let scene = options.pole.scene.display();
            Failure::Input(format!("{scene}: --for {why}"))
        }
        NoDesign::Distance(why) => Failure::Scene(why),
    })?;
    if let Some(picture) = picture {
        let plot = designs(options.parameter, &target, &found);
        picture.save(title(&scene, &[options.pole.distance]), plot)?;
    }
    if found.values.is_empty() {
        return Err(Failure::NoValue(reached(
            options.parameter,
            &target,
            &found,
        )));
    }
    let mut out = io::stdout().lock();
    for value in &found.values {
        writeln!(out, "{}", digits(*value))?;
    }
    Ok(())
}

/// What can be reached where nothing does what is asked for.
fn reached(parameter: Parameter, target: &Target, design: &Design) -> String {
    let name = parameter.name();
    let [from, to] = design.range.map(digits);
    let ways = [
        (DetachmentKind::SlipOff, "slips off"),
        (DetachmentKind::PullOff, "is pulled off"),
    ];
    let reached = ways.iter().filter_map(|(kind, way)| {
        let [low, high] = design.reached_deg(*kind)?;
        Some(if high - low < 1e-6 {
            format!("it {way} at {low:.6} deg whatever the value")
        } else {
            format!("it {way} between {low:.6} and {high:.6} deg")
        })
    });
    let reached: Vec<_> = reached.collect();
    let reached = match reached.join(", and ") {
        nothing if nothing.is_empty() => "it does not reach the pole".to_owned(),
        reached => reached,
    };
    let asked = match target.kind {
        DetachmentKind::PullOff => "pulls the whisker off",
        _ => "makes the whisker slip off",
    };
    let push = digits(target.push_angle_deg);
    format!("no {name} between {from} and {to} {asked} at {push} deg: {reached}")
}
