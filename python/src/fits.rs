//! Fits to measured detachments, and designs.

use crate::arguments;
use crate::columns::{Column, Table};
use crate::errors::of_scene;
use crate::scene::CheckedScene;
use crate::threads;
use crate::traces::single;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use whiskmap::Side;
use whiskmap::design::{
    DesignError, DesignGoal, DesignTarget, DesignVariable, DesignVaried, MOST_PUSH_DEG,
    design_until, designs_until,
};
use whiskmap::fit::{FitError, FitLoss, fit_until};
use whiskmap::measured::{ComparedPoint, MeasuredAngle, MeasuredPoints};
use whiskmap::scene::{Parameter, Scene, digits, rounded};
use whiskmap::yields::PushMark;

/// Name, unit, value, standard error, and whether the value is at a limit, of a fitted parameter.
type Estimate = (&'static str, &'static str, f64, Option<f64>, bool);

/// Index among the points, residual in degrees, weight, parameter and change in standard errors, of a point that pulls on a fit.
type Pull = (usize, f64, f64, &'static str, f64);

/// Result of a fit.
#[derive(IntoPyObject)]
pub struct FitResult<'py> {
    scene: CheckedScene,
    estimates: Vec<Estimate>,
    correlation: Vec<Vec<Option<f64>>>,
    chi_square: f64,
    degrees_of_freedom: usize,
    is_explained: bool,
    not_a_fit: Option<String>,
    is_chord: bool,
    points: Vec<Column<'py>>,
    pulls: Vec<Pull>,
    warnings: Vec<String>,
}

/// Fits the `free` parameters of the scene's only whisker to the CSV table `points`, which messages call `origin`.
#[pyfunction]
pub fn fit<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    points: &str,
    origin: &str,
    free: Vec<String>,
    loss: &str,
    columns: Vec<(String, String)>,
) -> PyResult<FitResult<'py>> {
    let refused = |why: String| PyValueError::new_err(why);
    let table = arguments::table(points, origin, columns, &MeasuredPoints::COLUMNS);
    let points = table
        .and_then(|table| MeasuredPoints::of(&table))
        .map_err(|why| refused(why.to_string()))?;
    if points.whiskers.is_empty() {
        single(&scene.0)?;
    }
    let loss = arguments::named("loss", loss, FitLoss::ALL, FitLoss::name)?;
    let free: PyResult<Vec<Parameter>> =
        free.iter().map(|name| arguments::parameter("free", name)).collect();
    let free = free?;
    let job = |cancel: &Arc<AtomicBool>| {
        let fit = fit_until(&scene.0, &points, &free, loss, cancel)?;
        let table = Table::new(&fit.comparison.rows, ComparedPoint::COLUMNS, cancel);
        Ok((fit, table))
    };
    let found = threads::run(py, None, |_| Ok(()), job)?;
    let (fit, table) = found.map_err(|why| match why {
        FitError::Scene(why) => of_scene(py, &why),
        FitError::NotConverged(_) => PyRuntimeError::new_err(why.to_string()),
        _ => refused(why.to_string()),
    })?;
    let noted = [points.missing(), points.crossed(), fit.moved_start(&scene.0, &points)];
    let warnings = noted.into_iter().flatten().chain(fit.warnings(&points));
    let warnings = warnings.collect();
    let estimates = fit.estimates.iter().map(|estimate| {
        (
            estimate.parameter.name(),
            estimate.parameter.unit(),
            estimate.value,
            estimate.standard_error,
            estimate.is_at_limit,
        )
    });
    let pulls = fit.pulls.iter().map(|pull| {
        let name = pull.parameter.name();
        let mut rows = fit.comparison.rows.iter();
        let index = rows.position(|row| row.line == pull.line).unwrap_or_default();
        (index, pull.residual_deg, pull.weight, name, pull.standard_errors)
    });
    Ok(FitResult {
        pulls: pulls.collect(),
        is_chord: points.angle == MeasuredAngle::Chord,
        estimates: estimates.collect(),
        is_explained: fit.is_explained(),
        correlation: fit.correlation,
        chi_square: fit.chi_square,
        degrees_of_freedom: fit.degrees_of_freedom,
        not_a_fit: fit.not_a_fit.map(|why| why.to_string()),
        points: table.into_columns(py)?,
        warnings,
        scene: CheckedScene(fit.scene),
    })
}

/// Solutions, range, value, kind and reached quantity of the ends over the range, and warnings.
type DesignResult = (Vec<f64>, [f64; 2], Vec<f64>, Vec<String>, Vec<Option<f64>>, Vec<String>);

/// Varied number by its name, with limits.
type Varied = (String, Option<[f64; 2]>);

/// Values, reached quantities and whether each value is at a limit, of what is nearest to several targets.
type Nearest = (Vec<f64>, Vec<f64>, Vec<bool>);

/// Solutions `[solution][variable]`, ranges `[variable]`, whether the targets do not determine them, what is nearest without a solution, and
/// warnings.
type DesignsResult = (Vec<Vec<f64>>, Vec<[f64; 2]>, bool, Option<Nearest>, Vec<String>);

/// Returns the warnings of the whiskers of the solutions of a design, and one for each that yields.
fn solution_warnings(
    scene: &Scene,
    varied: &DesignVaried,
    push: (Side, f64),
    solutions: &[Vec<f64>],
) -> Vec<String> {
    let (_, distance_mm) = push;
    let of_scene = |values: &Vec<f64>| varied.warnings(scene, distance_mm, values);
    let mut warnings: Vec<String> = solutions.iter().flat_map(of_scene).collect();
    let Some(most) = scene.whisker.yield_strain else {
        return warnings;
    };
    let warning = |values: &Vec<f64>| {
        let mark = PushMark::of_solution(scene, varied, push, values)?;
        let strain = mark.max_strain.filter(|_| mark.yields == Some(true))?;
        let pairs = varied.variables.iter().zip(values);
        let texts =
            pairs.map(|(variable, value)| format!("{} = {}", variable.variable, digits(*value)));
        let named = texts.collect::<Vec<_>>().join(", ");
        Some(format!(
            "{named}: the whisker yields: the largest strain of the push, {}, exceeds yield_strain = {}",
            digits(rounded(strain, 6)),
            digits(most)
        ))
    };
    warnings.extend(solutions.iter().filter_map(warning));
    warnings
}

/// Returns what a design of `scene` varies, and its distance in mm before that. `distance` is in mm, or in whisker lengths if `is_part` is true.
fn varied(
    scene: &Scene,
    variables: Vec<Varied>,
    distance: Option<(f64, bool)>,
    keeps_taper: bool,
) -> PyResult<(DesignVaried, f64)> {
    let variable = |(name, limits): Varied| {
        let variable =
            name.parse().map_err(|must: String| arguments::refused("parameter", &name, &must));
        Ok(DesignVariable { variable: variable?, limits })
    };
    let variables = variables.into_iter().map(variable);
    let mut varied: DesignVaried = variables.collect::<PyResult<Vec<_>>>()?.into_iter().collect();
    varied.keeps_taper = keeps_taper;
    let distances = &scene.grid.distance_mm;
    let distance_mm = match distance {
        None => distances[distances.len() / 2],
        Some((part, true)) => {
            varied.distance_to_length = Some(part);
            part * scene.whisker.length_mm
        }
        Some((distance_mm, false)) => distance_mm,
    };
    Ok((varied, distance_mm))
}

/// Returns the exception of a refused design.
fn of_design(py: Python<'_>, why: DesignError) -> PyErr {
    match why {
        DesignError::Distance(why) => of_scene(py, &why),
        _ => PyValueError::new_err(why.to_string()),
    }
}

/// Finds every value of the one varied number with which a push of the scene's only whisker reaches `value` of the goal's quantity.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "one argument of Python each")]
pub fn design(
    py: Python<'_>,
    scene: &CheckedScene,
    parameter: Varied,
    goal: &str,
    value: f64,
    distance: Option<(f64, bool)>,
    side: Option<&str>,
    keeps_taper: bool,
) -> PyResult<DesignResult> {
    single(&scene.0)?;
    let (varied, distance_mm) = varied(&scene.0, vec![parameter], distance, keeps_taper)?;
    let target = target((goal, value), distance_mm, side)?;
    let push = (target.side, distance_mm);
    let job = |cancel: &Arc<AtomicBool>| {
        let found = design_until(&scene.0, varied.clone(), &target, &|_| {}, cancel)?;
        let solutions: Vec<Vec<f64>> = found.values.iter().map(|value| vec![*value]).collect();
        let mut warnings = solution_warnings(&scene.0, &varied, push, &solutions);
        warnings.extend(found.spans.iter().map(|span| {
            let [from, to] = span.map(|end| digits(rounded(end, 6)));
            let name = varied.variables[0].variable;
            format!("the target does not determine {name}: every value between {from} and {to} reaches it")
        }));
        Ok((found, warnings))
    };
    let found = threads::run(py, None, |_| Ok(()), job)?;
    let (found, warnings) = found.map_err(|why| of_design(py, why))?;
    let ends = found.ends.iter();
    let kind = |kind| serde_json::to_value(kind).ok()?.as_str().map(str::to_owned);
    let kinds = ends.clone().map(|end| kind(end.kind).unwrap_or_default());
    let reached = ends.clone().map(|end| end.reached);
    Ok((
        found.values.clone(),
        found.range,
        ends.map(|end| end.value).collect(),
        kinds.collect(),
        reached.collect(),
        warnings,
    ))
}

/// Finds the values of several varied numbers with which a push of the scene's only whisker on `side` reaches all `targets`. Each target
/// has a goal and a value.
#[pyfunction]
pub fn designs(
    py: Python<'_>,
    scene: &CheckedScene,
    parameters: Vec<Varied>,
    targets: Vec<(String, f64)>,
    distance: Option<(f64, bool)>,
    side: Option<&str>,
    keeps_taper: bool,
) -> PyResult<DesignsResult> {
    single(&scene.0)?;
    let (varied, distance_mm) = varied(&scene.0, parameters, distance, keeps_taper)?;
    let targets = targets.iter().map(|(goal, value)| target((goal, *value), distance_mm, side));
    let targets: Vec<DesignTarget> = targets.collect::<PyResult<_>>()?;
    let job = |cancel: &Arc<AtomicBool>| {
        let found = designs_until(&scene.0, &varied, &targets, &|_| {}, cancel)?;
        let push = (targets[0].side, distance_mm);
        let warnings = solution_warnings(&scene.0, &varied, push, &found.solutions);
        Ok((found, warnings))
    };
    let found = threads::run(py, None, |_| Ok(()), job)?;
    let (found, warnings) = found.map_err(|why| of_design(py, why))?;
    let nearest = found.nearest;
    let nearest = nearest.map(|nearest| (nearest.values, nearest.reached, nearest.is_at_limit));
    Ok((found.solutions, found.ranges, found.is_undetermined, nearest, warnings))
}

fn goals(name: &str) -> PyResult<DesignGoal> {
    Ok(match name {
        "slip_off_deg" => DesignGoal::SlipOff,
        "pull_off_deg" => DesignGoal::PullOff,
        "max_force_un" => DesignGoal::MaxForce,
        "max_moment_nnm" => DesignGoal::MaxMoment,
        "max_strain" => DesignGoal::MaxStrain,
        _ => return Err(arguments::refused("goal", name, "is not known")),
    })
}

/// Returns the target of a push at a distance in mm: the name of its goal, and its value. Its side is that of the push angle, or the given one for
/// a load.
fn target(
    (name, value): (&str, f64),
    distance_mm: f64,
    side: Option<&str>,
) -> PyResult<DesignTarget> {
    let goal = goals(name)?;
    let target = |side| Ok(DesignTarget { distance_mm, side, goal, value });
    let side = side.map(arguments::side).transpose()?;
    let is_angle = goal.kind().is_some();
    let must = match (is_angle, side) {
        (true, _) if !(value.abs() <= MOST_PUSH_DEG && value != 0.0) => {
            "must be between -3240 and 3240 degrees, nine turns of the base, and not 0"
        }
        (true, Some(side)) if side != Side::of_push(value) => {
            "must be positive with side='cb', and negative with side='cf'"
        }
        (true, _) => return target(Side::of_push(value)),
        (false, _) if !(value > 0.0 && value.is_finite()) => "must be more than 0",
        (false, None) => "needs a side, 'cb' or 'cf'",
        (false, Some(side)) => return target(side),
    };
    Err(PyValueError::new_err(format!("{name} = {value}: {must}")))
}
