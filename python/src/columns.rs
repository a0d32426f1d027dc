//! Tables of the library as columns.

use crate::about::units;
use numpy::PyArray1;
use pyo3::prelude::*;
use serde::Serialize;
use serde_json::Value;

/// Columns that have texts; an empty text stands for none.
const TEXTS: [&str; 11] = [
    "side",
    "kind",
    "predicted_kind",
    "sliding",
    "mark",
    "part",
    "reason",
    "regime",
    "event",
    "phase",
    "end",
];

/// Name, values, unit and meaning of a column.
pub type Column<'py> = (
    &'static str,
    Bound<'py, PyAny>,
    Option<&'static str>,
    String,
);

/// Returns the columns of a table: numbers as arrays of `f64`, NaN where there is none, truths as arrays of `bool`, and lists of texts.
pub fn columns<'py, Row: Serialize>(
    py: Python<'py>,
    rows: &[Row],
    about: &[(&'static str, &'static str)],
) -> PyResult<Vec<Column<'py>>> {
    let rows: Vec<Value> = rows
        .iter()
        .map(|row| serde_json::to_value(row).unwrap_or_default())
        .collect();
    let column = |&(name, meaning): &(&'static str, &'static str)| {
        let cells = rows.iter().map(|row| &row[name]);
        let meaning = meaning.trim().to_owned();
        if TEXTS.contains(&name) {
            let texts: Vec<&str> = cells
                .map(|cell| cell.as_str().unwrap_or_default())
                .collect();
            return Ok((name, texts.into_pyobject(py)?.into_any(), None, meaning));
        }
        if rows.first().is_some_and(|row| row[name].is_boolean()) {
            let truths = cells.map(|cell| cell.as_bool().unwrap_or_default());
            return Ok((
                name,
                PyArray1::from_iter(py, truths).into_any(),
                None,
                meaning,
            ));
        }
        let numbers = cells
            .map(|cell| cell.as_f64().unwrap_or(f64::NAN))
            .collect();
        Ok((
            name,
            PyArray1::<f64>::from_vec(py, numbers).into_any(),
            Some(units(name)),
            meaning,
        ))
    };
    about.iter().map(column).collect()
}
