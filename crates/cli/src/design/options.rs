//! Options of `whiskmap design`: what varies, the targets, and the checks of both.

use super::{DesignArgs, distance_is_varied};
use crate::arguments::length;
use crate::failure::Failure;
use clap::Args;
use whiskmap::Side;
use whiskmap::design::{DesignGoal, DesignTarget, DesignVariable, DesignVaried, MOST_PUSH_DEG};
use whiskmap::input::{Quantity, did_you_mean};
use whiskmap::scene::{Parameter, Scene, digits, rounded};
use whiskmap::sensitivity::Variable;
use whiskmap::trace::DetachmentKind;

/// Distance in mm, or in whisker lengths.
#[derive(Clone, Copy, Debug)]
pub enum Distance {
    Mm(f64),
    OfLength(f64),
}

/// Parses a distance.
pub fn distance(text: &str) -> Result<Distance, String> {
    let Some(percent) = text.trim().strip_suffix('%') else {
        return length(text).map(Distance::Mm);
    };
    match percent.trim().parse() {
        Ok(percent) if percent > 0.0 && f64::is_finite(percent) => Ok(Distance::OfLength(percent / 100.0)),
        _ => Err("must be a length, such as 15.66, 15.66mm or 1.5cm, or a part of the whisker's length, such as 70%".to_owned()),
    }
}

/// Parses the name of a parameter or of the distance, with limits of its value if the text gives them.
pub fn variable(text: &str) -> Result<DesignVariable, String> {
    let (name, limits) = match text.split_once('=') {
        Some((name, limits)) => (name, Some(limits)),
        None => (text, None),
    };
    let names = || Parameter::ALL.map(Parameter::name).into_iter().chain(["distance_mm"]);
    let known = name.parse().ok().filter(|variable| *variable != Variable::PushAngleDeg);
    let variable = known.ok_or_else(|| {
        let hint = Parameter::suggested(name).unwrap_or_else(|| did_you_mean(name, names()));
        format!("must be one of {}{hint}", names().collect::<Vec<_>>().join(", "))
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
    Ok(DesignVariable { variable, limits: limits.transpose()? })
}

/// Significant digits of a target in messages.
pub const ASKED_DIGITS: usize = 15;

#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
pub struct GoalArgs {
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
pub struct GoalValue {
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
    if value.abs() <= MOST_PUSH_DEG && value != 0.0 {
        Ok(GoalValue { value, unit })
    } else {
        let most = digits(MOST_PUSH_DEG);
        Err(format!("must be between -{most}deg and {most}deg, nine turns of the base, and not 0"))
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
pub struct AskedTarget {
    pub option: &'static str,
    pub target: DesignTarget,
    asked: GoalValue,
}

impl AskedTarget {
    /// Returns a value of the target's quantity in the unit of the option.
    pub fn text(&self, value: f64, most: usize) -> String {
        self.asked.text(self.target.goal.quantity(), value, most)
    }

    /// Returns what a push does that reaches the target.
    pub fn wanted(&self) -> String {
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
    pub(super) fn targets(&self, distance_mm: f64) -> Result<Vec<AskedTarget>, Failure> {
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
            let why =
                format!("{}: needs --side cb or cf, or a push angle with its sign", given[0].0);
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
            target: DesignTarget { distance_mm, side, goal, value: asked.value },
            asked,
        });
        Ok(targets.collect())
    }

    /// Returns what the design of `scene` varies, and its distance in mm before that.
    pub(super) fn varied(&self, scene: &Scene) -> Result<(DesignVaried, f64), Failure> {
        let mut varied: DesignVaried = self.varied.iter().copied().collect();
        varied.keeps_taper = self.keep.is_some();
        let is_varied = distance_is_varied(&varied);
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

    /// Returns `Ok` if the options fit together with what the design varies and its targets.
    pub(super) fn check(
        &self,
        varied: &DesignVaried,
        asked: &[AskedTarget],
    ) -> Result<(), Failure> {
        let variables = &varied.variables;
        if variables.len() != asked.len() {
            let options = asked.iter().map(|target| target.option);
            let options = options.collect::<Vec<_>>().join(", ");
            let names = variables.iter().map(|variable| variable.variable.name());
            let names = names.collect::<Vec<_>>().join(",");
            let why = format!(
                "--for {names}: must be as many parameters as targets; these are {options}"
            );
            return Err(Failure::Input(why));
        }
        if self.output.is_some() && distance_is_varied(varied) {
            let why =
                "--output: must be left out with --for distance_mm, which is no number of a scene";
            return Err(Failure::Input(why.to_owned()));
        }
        if self.picture.plot.is_some() && variables.len() > 1 {
            let why = "--plot: must be left out with several parameters; it shows one";
            return Err(Failure::Input(why.to_owned()));
        }
        Ok(())
    }
}
