//! Courses of whiskers in time, and forces from the change of curvature, as columns.

use crate::arguments;
use crate::columns::{Column, Table};
use crate::errors::of_state;
use crate::scene::CheckedScene;
use crate::threads;
use crate::traces::{at_pole, single};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use whiskmap::force::{
    BaseAxis, CurvatureFrames, ForceMethod, ForceOptions, FrameForce, forces_until,
    warnings as force_warnings,
};
use whiskmap::scene::Scene;
use whiskmap::texture::{
    AsperityStay, TextureError, TextureEvent, TextureSample, TipBin, texture_until,
};
use whiskmap::whisk::{
    AngleCourse, CourseStart, WhiskError, WhiskEvent, WhiskOptions, WhiskSample, whisk_with,
};
use whiskmap::yields::StrainMark;

/// Columns of samples and events, lost and dissipated energy in nJ, angle of the first touch on CF in degrees, and warnings.
type WhiskColumns<'py> = (Vec<Column<'py>>, Vec<Column<'py>>, f64, f64, f64, Vec<String>);

/// Times in s and angles of the base in degrees, `[sample]`.
type TimesAndAngles<'py> = (PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>);

/// Computes the course of the scene's only whisker in front of one pole, with the angles of the base at these times, NaN where one is missing.
/// `start` names the state in which it begins. Gaps of at most `bridge_s`, in s, are bridged. Samples have the
/// curvature at the arclength `curvature_at_mm`, if it is given.
#[pyfunction]
pub fn whisk<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    distance_mm: f64,
    times_and_angles: TimesAndAngles<'py>,
    start: Option<&str>,
    bridge_s: f64,
    curvature_at_mm: Option<f64>,
) -> PyResult<WhiskColumns<'py>> {
    if !(0.0..f64::INFINITY).contains(&bridge_s) {
        let why = format!("bridge_s = {bridge_s}: must be at least 0, and finite");
        return Err(refused(&why));
    }
    let scene = at_pole(py, scene, distance_mm)?;
    let (time_s, angle_deg) = times_and_angles;
    let course = course(&time_s, &angle_deg)?;
    let start =
        start.map(|name| arguments::named("start", name, CourseStart::ALL, CourseStart::name));
    let start = start.transpose()?;
    let job = |cancel: &Arc<AtomicBool>| {
        let mut options = WhiskOptions::default();
        (options.start, options.cancel) = (start, Some(Arc::clone(cancel)));
        (options.bridge_s, options.curvature_at_mm) = (bridge_s, curvature_at_mm);
        let found = whisk_with(&scene.whisker, &scene.pole, distance_mm, &course, &options)?;
        let marks = StrainMark::of_rows(&scene.whisker, &scene.pole, &found.samples);
        let samples = Table::new(&found.samples, WhiskSample::COLUMNS, cancel);
        let samples = samples.marked(marks, StrainMark::COLUMNS, cancel);
        let events = Table::new(&found.events, WhiskEvent::COLUMNS, cancel);
        Ok((found, samples, events))
    };
    let found = threads::run(py, None, |_| Ok(()), job)?;
    let (found, samples, events) = found.map_err(|why: WhiskError| match why {
        WhiskError::Pole(why) => of_state(why),
        WhiskError::Unresolved(_) => PyRuntimeError::new_err(why.to_string()),
        why => refused(&why),
    })?;
    Ok((
        samples.into_columns(py)?,
        events.into_columns(py)?,
        found.lost_nj(),
        found.dissipated_nj(),
        found.cf_touch_deg,
        found.warnings(),
    ))
}

/// Columns of samples, events, stays and of the histogram of the tip, lost energy in nJ, number of asperities within reach, and a warning.
type TextureColumns<'py> = (
    Vec<Column<'py>>,
    Vec<Column<'py>>,
    Vec<Column<'py>>,
    Vec<Column<'py>>,
    f64,
    usize,
    Option<String>,
);

/// Computes the course of the scene's only whisker behind its surface, with the angles of the base at these times. Samples have the curvature at
/// the arclength `curvature_at_mm`, if it is given.
#[pyfunction]
pub fn texture<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    time_s: PyReadonlyArray1<'py, f64>,
    angle_deg: PyReadonlyArray1<'py, f64>,
    curvature_at_mm: Option<f64>,
) -> PyResult<TextureColumns<'py>> {
    let scene = &scene.0;
    single(scene)?;
    let surface = scene.surface.ok_or_else(|| {
        PyValueError::new_err(
            "scene: has no surface; scene.replace(surface=wm.Surface(...)) adds one",
        )
    })?;
    without_friction(scene, "asperities have no friction in this model")?;
    let course = course(&time_s, &angle_deg)?;
    let job = |cancel: &Arc<AtomicBool>| {
        let found = texture_until(&scene.whisker, &surface, &course, curvature_at_mm, cancel)?;
        let marks = StrainMark::of_rows(&scene.whisker, &surface.asperity(), &found.samples);
        let samples = Table::new(&found.samples, TextureSample::COLUMNS, cancel);
        let tables = [
            samples.marked(marks, StrainMark::COLUMNS, cancel),
            Table::new(&found.events, TextureEvent::COLUMNS, cancel),
            Table::new(&found.stays(), AsperityStay::COLUMNS, cancel),
            Table::new(&found.tip_histogram(), TipBin::COLUMNS, cancel),
        ];
        Ok((found, tables))
    };
    let found = threads::run(py, None, |_| Ok(()), job)?;
    let (found, [samples, events, stays, histogram]) =
        found.map_err(|why: TextureError| match why {
            TextureError::Unresolved { .. } => PyRuntimeError::new_err(why.to_string()),
            why => refused(&why),
        })?;
    Ok((
        samples.into_columns(py)?,
        events.into_columns(py)?,
        stays.into_columns(py)?,
        histogram.into_columns(py)?,
        found.lost_nj(),
        found.reached,
        found.warning(),
    ))
}

/// Mean and scatter of the curvature of frames without contact, in 1/mm, and their number.
type Baseline = (f64, f64, usize);

/// Columns of forces, warnings, and the baseline.
type ForceColumns<'py> = (Vec<Column<'py>>, Vec<String>, Option<Baseline>);

/// Computes the forces in the frames of the CSV table `frames`, which messages call `origin`. The baseline comes from frames in
/// `baseline_s`, or from frames without contact in the column `contact`.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "one argument of Python each")]
pub fn force<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    frames: &str,
    origin: &str,
    columns: Vec<(String, String)>,
    model: bool,
    baseline_s: Option<[f64; 2]>,
    axis: &str,
) -> PyResult<ForceColumns<'py>> {
    let scene = &scene.0;
    single(scene)?;
    without_friction(scene, "the force is taken as normal to the whisker")?;
    let method = match model {
        true => ForceMethod::Model,
        false => ForceMethod::Lever,
    };
    let whisker = scene.first_whisker().whisker;
    let table = arguments::table(frames, origin, columns, &CurvatureFrames::COLUMNS);
    let read = table
        .and_then(|table| CurvatureFrames::of(&table, whisker.length_mm, method))
        .map_err(|why| refused(&why))?;
    let estimated = read.baseline(&whisker, baseline_s);
    let baseline = estimated.map_err(|why| refused(&why))?;
    let deviations = scene.uncertainty.as_ref().map(|deviations| deviations.frames);
    let options = ForceOptions {
        baseline,
        deviations: deviations.unwrap_or_default(),
        axis: arguments::named("axis", axis, BaseAxis::ALL, BaseAxis::name)?,
        ..ForceOptions::new(method)
    };
    let job = |cancel: &Arc<AtomicBool>| {
        let found = forces_until(&whisker, &scene.pole, &read.frames, &options, cancel);
        let marks = match method {
            ForceMethod::Model => StrainMark::of_rows(&whisker, &scene.pole, &found),
            ForceMethod::Lever => None,
        };
        let table = Table::new(&found, FrameForce::COLUMNS, cancel);
        let table = table.marked(marks, StrainMark::COLUMNS, cancel);
        (table, force_warnings(&whisker, &found))
    };
    let (table, warnings) = threads::run(py, None, |_| Ok(()), job)?;
    let baseline =
        baseline.map(|baseline| (baseline.mean_per_mm, baseline.sd_per_mm, baseline.count));
    Ok((table.into_columns(py)?, warnings, baseline))
}

fn course(
    time_s: &PyReadonlyArray1<'_, f64>,
    angle_deg: &PyReadonlyArray1<'_, f64>,
) -> PyResult<AngleCourse> {
    let [times, angles] = [time_s, angle_deg].map(|array| array.as_array().to_vec());
    AngleCourse::new(times, angles).map_err(|why| refused(&why))
}

pub fn refused(why: &impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(why.to_string())
}

pub fn without_friction(scene: &Scene, because: &str) -> PyResult<()> {
    match scene.pole.friction {
        0.0 => Ok(()),
        friction => Err(refused(&format!("friction = {friction}: must be 0, because {because}"))),
    }
}
