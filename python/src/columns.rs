//! Tables of the library as columns.

use crate::about::units;
use numpy::PyArray1;
use pyo3::prelude::*;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;
use std::sync::atomic::{AtomicBool, Ordering};

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

/// Columns that are true or false, and have no value in rows without a state.
const TRUTHS: [&str; 1] = ["yields"];

/// Number of rows that are converted between two looks at the flag that cancels.
const ROWS_AT_ONCE: usize = 1 << 13;

/// Name, values, unit and meaning of a column.
pub type Column<'py> = (&'static str, Bound<'py, PyAny>, Option<&'static str>, String);

/// Values of a column, `[row]`.
enum Values {
    Texts(Vec<String>),
    Truths(Vec<bool>),
    Numbers(Vec<f64>),
}

/// Table of the library as columns, without objects of Python. It is made on the threads of a computation.
pub struct Table {
    columns: Vec<(&'static str, Values, &'static str)>,
}

impl Table {
    /// Creates the columns of `rows`: numbers are NaN where there is none. After a cancellation, rows are missing.
    pub fn new<Row: Serialize + Sync>(
        rows: &[Row],
        about: &[(&'static str, &'static str)],
        cancel: &AtomicBool,
    ) -> Self {
        let value = |row: &Row| serde_json::to_value(row).unwrap_or_default();
        let first = rows.first().map(value).unwrap_or_default();
        let empty = |&(name, meaning): &(&'static str, &'static str)| {
            let values = match &first[name] {
                _ if TEXTS.contains(&name) => Values::Texts(Vec::new()),
                _ if TRUTHS.contains(&name) => Values::Truths(Vec::new()),
                Value::Bool(_) => Values::Truths(Vec::new()),
                _ => Values::Numbers(Vec::with_capacity(rows.len())),
            };
            (name, values, meaning.trim())
        };
        let mut columns: Vec<_> = about.iter().map(empty).collect();
        for rows in rows.chunks(ROWS_AT_ONCE) {
            if cancel.load(Ordering::Relaxed) {
                break;
            }
            let rows: Vec<Value> = rows.par_iter().map(value).collect();
            columns.par_iter_mut().for_each(|(name, values, _)| {
                let cells = rows.iter().map(|row| &row[*name]);
                match values {
                    Values::Texts(texts) => {
                        texts
                            .extend(cells.map(|cell| cell.as_str().unwrap_or_default().to_owned()));
                    }
                    Values::Truths(truths) => {
                        truths.extend(cells.map(|cell| cell.as_bool().unwrap_or_default()));
                    }
                    Values::Numbers(numbers) => {
                        numbers.extend(cells.map(|cell| cell.as_f64().unwrap_or(f64::NAN)));
                    }
                }
            });
        }
        Self { columns }
    }

    /// Adds the columns of marks, `[row]`; `None` adds none.
    pub fn marked<Mark: Serialize + Sync>(
        mut self,
        marks: Option<Vec<Mark>>,
        about: &[(&'static str, &'static str)],
        cancel: &AtomicBool,
    ) -> Self {
        if let Some(marks) = marks {
            self.columns.extend(Self::new(&marks, about, cancel).columns);
        }
        self
    }

    /// Returns the columns as arrays of `f64` or `bool`, and lists of texts.
    pub fn into_columns(self, py: Python<'_>) -> PyResult<Vec<Column<'_>>> {
        let column = |(name, values, meaning): (&'static str, Values, &'static str)| {
            let (values, unit) = match values {
                Values::Texts(texts) => (texts.into_pyobject(py)?.into_any(), None),
                Values::Truths(truths) => (PyArray1::from_vec(py, truths).into_any(), None),
                Values::Numbers(numbers) => {
                    let unit = Some(units(name));
                    (PyArray1::from_vec(py, numbers).into_any(), unit)
                }
            };
            Ok((name, values, unit, meaning.to_owned()))
        };
        self.columns.into_iter().map(column).collect()
    }
}
