//! Courses of whiskers in time, and forces from the change of curvature, as columns.

use crate::columns::{Column, columns};
use crate::errors::of_state;
use crate::scene::CheckedScene;
use crate::threads;
use crate::traces::{at_pole, single};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::sync::Arc;
use whiskmap::force::{CurvatureFrames, ForceMethod, FrameForce, forces};
use whiskmap::scene::Scene;
use whiskmap::texture::{
    AsperityStay, TextureError, TextureEvent, TextureSample, TipBin, texture as texture_of,
};
use whiskmap::whisk::{AngleCourse, WhiskError, WhiskEvent, WhiskSample, whisk as whisk_of};

/// Columns of samples and events, lost and dissipated energy in nJ, and angle of the first touch on CF in degrees.
type WhiskColumns<'py> = (Vec<Column<'py>>, Vec<Column<'py>>, f64, f64, f64);

/// Computes the course of the scene's only whisker in front of one pole, with the angles of the base at these times.
#[pyfunction]
pub fn whisk<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    distance_mm: f64,
    time_s: PyReadonlyArray1<'py, f64>,
    angle_deg: PyReadonlyArray1<'py, f64>,
) -> PyResult<WhiskColumns<'py>> {
    let scene = at_pole(py, scene, distance_mm)?;
    let course = course(&time_s, &angle_deg)?;
    let job = |_: &Arc<_>| whisk_of(&scene.whisker, &scene.pole, distance_mm, &course);
    let found = threads::run(py, None, |_| Ok(()), job)?.map_err(|why| match why {
        WhiskError::Pole(why) => of_state(why),
        WhiskError::Unresolved(_) => PyRuntimeError::new_err(why.to_string()),
        why => refused(&why),
    })?;
    Ok((
        columns(py, &found.samples, WhiskSample::COLUMNS)?,
        columns(py, &found.events, WhiskEvent::COLUMNS)?,
        found.lost_nj(),
        found.dissipated_nj(),
        found.cf_touch_deg,
    ))
}

/// Columns of samples, events, stays and of the histogram of the tip, lost energy in nJ, and number of asperities within reach.
type TextureColumns<'py> = (
    Vec<Column<'py>>,
    Vec<Column<'py>>,
    Vec<Column<'py>>,
    Vec<Column<'py>>,
    f64,
    usize,
);

/// Computes the course of the scene's only whisker behind its surface, with the angles of the base at these times.
#[pyfunction]
pub fn texture<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    time_s: PyReadonlyArray1<'py, f64>,
    angle_deg: PyReadonlyArray1<'py, f64>,
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
    let job = |_: &Arc<_>| texture_of(&scene.whisker, &surface, &course);
    let found = threads::run(py, None, |_| Ok(()), job)?.map_err(|why| match why {
        TextureError::Unresolved { .. } => PyRuntimeError::new_err(why.to_string()),
        why => refused(&why),
    })?;
    Ok((
        columns(py, &found.samples, TextureSample::COLUMNS)?,
        columns(py, &found.events, TextureEvent::COLUMNS)?,
        columns(py, &found.stays(), AsperityStay::COLUMNS)?,
        columns(py, &found.tip_histogram(), TipBin::COLUMNS)?,
        found.lost_nj(),
        found.reached,
    ))
}

/// Computes the forces in the frames of the CSV table `frames`.
#[pyfunction]
pub fn force<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    frames: &str,
    model: bool,
) -> PyResult<Vec<Column<'py>>> {
    let scene = &scene.0;
    single(scene)?;
    without_friction(scene, "the force is taken as normal to the whisker")?;
    let method = match model {
        true => ForceMethod::Model,
        false => ForceMethod::Lever,
    };
    let whisker = scene.first_whisker().whisker;
    let read = CurvatureFrames::parse(frames, "frames", whisker.length_mm, method);
    let read = read.map_err(|why| refused(&why))?;
    let job = |_: &Arc<_>| forces(&whisker, &scene.pole, &read.frames, method);
    let found = threads::run(py, None, |_| Ok(()), job)?;
    columns(py, &found, FrameForce::COLUMNS)
}

fn course(
    time_s: &PyReadonlyArray1<'_, f64>,
    angle_deg: &PyReadonlyArray1<'_, f64>,
) -> PyResult<AngleCourse> {
    let [times, angles] = [time_s, angle_deg].map(|own| own.as_array().to_vec());
    AngleCourse::new(times, angles).map_err(|why| refused(&why))
}

fn refused(why: &impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(why.to_string())
}

fn without_friction(scene: &Scene, because: &str) -> PyResult<()> {
    match scene.pole.friction {
        0.0 => Ok(()),
        friction => Err(refused(&format!(
            "friction = {friction}: must be 0, because {because}"
        ))),
    }
}
