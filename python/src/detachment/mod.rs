//! Detachments of many whiskers at many distances, on all threads.

mod rows;

use crate::arguments::{parameter, refused};
use crate::errors::of_scene;
use crate::scene::CheckedScene;
use crate::threads::{self, ThreadCount};
use crate::traces::single;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use rows::{DetachmentRows, RefusedRow, RowEnd};
use std::collections::BTreeMap;
use whiskmap::scene::{Parameter, Scene};
use whiskmap::sensitivity::Derivatives;
use whiskmap::trace::{Detachment, DetachmentKind};

/// Name of a quantity, its value, and its derivative.
type Quantity = (&'static str, fn(&Detachment) -> Option<f64>, fn(&Derivatives) -> f64);

/// Defines the quantities of an end that have derivatives, by the names of their fields.
macro_rules! quantities {
    ($($name:ident),*) => { [$((stringify!($name), |end| end.$name, |by| by.$name)),*] };
}

const QUANTITIES: [Quantity; 11] = quantities![
    push_angle_deg,
    push_chord_deg,
    contact_distance_mm,
    arc_length_mm,
    contact_angle_deg,
    force_un,
    contact_force_un,
    base_force_x_un,
    base_force_y_un,
    base_moment_nnm,
    energy_nj
];

/// Name, values `[row]` and derivatives `[row][variable]` of a quantity; NaN where there is none.
type QuantityArrays<'py> = (&'static str, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// Kinds of the ends, residuals, push angles up to which a whisker may snap, and largest strains of pushes of a scene with a yield strain.
/// Then quantities, and exceptions of refused rows in order.
type DetachmentArrays<'py> = (
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Vec<QuantityArrays<'py>>,
    Vec<PyErr>,
);

/// Computes one detachment for each row, from numbers that are `fixed` and others that are `varying`, `[row]`. Derivatives are by `variables`.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "one argument of Python each")]
pub fn detachment<'py>(
    py: Python<'py>,
    scene: Option<PyRef<'py, CheckedScene>>,
    fixed: BTreeMap<String, f64>,
    varying: BTreeMap<String, PyReadonlyArray1<'py, f64>>,
    distance_mm: PyReadonlyArray1<'py, f64>,
    is_cb: PyReadonlyArray1<'py, bool>,
    variables: Vec<String>,
    threads: Option<Bound<'py, PyAny>>,
) -> PyResult<DetachmentArrays<'py>> {
    let threads = ThreadCount::of(threads.as_ref())?;
    let mut base = match &scene {
        Some(scene) => {
            single(&scene.0)?;
            scene.0.to_builder()
        }
        None => Scene::builder("detachment"),
    };
    let is_marked = scene.is_some_and(|scene| scene.0.whisker.yield_strain.is_some());
    for (name, value) in &fixed {
        base = base.set(parameter("argument", name)?, *value);
    }
    let columns =
        varying.iter().map(|(name, values)| Ok((parameter("argument", name)?, values.as_slice()?)));
    let variable = |name: String| name.parse().map_err(|must: String| refused("jac", &name, &must));
    let taper = Parameter::Taper.name();
    let rows = DetachmentRows {
        base: base.push_angle_deg([0.0]),
        varying: columns.collect::<PyResult<_>>()?,
        distance_mm: distance_mm.as_slice()?,
        is_cb: is_cb.as_slice()?,
        variables: variables.into_iter().map(variable).collect::<PyResult<_>>()?,
        have_taper: fixed.contains_key(taper) || varying.contains_key(taper),
    };
    let (count, width) = (rows.distance_mm.len(), rows.variables.len());
    let (ends, refused) = threads::run(py, threads, |_| Ok(()), |cancel| rows.ends(cancel))?;
    let refused = refused.iter().map(|refused| of_row(py, refused));
    let mut kinds = vec![DetachmentKind::NoWhisker as u8; count];
    for row_end in &ends {
        kinds[row_end.row] = row_end.end.kind as u8;
    }
    let of_rows = |value: &dyn Fn(&RowEnd) -> Option<f64>| {
        let mut values = vec![f64::NAN; count];
        for row_end in &ends {
            values[row_end.row] = value(row_end).unwrap_or(f64::NAN);
        }
        PyArray1::from_vec(py, values)
    };
    let values = |value: fn(&Detachment) -> Option<f64>| of_rows(&|row_end| value(&row_end.end));
    let quantities = QUANTITIES.map(|(name, value, derivative)| {
        let mut by = vec![f64::NAN; count * width];
        for row_end in &ends {
            for (place, derivatives) in by[row_end.row * width..].iter_mut().zip(&row_end.by) {
                *place = derivatives.as_ref().map_or(f64::NAN, derivative);
            }
        }
        (name, values(value), PyArray1::from_vec(py, by))
    });
    let kinds = PyArray1::from_vec(py, kinds);
    let snaps = values(|end| end.snaps_deg);
    let residuals = values(|end| end.residual);
    let strains = is_marked.then(|| of_rows(&|row_end| row_end.mark?.max_strain));
    Ok((kinds, residuals, snaps, strains, quantities.into(), refused.collect()))
}

/// Returns the exception of a refused row, with its index as the attribute `element`.
fn of_row(py: Python<'_>, refused: &RefusedRow) -> PyErr {
    let exception = of_scene(py, &refused.why);
    let named = exception.value(py).setattr("element", refused.row);
    named.map_or_else(|why| why, |()| exception)
}
