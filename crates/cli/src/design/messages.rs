//! Messages of `whiskmap design`: refusals, targets without a solution or with a range of them, and strains beside the yield strain.

use super::options::{ASKED_DIGITS, AskedTarget};
use super::solutions::SOLUTION_DIGITS;
use crate::failure::{Failure, message, warnings};
use std::path::Path;
use whiskmap::Side;
use whiskmap::design::{Design, DesignEnd, DesignError, DesignVariable, DesignVaried, Designs};
use whiskmap::scene::{Scene, digits, rounded};
use whiskmap::sensitivity::Variable;
use whiskmap::trace::DetachmentKind;
use whiskmap::yields::PushMark;

/// Significant digits of what is reached instead of a target.
const REACHED_DIGITS: usize = 8;

/// Returns the failure of a design of the scene at `path`.
pub fn refused(path: &Path, why: DesignError) -> Failure {
    match why {
        DesignError::Sweep(_) => Failure::Input(why.to_string()),
        DesignError::NoTaper => Failure::Input(format!("--keep {why}")),
        DesignError::Distance(why) => Failure::Scene(why),
        _ => Failure::Input(format!("{}: --for {why}", path.display())),
    }
}

/// Prints the warnings of the whiskers of the solutions that the `scene` does not have, and the largest bending strain of the push of each solution
/// beside the yield strain of the scene, if it has one.
pub fn print_warnings(
    scene: &Scene,
    varied: &DesignVaried,
    (side, distance_mm): (Side, f64),
    solutions: &[Vec<f64>],
) {
    for values in solutions {
        warnings(varied.warnings(scene, distance_mm, values));
    }
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
                 --max-strain searches for values within it"
            ),
            (Some(strain), _) => format!(
                "{named}: the largest strain of the push is {strain}, within whisker.yield_strain = {most}"
            ),
        });
    }
}

/// Returns the message for a target without a solution, with what is possible.
pub fn unreached(variable: Variable, asked: &AskedTarget, design: &Design) -> String {
    let name = variable.name();
    let [from, to] = design.range.map(digits);
    let goal = asked.target.goal;
    let wanted = asked.wanted();
    let number = |value: f64| {
        // More digits of a value next to the target, which has them.
        let is_other =
            |most: &usize| asked.text(value, *most) != asked.text(asked.target.value, *most);
        let most = (REACHED_DIGITS..ASKED_DIGITS).find(is_other);
        asked.text(value, most.unwrap_or(ASKED_DIGITS))
    };
    let kinds =
        [(DetachmentKind::SlipOff, "slips off"), (DetachmentKind::PullOff, "is pulled off")];
    let ranges = kinds.iter().filter_map(|(kind, verb)| {
        let [low, high] = design.reached(*kind)?.map(number);
        let between = match goal.kind() {
            Some(_) if low == high => format!("at {low} for every value"),
            Some(_) => format!("between {low} and {high}"),
            None if low == high => format!("with {low} for every value"),
            None => format!("with {low} to {high}"),
        };
        Some(format!("it {verb} {between}"))
    });
    let is_unresolved = |end: &DesignEnd| end.kind == DetachmentKind::Unresolved;
    let unresolved = design.ends.iter().any(is_unresolved).then(|| {
        "the ends of some pushes are unresolved, such as those beyond nine turns of the base"
            .to_owned()
    });
    let ranges: Vec<_> = ranges.chain(unresolved).collect();
    let reached = match ranges.join(", and ") {
        nothing if nothing.is_empty() => "it does not reach the pole".to_owned(),
        ranges => ranges,
    };
    format!("no {name} between {from} and {to} {wanted}: {reached}")
}

/// Returns the message for a target that every value in a range reaches, with the `scene_value` of the parameter if it is one.
pub fn undetermined(
    variable: Variable,
    scene_value: Option<f64>,
    asked: &AskedTarget,
    design: &Design,
) -> String {
    let name = variable.name();
    let number = |value: f64| digits(rounded(value, SOLUTION_DIGITS));
    let spans = design.spans.iter().map(|[from, to]| {
        let is_own = |value: &f64| (from..=to).contains(&value);
        let own = scene_value.filter(is_own).map(number);
        let own = own.map_or_else(String::new, |own| format!(", such as the scene's own {own},"));
        format!("between {} and {}{own}", number(*from), number(*to))
    });
    let spans: Vec<String> = spans.collect();
    let values: Vec<String> = design.values.iter().map(|value| number(*value)).collect();
    let others = match &values[..] {
        [] => String::new(),
        values => format!("; so does {}", values.join(", and ")),
    };
    format!(
        "the target does not determine {name}: every value {} {}{others}",
        spans.join(" and "),
        asked.wanted()
    )
}

/// Returns the message for targets that have no solution, or a line of solutions.
pub fn unreached_together(
    variables: &[DesignVariable],
    asked: &[AskedTarget],
    found: &Designs,
) -> String {
    let listed = |values: &[f64], of: &dyn Fn(usize) -> String| {
        let parts = variables.iter().zip(values).enumerate();
        let parts = parts.map(|(i, (variable, value))| {
            format!("{} {}{}", variable.variable, digits(rounded(*value, SOLUTION_DIGITS)), of(i))
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
