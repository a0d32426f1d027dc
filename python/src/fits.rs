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
use whiskmap::design::{DesignError, DesignGoal, DesignTarget, design_until};
use whiskmap::fit::{FitError, fit_until};
use whiskmap::measured::{ComparedPoint, MeasuredPoints};
use whiskmap::scene::Parameter;

/// Name, unit, value, standard error, and whether the value is at a limit, of a fitted parameter.
type Estimate = (&'static str, &'static str, f64, Option<f64>, bool);

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
    points: Vec<Column<'py>>,
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
) -> PyResult<FitResult<'py>> {
    single(&scene.0)?;
    let refused = |why: String| PyValueError::new_err(why);
    let points = MeasuredPoints::parse(points, origin).map_err(|why| refused(why.to_string()))?;
    let free: PyResult<Vec<Parameter>> = free
        .iter()
        .map(|name| arguments::parameter("free", name))
        .collect();
    let free = free?;
    let job = |cancel: &Arc<AtomicBool>| {
        let fit = fit_until(&scene.0, &points, &free, cancel)?;
        let table = Table::new(&fit.comparison.rows, ComparedPoint::COLUMNS, cancel);
        Ok((fit, table))
    };
    let found = threads::run(py, None, |_| Ok(()), job)?;
    let (fit, table) = found.map_err(|why| match why {
        FitError::Scene(why) => of_scene(py, &why),
        FitError::NotConverged(_) => PyRuntimeError::new_err(why.to_string()),
        _ => refused(why.to_string()),
    })?;
    let noted = [
        points.missing(),
        points.crossed(),
        fit.moved_start(&scene.0, &points),
    ];
    let warnings = noted.into_iter().flatten().chain(fit.warnings(&points));
    let warnings = warnings.collect();
    let estimates = fit.estimates.iter();
    let estimates = estimates.map(|own| {
        (
            own.parameter.name(),
            own.parameter.unit(),
            own.value,
            own.standard_error,
            own.is_at_limit,
        )
    });
    Ok(FitResult {
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

/// Solutions, range, and value, kind and reached quantity of the ends over the range.
type DesignResult = (Vec<f64>, [f64; 2], Vec<f64>, Vec<String>, Vec<Option<f64>>);

/// Finds every value of `parameter` with which a push of the scene's only whisker reaches `value` of the goal's quantity.
#[pyfunction]
pub fn design(
    py: Python<'_>,
    scene: &CheckedScene,
    parameter: &str,
    goal: &str,
    value: f64,
    distance_mm: f64,
    side: Option<&str>,
) -> PyResult<DesignResult> {
    single(&scene.0)?;
    let parameter = arguments::parameter("parameter", parameter)?;
    let goal = goals(goal)?;
    let target = DesignTarget {
        distance_mm,
        side: target_side(goal, value, side)?,
        goal,
        value,
    };
    let job = |cancel: &Arc<AtomicBool>| design_until(&scene.0, parameter, &target, cancel);
    let found = threads::run(py, None, |_| Ok(()), job)?.map_err(|why| match why {
        DesignError::Distance(why) => of_scene(py, &why),
        _ => PyValueError::new_err(why.to_string()),
    })?;
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
    ))
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

/// Returns the side of a target: that of the push angle, or the given one for a load.
fn target_side(goal: DesignGoal, value: f64, side: Option<&str>) -> PyResult<Side> {
    let side = side.map(arguments::side).transpose()?;
    let is_angle = goal.kind().is_some();
    let must = match (is_angle, side) {
        (true, _) if !(value.abs() <= 360.0 && value != 0.0) => {
            "must be between -360 and 360 degrees, and not 0"
        }
        (true, Some(side)) if side != Side::of_push(value) => {
            "must be positive with side='cb', and negative with side='cf'"
        }
        (true, _) => return Ok(Side::of_push(value)),
        (false, _) if !(value > 0.0 && value.is_finite()) => "must be more than 0",
        (false, None) => "needs a side, 'cb' or 'cf'",
        (false, Some(side)) => return Ok(side),
    };
    Err(PyValueError::new_err(format!("target = {value}: {must}")))
}
