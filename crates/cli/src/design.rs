//! Command `whiskmap design`.

use super::arguments::{angle, parameter, side};
use super::failure::Failure;
use super::files::Files;
use super::outputs::{PlotArgs, open, write};
use super::pole::{self, PoleArgs, title};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use whiskmap::Side;
use whiskmap::design::{self, Design, DesignError, DesignGoal, DesignTarget};
use whiskmap::input::Quantity;
use whiskmap::render::designs;
use whiskmap::scene::{Parameter, Scene, digits, rounded};
use whiskmap::terminal::StandardOutput;
use whiskmap::trace::DetachmentKind;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap design scenes/robot.toml --distance 60 --side cb --slip-off 30deg --for taper --plot taper.svg
  whiskmap design scenes/robot.toml --distance 60 --slip-off -50deg --for parabola_per_mm
  whiskmap design scenes/robot.toml --distance 60 --side cb --max-force 60mN --for base_radius_um -o better.toml
  whiskmap design scenes/robot.toml --distance 60 --side cb --max-strain 0.01 --for taper
  whiskmap design scenes/cylinder.toml --distance 19 --pull-off 40deg --for length_mm

Each line is one value with which a push reaches the target. --max-force, --max-moment and --max-strain are the largest values of \
the push, from first touch until the whisker detaches in either way: of the contact force, the moment at the base, and the \
bending strain at the surface of the whisker.

Values for push angles have 10 significant digits and a relative error of 1e-9; where two solutions nearly merge, that of the \
root of the rounding error. Values for loads have 6 digits. The search covers the whole range that the scene accepts with 128 \
values; in a wide range, half of them are spaced logarithmically. A pair of solutions between two of these values is found if \
the target's quantity turns back only once there. Without any solution the exit code is 1, and standard error gives what is \
possible. The scene's grid is ignored.")]
pub struct DesignArgs {
    #[command(flatten)]
    pole: PoleArgs,
    /// Side of the whisker that the pole is on [default: by the sign of the angle]
    #[arg(long, value_parser = side())]
    side: Option<Side>,
    #[command(flatten)]
    goal: GoalArgs,
    /// Parameter of the scene to vary
    #[arg(long = "for", value_name = "NAME", value_parser = parameter())]
    parameter: Parameter,
    /// Write the scene with the value to BETTER.toml; with several values, the one nearest to the scene's own; - is standard output
    #[arg(short, long, value_name = "BETTER.toml")]
    output: Option<PathBuf>,
    #[command(flatten)]
    picture: PlotArgs,
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct GoalArgs {
    /// Push angle of the slip-off, such as 30deg, 30°, 30 or 0.5rad: positive CB, negative CF
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = push)]
    slip_off: Option<GoalValue>,
    /// Push angle of the pull-off
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = push)]
    pull_off: Option<GoalValue>,
    /// Largest contact force of the push, such as 60mN, 60000uN or 60000
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true, requires = "side", value_parser = load(Quantity::ForceUn))]
    max_force: Option<GoalValue>,
    /// Largest moment at the base in the push, such as 250nNm, 250 or 0.25uNm
    #[arg(long, value_name = "MOMENT", allow_hyphen_values = true, requires = "side", value_parser = load(Quantity::MomentNnm))]
    max_moment: Option<GoalValue>,
    /// Largest bending strain of the push, such as 0.01
    #[arg(long, value_name = "STRAIN", allow_hyphen_values = true, requires = "side", value_parser = load(Quantity::Number))]
    max_strain: Option<GoalValue>,
}

/// Value of a goal in the goal's own unit, with the unit of the option, in which messages give it back.
#[derive(Clone, Copy, Debug)]
struct GoalValue {
    value: f64,
    unit: &'static str,
}

impl GoalValue {
    /// Returns `value` in the unit of the option, with the unit, and with at most `most` significant digits.
    fn text(self, quantity: Quantity, value: f64, most: usize) -> String {
        let converted = quantity.convert(value, self.unit).unwrap_or(value);
        let number = digits(rounded(converted, most));
        match self.unit {
            "" => number,
            unit => format!("{number} {unit}"),
        }
    }
}

fn push(text: &str) -> Result<GoalValue, String> {
    let (value, unit) = Quantity::AngleDeg.parse_with_unit(text)?;
    if value.abs() <= 360.0 && value != 0.0 {
        Ok(GoalValue { value, unit })
    } else {
        Err("must be between -360deg and 360deg, and not 0".to_owned())
    }
}

/// Returns a parser of a load of this quantity.
fn load(quantity: Quantity) -> impl Fn(&str) -> Result<GoalValue, String> + Clone {
    move |text| match quantity.parse_with_unit(text)? {
        (value, unit) if value > 0.0 => Ok(GoalValue { value, unit }),
        _ => Err("must be more than 0".to_owned()),
    }
}

impl DesignArgs {
    fn target(&self) -> Result<DesignTarget, Failure> {
        let goals = [
            ("--slip-off", DesignGoal::SlipOff, self.goal.slip_off),
            ("--pull-off", DesignGoal::PullOff, self.goal.pull_off),
            ("--max-force", DesignGoal::MaxForce, self.goal.max_force),
            ("--max-moment", DesignGoal::MaxMoment, self.goal.max_moment),
            ("--max-strain", DesignGoal::MaxStrain, self.goal.max_strain),
        ];
        let mut given = goals
            .iter()
            .filter_map(|(option, goal, value)| Some((*option, *goal, (*value)?)));
        let (option, goal, value) = given.next().unwrap_or(("", DesignGoal::SlipOff, f64::NAN));
        let side = match (goal.kind(), self.side) {
            (None, Some(side)) => side,
            _ => Side::of_push(value),
        };
        let other = match (self.side, side) {
            (Some(Side::Cf), Side::Cb) => Some("--side cf must be negative"),
            (Some(Side::Cb), Side::Cf) => Some("--side cb must be positive"),
            _ => None,
        };
        if let Some(must) = other {
            let push = digits(value);
            let why = format!("{option} {push} deg: a push angle of {must}");
            return Err(Failure::Input(why));
        }
        Ok(DesignTarget {
            distance_mm: self.pole.distance,
            side,
            goal,
            value,
        })
    }
}

pub fn run(args: &DesignArgs, files: &mut Files) -> Result<(), Failure> {
    let target = args.target()?;
    let (path, distance) = (&args.pole.scene, args.pole.distance);
    let (scene, _) = pole::read(files, path, "design", &[distance])?;
    let output = args.output.as_deref();
    let (better, picture) = open(files, "--output", output, &args.picture)?;
    let refused = |why| match why {
        DesignError::Sweep(_) => Failure::Input(why.to_string()),
        DesignError::Distance(why) => Failure::Scene(why),
        _ => Failure::Input(format!("{}: --for {why}", path.display())),
    };
    let found = design::design(&scene, args.parameter, &target).map_err(refused)?;
    if let Some(picture) = picture {
        let shown = found.shown();
        let near = Design {
            range: shown,
            ends: design::ends_between(&scene, args.parameter, &target, shown).map_err(refused)?,
            values: found.values.clone(),
        };
        let plot = designs(args.parameter, &target, &near);
        picture.plot(title(&scene, &[distance]), plot)?;
    }
    if found.values.is_empty() {
        let why = unreached(args.parameter, &target, &found);
        return Err(Failure::NoValue(why));
    }
    let digits_of_goal = target.goal.digits();
    let values = found.values.iter();
    let values = values.map(|value| written(&scene, args.parameter, *value, digits_of_goal));
    let values: Vec<f64> = values.collect();
    if let Some(output) = better {
        let own = args.parameter.value(&scene).unwrap_or(f64::NAN);
        let apart = |value: &f64| (value - own).abs();
        let nearest = values.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let changes = nearest.map(|value| match args.parameter {
            // The scene gives the radius, which has no more digits than the taper.
            Parameter::Taper => {
                let radius = scene.whisker.base_radius_um * (1.0 - value);
                let radius = written(&scene, Parameter::TipRadiusUm, radius, digits_of_goal);
                (Parameter::TipRadiusUm, radius)
            }
            own => (own, *value),
        });
        let is_stdout = output.is_stdout();
        write(output, scene.to_toml_with(changes.as_slice())?.as_bytes())?;
        if is_stdout {
            return Ok(());
        }
    }
    let mut out = StandardOutput::open();
    for value in values {
        writeln!(out, "{}", digits(value))?;
    }
    Ok(())
}

/// Returns a solution with its significant digits, or with all digits if the scene refuses it otherwise, next to a limit.
fn written(scene: &Scene, parameter: Parameter, value: f64, digits: usize) -> f64 {
    let short = rounded(value, digits);
    match scene.with(parameter, short) {
        Ok(_) => short,
        Err(_) => value,
    }
}

/// Returns the message for a target without a solution, with what is possible.
fn unreached(parameter: Parameter, target: &DesignTarget, design: &Design) -> String {
    let name = parameter.name();
    let [from, to] = design.range.map(digits);
    let goal = target.goal;
    let unit = goal
        .quantity()
        .unit()
        .map_or_else(String::new, |unit| format!(" {unit}"));
    let wanted = match goal.kind() {
        Some(DetachmentKind::PullOff) => "pulls the whisker off at".to_owned(),
        Some(_) => "makes the whisker slip off at".to_owned(),
        None => format!("gives a {} of", goal.title()),
    };
    let number = |value: f64| match goal.kind() {
        Some(_) => format!("{value:.6}"),
        None => digits(rounded(value, goal.digits())),
    };
    let ways = [
        (DetachmentKind::SlipOff, "slips off"),
        (DetachmentKind::PullOff, "is pulled off"),
    ];
    let reached = ways.iter().filter_map(|(kind, way)| {
        let [low, high] = design.reached(*kind)?.map(number);
        let between = match goal.kind() {
            Some(_) if low == high => format!("at {low}{unit} for every value"),
            Some(_) => format!("between {low} and {high}{unit}"),
            None if low == high => format!("with {low}{unit} for every value"),
            None => format!("with {low} to {high}{unit}"),
        };
        Some(format!("it {way} {between}"))
    });
    let reached: Vec<_> = reached.collect();
    let reached = match reached.join(", and ") {
        nothing if nothing.is_empty() => "it does not reach the pole".to_owned(),
        reached => reached,
    };
    let value = digits(target.value);
    format!("no {name} between {from} and {to} {wanted} {value}{unit}: {reached}")
}
