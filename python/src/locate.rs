//! Contacts from moment and force at the base, as columns.

use crate::arguments;
use crate::columns::{Column, Table};
use crate::motion::{refused, without_friction};
use crate::scene::CheckedScene;
use crate::threads;
use crate::traces::single;
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use whiskmap::locate::{BaseReadings, LocatedState, Locator, SensorDeviations, warning};
use whiskmap::yields::StrainMark;

/// Columns of located states, and a warning.
type LocateColumns<'py> = (Vec<Column<'py>>, Option<String>);

/// Locates the contacts of the readings in the CSV table `readings`, which messages call `origin`. The sensor has these standard deviations
/// of moment (nN m) and force (uN).
#[pyfunction]
pub fn locate<'py>(
    py: Python<'py>,
    scene: &CheckedScene,
    readings: &str,
    origin: &str,
    columns: Vec<(String, String)>,
    deviations: Option<(f64, f64)>,
) -> PyResult<LocateColumns<'py>> {
    let scene = &scene.0;
    single(scene)?;
    without_friction(scene, "the force is taken as normal to the whisker")?;
    let table = arguments::table(readings, origin, columns, &BaseReadings::COLUMNS);
    let read = table.and_then(|table| BaseReadings::of(&table)).map_err(|why| refused(&why))?;
    let deviations =
        deviations.map(|(moment_nnm, force_un)| SensorDeviations { moment_nnm, force_un });
    let job = |cancel: &Arc<AtomicBool>| {
        let locator = Locator::new(&scene.first_whisker().whisker, &scene.pole);
        let located = locator.locate_until(&read.readings, deviations, cancel);
        let marks = StrainMark::of_rows(&scene.first_whisker().whisker, &scene.pole, &located);
        let table = Table::new(&located, LocatedState::COLUMNS, cancel);
        let table = table.marked(marks, StrainMark::COLUMNS, cancel);
        (table, warning(&located))
    };
    let (table, warning) = threads::run(py, None, |_| Ok(()), job)?;
    Ok((table.into_columns(py)?, warning))
}
