//! Detachment curves, branches and shapes as columns.

use crate::arguments;
use crate::columns::{Column, Table};
use crate::errors::{of_front, of_scene, of_state};
use crate::scene::CheckedScene;
use crate::threads::{self, ThreadCount};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap::Side;
use whiskmap::scene::{Scene, SweepPlace};
use whiskmap::trace::{BRANCH_POINTS, Branch, BranchPoint, Detachment, SHAPE_POINTS, ShapePoint};
use whiskmap::yields::{PushMark, YieldMark};
use whiskmap::{Options, branch as branch_of};

/// Computes the detachments of all whiskers: whisker by whisker, CF before CB, by distance.
#[pyfunction]
pub fn curve<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    tolerance_deg: Option<f64>,
    threads: Option<Bound<'py, PyAny>>,
) -> PyResult<Vec<Column<'py>>> {
    let threads = ThreadCount::of(threads.as_ref())?;
    let mut options = Options::default();
    options.tolerance_deg = arguments::tolerance(tolerance_deg)?;
    let job = |cancel: &Arc<AtomicBool>| {
        options.cancel = Some(Arc::clone(cancel));
        let ends = whiskmap::curve(&scene.0, options)?;
        let marks = scene.0.has_yield_strain().then(|| {
            let ends = ends.par_iter().filter(|_| !cancel.load(Ordering::Relaxed));
            let mark = |(place, end): &(SweepPlace, Detachment)| {
                let swept = scene.0.whisker_at(place.clone()).ok()?;
                PushMark::of_end(&swept.whisker, &swept.pole, end)
            };
            ends.map(|end| mark(end).unwrap_or_default()).collect()
        });
        let ends: Vec<Detachment> = ends.into_iter().map(|(_, end)| end).collect();
        let table = Table::new(&ends, Detachment::COLUMNS, cancel);
        Ok(table.marked::<PushMark>(marks, PushMark::COLUMNS, cancel))
    };
    let table = threads::run(py, threads, |_| Ok(()), job)?;
    table.map_err(|why| of_front(&why))?.into_columns(py)
}

/// Computes `points` points of the branch of the scene's only whisker at one pole.
#[pyfunction]
pub fn branch<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    distance_mm: f64,
    side: &str,
    points: &Bound<'py, PyAny>,
) -> PyResult<Vec<Column<'py>>> {
    let side = arguments::side(side)?;
    let points = arguments::whole("points", points, &BRANCH_POINTS)?;
    let scene = at_pole(py, scene, distance_mm)?;
    let job = |cancel: &Arc<AtomicBool>| {
        let points = branch_of(&scene, distance_mm, side)?.points_until(points, cancel)?;
        let marks =
            YieldMark::of_rows(&scene.whisker, points.iter().map(|point| point.peak_strain));
        let table = Table::new(&points, BranchPoint::COLUMNS, cancel);
        Ok(table.marked(marks, YieldMark::COLUMNS, cancel))
    };
    let table = threads::run(py, None, |_| Ok(()), job)?;
    table.map_err(of_state)?.into_columns(py)
}

/// Columns of the points of a shape, centre and radius of the pole in mm, residual, and the columns of the state, of one row.
type ShapeColumns<'py> = (Vec<Column<'py>>, [f64; 2], f64, f64, Vec<Column<'py>>);

/// Computes the shape of the scene's only whisker in one state, at `points` points and at the contact.
#[pyfunction]
pub fn shape<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    distance_mm: f64,
    push_angle_deg: f64,
    stable: bool,
    points: &Bound<'py, PyAny>,
) -> PyResult<ShapeColumns<'py>> {
    let points = arguments::whole("points", points, &SHAPE_POINTS)?;
    if !(-360.0..=360.0).contains(&push_angle_deg) {
        let must = format!("push_angle_deg = {push_angle_deg}: must be between -360 and 360");
        return Err(PyValueError::new_err(must));
    }
    let scene = at_pole(py, scene, distance_mm)?;
    let job = |cancel: &Arc<AtomicBool>| {
        let side = Side::of_push(push_angle_deg);
        let pushed = (&scene.whisker, &scene.pole, side);
        let push = push_angle_deg.to_radians();
        let (branch, state) = Branch::at_push(pushed, distance_mm, push, stable)?;
        let shape = branch.shape(&state, points);
        let marks =
            YieldMark::of_rows(&scene.whisker, shape.points.iter().map(|point| point.strain));
        let point_table = Table::new(&shape.points, ShapePoint::COLUMNS, cancel);
        let point_table = point_table.marked(marks, YieldMark::COLUMNS, cancel);
        let mark = YieldMark::of_rows(&scene.whisker, [shape.state.peak_strain]);
        let state_table = Table::new(&[shape.state], BranchPoint::COLUMNS, cancel);
        let state_table = state_table.marked(mark, YieldMark::COLUMNS, cancel);
        Ok((shape, point_table, state_table))
    };
    let found = threads::run(py, None, |_| Ok(()), job)?;
    let (shape, points, state) = found.map_err(of_state)?;
    Ok((
        points.into_columns(py)?,
        shape.pole_mm,
        shape.pole_radius_mm,
        shape.residual,
        state.into_columns(py)?,
    ))
}

/// Returns the scene with the pole of this distance alone, if it has one whisker.
pub fn at_pole(py: Python<'_>, scene: &CheckedScene, distance_mm: f64) -> PyResult<Scene> {
    single(&scene.0)?;
    let scene = scene.0.to_builder().distance_mm([distance_mm]).build();
    scene.map_err(|why| of_scene(py, &why))
}

/// Refuses a scene with several whiskers.
pub fn single(scene: &Scene) -> PyResult<()> {
    let whiskers = scene.whisker_count();
    if whiskers == 1 {
        return Ok(());
    }
    let axes = scene.grid.sweep_names();
    Err(PyValueError::new_err(format!(
        "scene: sweeps {whiskers} whiskers along {axes}, must have one; scene.replace(...) gives an axis one number"
    )))
}
