//! Command `whiskmap design`.

use super::arguments::{length, side};
use super::failure::{Failure, message};
use super::files::Files;
use super::outputs::{PlotArgs, open, write};
use super::pole::{self, WhiskerArgs, title};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use whiskmap::Side;
use whiskmap::design::{
    Design, DesignError, DesignGoal, DesignTarget, DesignVariable, DesignVaried, Designs, design,
    designs, ends_between,
};
use whiskmap::input::{Quantity, did_you_mean};
use whiskmap::render::designs as chart;
use whiskmap::scene::{Parameter, Scene, digits, rounded};
use whiskmap::sensitivity::Variable;
use whiskmap::terminal::StandardOutput;
use whiskmap::trace::DetachmentKind;
use whiskmap::yields::PushMark;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap design scenes/robot.toml --distance 60 --side cb --slip-off 30deg --for taper --plot taper.svg
  whiskmap design scenes/robot.toml --distance 60 --slip-off -50deg --for parabola_per_mm
  whiskmap design scenes/robot.toml --distance 60 --side cb --max-force 60mN --for base_radius_um -o better.toml
  whiskmap design scenes/robot.toml --distance 70% --slip-off 30deg --max-moment 20mNm --for base_radius_um,taper=0.5..1
  whiskmap design scenes/robot.toml --slip-off 30deg --for distance_mm
  whiskmap design scenes/cylinder.toml --distance 19 --pull-off 40deg --for length_mm

Each line is one value with which a push reaches the target; with several parameters, a header and a line of values for each solution. \
There must be as many targets as parameters. --max-force, --max-moment and --max-strain are the largest values of \
the push, from first touch until the whisker detaches in either way: of the contact force, the moment at the base, and the \
bending strain at the surface of the whisker.

For one push angle, values have 10 significant digits and a relative error of 1e-9; where two solutions nearly merge, that of the \
root of the rounding error. Other values have 6 digits. The search covers the whole range that the scene accepts, or the limits \
NAME=FROM..TO, with 128 values; in a wide range, half of them are spaced logarithmically. A pair of solutions between two of these \
values is found if the target's quantity turns back only once there. Several parameters have about 600 places, from which Newton's method \
starts. Without any solution the exit code is 1, and standard error gives what is possible. The scene's grid is ignored.")]
pub struct DesignArgs {
    #[command(flatten)]
    whisker: WhiskerArgs,
    /// Distance from the base to the contact at first touch, in mm or with a unit, such as 1.5cm, or in parts of the length, such as 70%
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = distance)]
    distance: Option<Distance>,
    /// Side of the whisker that the pole is on [default: by the sign of the angle]
    #[arg(long, value_parser = side())]
    side: Option<Side>,
    #[command(flatten)]
    goal: GoalArgs,
    /// Parameters of the scene to vary, separated by commas, or distance_mm; NAME=FROM..TO keeps within limits
    #[arg(long = "for", value_name = "NAMES", required = true, value_delimiter = ',', value_parser = variable)]
    varied: Vec<DesignVariable>,
    /// Keep the taper where a radius varies, instead of the radius at the tip
    #[arg(long, value_name = "taper", value_parser = ["taper"])]
    keep: Option<String>,
    /// Write the scene with the values to BETTER.toml; of several solutions, the one nearest to the scene's own; - is standard output
    #[arg(short, long, value_name = "BETTER.toml")]
    output: Option<PathBuf>,
    #[command(flatten)]
    picture: PlotArgs,
}

/// Distance in mm, or in whisker lengths.
#[derive(Clone, Copy, Debug)]
enum Distance {
    Mm(f64),
    OfLength(f64),
}

fn distance(text: &str) -> Result<Distance, String> {
    let Some(percent) = text.trim().strip_suffix('%') else {
        return length(text).map(Distance::Mm);
    };
    match percent.trim().parse() {
        Ok(percent) if percent > 0.0 && f64::is_finite(percent) => Ok(Distance::OfLength(percent / 100.0)),
        _ => Err("must be a length, such as 15.66, 15.66mm or 1.5cm, or a part of the whisker's length, such as 70%".to_owned()),
    }
}

/// Parses the name of a parameter or of the distance, with limits of its value if the text gives them.
fn variable(text: &str) -> Result<DesignVariable, String> {
    let (name, limits) = match text.split_once('=') {
        Some((name, limits)) => (name, Some(limits)),
        None => (text, None),
    };
    let names = || {
        Parameter::ALL
            .map(Parameter::name)
            .into_iter()
            .chain(["distance_mm"])
    };
    let known = name
        .parse()
        .ok()
        .filter(|variable| *variable != Variable::PushAngleDeg);
    let variable = known.ok_or_else(|| {
        let hint = Parameter::suggested(name).unwrap_or_else(|| did_you_mean(name, names()));
        format!(
            "must be one of {}{hint}",
            names().collect::<Vec<_>>().join(", ")
        )
    })?;
    let limits = limits.map(|limits| {
        let must = || format!("{name}: limits must be two growing values, such as {name}=1..2");
        let (from, to) = limits.split_once("..").ok_or_else(must)?;
        let number = |text: &str| {
            let number = Quantity::of(name).parse(text.trim());
            number.map_err(|why| format!("{name}={text}: {why}"))
        };
        let limits = [number(from)?, number(to)?];
        (limits[0] < limits[1]).then_some(limits).ok_or_else(must)
    });
    Ok(DesignVariable {
        variable,
        limits: limits.transpose()?,
    })
}

/// Significant digits of a target in messages, and of what is reached instead.
const ASKED_DIGITS: usize = 15;
const REACHED_DIGITS: usize = 8;

/// Significant digits of solutions for several targets.
const SOLUTION_DIGITS: usize = 6;

#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
struct GoalArgs {
    /// Push angle of the slip-off, such as 30deg, 30°, 30 or 0.5rad: positive CB, negative CF
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = push)]
    slip_off: Option<GoalValue>,
    /// Push angle of the pull-off
    #[arg(long, value_name = "ANGLE", conflicts_with = "slip_off", allow_hyphen_values = true, value_parser = push)]
    pull_off: Option<GoalValue>,
    /// Largest contact force of the push, with friction, such as 60mN, 60000uN or 60000
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true, value_parser = load(Quantity::ForceUn))]
    max_force: Option<GoalValue>,
    /// Largest moment at the base in the push, such as 250nNm, 250 or 0.25uNm
    #[arg(long, value_name = "MOMENT", allow_hyphen_values = true, value_parser = load(Quantity::MomentNnm))]
    max_moment: Option<GoalValue>,
    /// Largest bending strain of the push, such as 0.01
    #[arg(long, value_name = "STRAIN", allow_hyphen_values = true, value_parser = load(Quantity::Number))]
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

/// Target of a design with its option and the value as the option gives it.
struct AskedTarget {
    option: &'static str,
    target: DesignTarget,
    asked: GoalValue,
}

impl AskedTarget {
    /// Returns a value of the target's quantity in the unit of the option.
    fn text(&self, value: f64, most: usize) -> String {
        self.asked.text(self.target.goal.quantity(), value, most)
    }

    /// Returns what a push does that reaches the target.
    fn wanted(&self) -> String {
        let value = self.text(self.target.value, ASKED_DIGITS);
        match self.target.goal.kind() {
            Some(DetachmentKind::PullOff) => format!("pulls the whisker off at {value}"),
            Some(_) => format!("makes the whisker slip off at {value}"),
            None => format!("gives a {} of {value}", self.target.goal.title()),
        }
    }
}

impl DesignArgs {
    /// Returns the targets of a push at `distance_mm`, in the order of the options.
    fn targets(&self, distance_mm: f64) -> Result<Vec<AskedTarget>, Failure> {
        let goals = [
            ("--slip-off", DesignGoal::SlipOff, self.goal.slip_off),
            ("--pull-off", DesignGoal::PullOff, self.goal.pull_off),
            ("--max-force", DesignGoal::MaxForce, self.goal.max_force),
            ("--max-moment", DesignGoal::MaxMoment, self.goal.max_moment),
            ("--max-strain", DesignGoal::MaxStrain, self.goal.max_strain),
        ];
        let asked = |(option, goal, value): (_, _, Option<_>)| Some((option, goal, value?));
        let given: Vec<(&'static str, DesignGoal, GoalValue)> =
            goals.into_iter().filter_map(asked).collect();
        let angle = given.iter().find(|(_, goal, _)| goal.kind().is_some());
        let of_angle = angle.map(|(.., asked)| Side::of_push(asked.value));
        let Some(side) = of_angle.or(self.side) else {
            let why = format!(
                "{}: needs --side cb or cf, or a push angle with its sign",
                given[0].0
            );
            return Err(Failure::Input(why));
        };
        let other = match (self.side, side) {
            (Some(Side::Cf), Side::Cb) => Some("--side cf must be negative"),
            (Some(Side::Cb), Side::Cf) => Some("--side cb must be positive"),
            _ => None,
        };
        if let (Some(must), Some((option, goal, asked))) = (other, angle) {
            let push = asked.text(goal.quantity(), asked.value, ASKED_DIGITS);
            let why = format!("{option} {push}: a push angle of {must}");
            return Err(Failure::Input(why));
        }
        let targets = given.into_iter().map(|(option, goal, asked)| AskedTarget {
            option,
            target: DesignTarget {
                distance_mm,
                side,
                goal,
                value: asked.value,
            },
            asked,
        });
        Ok(targets.collect())
    }

    /// Returns what the design of `scene` varies, and its distance in mm before that.
    fn varied(&self, scene: &Scene) -> Result<(DesignVaried, f64), Failure> {
        let mut varied: DesignVaried = self.varied.iter().copied().collect();
        varied.keeps_taper = self.keep.is_some();
        let mut all = varied.variables.iter();
        let is_varied = all.any(|variable| variable.variable == Variable::DistanceMm);
        let distances = &scene.grid.distance_mm;
        let distance_mm = match self.distance {
            Some(_) if is_varied => {
                let why = "--distance: must be left out, because --for varies distance_mm";
                return Err(Failure::Input(why.to_owned()));
            }
            None if !is_varied => {
                let why = "--distance: is left out, and --for does not vary distance_mm";
                return Err(Failure::Input(why.to_owned()));
            }
            None => distances[distances.len() / 2],
            Some(Distance::Mm(distance_mm)) => distance_mm,
            Some(Distance::OfLength(part)) => {
                varied.distance_to_length = Some(part);
                part * scene.whisker.length_mm
            }
        };
        Ok((varied, distance_mm))
    }
}

/// Returns the failure of a design of the scene at `path`.
fn refused(path: &Path, why: DesignError) -> Failure {
    match why {
        DesignError::Sweep(_) => Failure::Input(why.to_string()),
        DesignError::NoTaper => Failure::Input(format!("--keep {why}")),
        DesignError::Distance(why) => Failure::Scene(why),
        _ => Failure::Input(format!("{}: --for {why}", path.display())),
    }
}

pub fn run(args: &DesignArgs, files: &mut Files) -> Result<(), Failure> {
    let path = &args.whisker.scene;
    let scene = args.whisker.read(files, "design")?;
    let (varied, distance_mm) = args.varied(&scene)?;
    pole::check_distances(&scene, &[distance_mm])?;
    let asked = args.targets(distance_mm)?;
    let variables = &varied.variables;
    if variables.len() != asked.len() {
        let options = asked.iter().map(|target| target.option);
        let options = options.collect::<Vec<_>>().join(", ");
        let names = variables.iter().map(|variable| variable.variable.name());
        let names = names.collect::<Vec<_>>().join(",");
        let why =
            format!("--for {names}: must be as many parameters as targets; these are {options}");
        return Err(Failure::Input(why));
    }
    let output = args.output.as_deref();
    if let Some(option) = output
        .map(|_| "--output")
        .filter(|_| distance_is_varied(&varied))
    {
        let why = format!(
            "{option}: must be left out with --for distance_mm, which is no number of a scene"
        );
        return Err(Failure::Input(why));
    }
    if args.picture.is_given() && variables.len() > 1 {
        let why = "--plot: must be left out with several parameters; it shows one";
        return Err(Failure::Input(why.to_owned()));
    }
    let (better, picture) = open(files, "--output", output, &args.picture)?;
    let (solutions, most_digits) = match &asked[..] {
        [one] => {
            let target = &one.target;
            let found = design(&scene, varied.clone(), target).map_err(|why| refused(path, why))?;
            if let Some(picture) = picture {
                let range = found.shown();
                let ends = ends_between(&scene, varied.clone(), target, range);
                let near = Design {
                    range,
                    ends: ends.map_err(|why| refused(path, why))?,
                    values: found.values.clone(),
                };
                let plot = chart(variables[0].variable, target, &near);
                picture.plot(heading(&scene, &varied, distance_mm), plot)?;
            }
            if found.values.is_empty() {
                let why = unreached(variables[0].variable, one, &found);
                return Err(Failure::NoValue(why));
            }
            let values = found.values.iter().map(|value| vec![*value]).collect();
            (values, target.goal.digits())
        }
        several => {
            let targets: Vec<DesignTarget> = several.iter().map(|target| target.target).collect();
            let found = designs(&scene, &varied, &targets).map_err(|why| refused(path, why))?;
            if found.solutions.is_empty() || found.is_undetermined {
                let why = unreached_together(variables, several, &found);
                return Err(Failure::NoValue(why));
            }
            (found.solutions, SOLUTION_DIGITS)
        }
    };
    let short: Vec<Vec<f64>> = solutions
        .iter()
        .map(|values| written(&scene, &varied, values, most_digits))
        .collect();
    let side = asked[0].target.side;
    name_strains(&scene, &varied, (side, distance_mm), &short);
    if let Some(output) = better {
        let current: Vec<f64> = variables
            .iter()
            .filter_map(|variable| variable.variable.value(&scene))
            .collect();
        let apart = |values: &[f64]| {
            let pairs = values.iter().zip(&current);
            pairs
                .map(|(value, current)| {
                    ((value - current) / current.abs().max(f64::MIN_POSITIVE)).powi(2)
                })
                .sum::<f64>()
        };
        let nearest = short.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let changes = nearest.map(|values| changes(&scene, &varied, values, most_digits));
        let is_stdout = output.is_stdout();
        let text = scene.to_toml_with(&changes.unwrap_or_default())?;
        write(output, text.as_bytes())?;
        if is_stdout {
            return Ok(());
        }
    }
    let mut out = StandardOutput::open();
    if variables.len() > 1 {
        let names = variables.iter().map(|variable| variable.variable.name());
        writeln!(out, "{}", names.collect::<Vec<_>>().join(","))?;
    }
    for values in short {
        let values: Vec<String> = values.into_iter().map(digits).collect();
        writeln!(out, "{}", values.join(","))?;
    }
    Ok(())
}

/// Prints the largest bending strain of the push of each solution beside the yield strain of the scene, if it has one.
fn name_strains(
    scene: &Scene,
    varied: &DesignVaried,
    (side, distance_mm): (Side, f64),
    solutions: &[Vec<f64>],
) {
    let Some(most) = scene.whisker.yield_strain else {
        return;
    };
    for values in solutions {
        let pairs = varied.variables.iter().zip(values);
        let texts =
            pairs.map(|(variable, value)| format!("{} = {}", variable.variable, digits(*value)));
        let named = texts.collect::<Vec<_>>().join(", ");
        let mark = PushMark::of_solution(scene, varied, (side, distance_mm), values);
        let PushMark { max_strain, yields } = mark.unwrap_or_default();
        let strain = max_strain.map(|strain| digits(rounded(strain, SOLUTION_DIGITS)));
        let most = digits(most);
        message(&match (strain, yields) {
            (None, _) => format!("{named}: the largest strain of the push is not known"),
            (Some(strain), Some(true)) => format!(
                "warning: {named}: the whisker yields: the largest strain of the push, {strain}, exceeds whisker.yield_strain = {most}; \
                 --max-strain finds values within it"
            ),
            (Some(strain), _) => format!(
                "{named}: the largest strain of the push is {strain}, within whisker.yield_strain = {most}"
            ),
        });
    }
}

fn distance_is_varied(varied: &DesignVaried) -> bool {
    let mut all = varied.variables.iter();
    all.any(|variable| variable.variable == Variable::DistanceMm)
}

/// Returns the title of a chart of the scene, with the distance of the pole unless it varies.
fn heading(scene: &Scene, varied: &DesignVaried, distance_mm: f64) -> String {
    match varied.distance_to_length {
        _ if distance_is_varied(varied) => scene.title.clone(),
        Some(part) => format!(
            "{}, touched at {} % of its length",
            scene.title,
            digits(rounded(100.0 * part, 6))
        ),
        None => title(scene, &[distance_mm]),
    }
}

/// Returns the values of a solution with their significant digits, or with all digits if the scene refuses them otherwise, next to a limit.
fn written(scene: &Scene, varied: &DesignVaried, values: &[f64], digits: usize) -> Vec<f64> {
    let short: Vec<f64> = values.iter().map(|value| rounded(*value, digits)).collect();
    match scene.with_parameters(&varied.changes(scene, &short)) {
        Ok(_) => short,
        Err(_) => values.to_vec(),
    }
}

/// Returns the numbers of the scene with the values of a solution. Instead of a taper, the scene gives the radius at the tip, with at most
/// `digits` digits.
fn changes(
    scene: &Scene,
    varied: &DesignVaried,
    values: &[f64],
    digits: usize,
) -> Vec<(Parameter, f64)> {
    let mut changes = varied.changes(scene, values);
    let base = changes
        .iter()
        .find(|(parameter, _)| *parameter == Parameter::BaseRadiusUm);
    let base_radius_um = base.map_or(scene.whisker.base_radius_um, |(_, value)| *value);
    for change in &mut changes {
        if change.0 == Parameter::Taper {
            *change = (
                Parameter::TipRadiusUm,
                rounded(base_radius_um * (1.0 - change.1), digits),
            );
        }
    }
    changes
}

/// Returns the message for a target without a solution, with what is possible.
fn unreached(variable: Variable, asked: &AskedTarget, design: &Design) -> String {
    let name = variable.name();
    let [from, to] = design.range.map(digits);
    let goal = asked.target.goal;
    let wanted = asked.wanted();
    let number = |value: f64| asked.text(value, REACHED_DIGITS);
    let ways = [
        (DetachmentKind::SlipOff, "slips off"),
        (DetachmentKind::PullOff, "is pulled off"),
    ];
    let ranges = ways.iter().filter_map(|(kind, way)| {
        let [low, high] = design.reached(*kind)?.map(number);
        let between = match goal.kind() {
            Some(_) if low == high => format!("at {low} for every value"),
            Some(_) => format!("between {low} and {high}"),
            None if low == high => format!("with {low} for every value"),
            None => format!("with {low} to {high}"),
        };
        Some(format!("it {way} {between}"))
    });
    let ranges: Vec<_> = ranges.collect();
    let reached = match ranges.join(", and ") {
        nothing if nothing.is_empty() => "it does not reach the pole".to_owned(),
        ranges => ranges,
    };
    format!("no {name} between {from} and {to} {wanted}: {reached}")
}

/// Returns the message for targets that have no solution, or a line of solutions.
fn unreached_together(
    variables: &[DesignVariable],
    asked: &[AskedTarget],
    found: &Designs,
) -> String {
    let listed = |values: &[f64], of: &dyn Fn(usize) -> String| {
        let parts = variables.iter().zip(values).enumerate();
        let parts = parts.map(|(i, (variable, value))| {
            format!(
                "{} {}{}",
                variable.variable,
                digits(rounded(*value, SOLUTION_DIGITS)),
                of(i)
            )
        });
        parts.collect::<Vec<_>>().join(" and ")
    };
    let wanted: Vec<String> = asked.iter().map(AskedTarget::wanted).collect();
    let wanted = wanted.join(" and ");
    if let Some(solution) = found.solutions.first() {
        let solution = listed(solution, &|_| String::new());
        return format!(
            "the targets do not determine these parameters: one can replace another along a line of values; {solution} is one that {wanted}"
        );
    }
    let pairs = variables.iter().zip(&found.ranges);
    let ranges = pairs.map(|(variable, range)| {
        let [from, to] = range.map(|end| digits(rounded(end, SOLUTION_DIGITS)));
        format!("{} between {from} and {to}", variable.variable)
    });
    let ranges = ranges.collect::<Vec<_>>().join(" and ");
    let Some(nearest) = &found.nearest else {
        return format!("no {ranges} {wanted}: no push ends in this way");
    };
    let at_limit = |i: usize| match nearest.is_at_limit[i] {
        true => " (a limit)".to_owned(),
        false => String::new(),
    };
    let values = listed(&nearest.values, &at_limit);
    let pairs = asked.iter().zip(&nearest.reached);
    let reached = pairs.map(|(target, value)| target.text(*value, SOLUTION_DIGITS));
    let reached = reached.collect::<Vec<_>>().join(" and ");
    let why = match nearest.is_at_limit.contains(&true) {
        true => "beyond the limits the targets may be nearer",
        false => "the targets exclude each other there",
    };
    format!("no {ranges} {wanted}: the nearest values are {values}, with {reached}; {why}")
}
