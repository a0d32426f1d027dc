//! Arguments of functions: sides, parameters and engines by name, and options of maps.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use std::ops::RangeInclusive;
use whiskmap::Side;
use whiskmap::accuracy::TOLERANCE_DEG;
use whiskmap::input::{ColumnName, CsvError, CsvTable, did_you_mean};
use whiskmap::scene::{Parameter, digits};
use whiskmap::{Channels, MapEngine, Options, Precision};

/// Returns the side with this name, in capitals or not.
pub fn side(name: &str) -> PyResult<Side> {
    match &*name.to_lowercase() {
        "cb" => Ok(Side::Cb),
        "cf" => Ok(Side::Cf),
        _ => Err(refused("side", name, "must be 'cb' or 'cf'")),
    }
}

/// Returns the whole number `given`, the value of `argument`, if it is in the range.
pub fn whole(
    argument: &str,
    given: &Bound<'_, PyAny>,
    range: &RangeInclusive<u32>,
) -> PyResult<usize> {
    let (least, most) = (range.start(), range.end());
    let must = || {
        let value = given.repr()?;
        Ok::<_, PyErr>(format!(
            "{argument} = {value}: must be a whole number between {least} and {most}"
        ))
    };
    let is_whole = !given.is_instance_of::<PyBool>() && given.hasattr("__index__")?;
    if !is_whole {
        return Err(PyTypeError::new_err(must()?));
    }
    match given.extract::<u32>() {
        Ok(number) if range.contains(&number) => Ok(number as usize),
        _ => Err(PyValueError::new_err(must()?)),
    }
}

/// Returns the one of `values` whose name is `given`, the value of `argument`.
pub fn named<T: Copy, const N: usize>(
    argument: &str,
    given: &str,
    values: [T; N],
    name: fn(T) -> &'static str,
) -> PyResult<T> {
    let value = values.into_iter().find(|value| name(*value) == given);
    value.ok_or_else(|| {
        let names = values.map(|value| format!("'{}'", name(value)));
        refused(argument, given, &format!("must be one of {}", names.join(", ")))
    })
}

/// Returns the CSV table in `text`, which messages call `origin`, with expected names of columns in place of the names in the file. Each of
/// the `columns` has both names: `[column]`.
pub fn table(
    text: &str,
    origin: &str,
    columns: Vec<(String, String)>,
    known: &[&str],
) -> Result<CsvTable, CsvError> {
    let names = columns.into_iter().map(|(expected, in_file)| ColumnName { expected, in_file });
    CsvTable::parse(text, origin)?.renamed(&names.collect::<Vec<_>>(), known)
}

/// Returns the parameter with this name; `argument` is the one that gives it.
pub fn parameter(argument: &str, name: &str) -> PyResult<Parameter> {
    Parameter::named(name).ok_or_else(|| {
        let known = Parameter::ALL.map(Parameter::name);
        let hint = Parameter::suggested(name).unwrap_or_else(|| did_you_mean(name, known));
        refused(argument, name, &format!("must be one of {}{hint}", known.join(", ")))
    })
}

/// Returns the options of a map: engine and channels by name, and the maximum push-angle error in degrees.
pub fn options(
    engine_name: &str,
    tolerance_deg: Option<f64>,
    names: Option<Vec<String>>,
) -> PyResult<Options> {
    let mut options = Options::default();
    options.engine = engine(engine_name)?;
    options.tolerance_deg = tolerance(tolerance_deg)?;
    options.channels = names.map(|names| channels(&names)).transpose()?;
    Ok(options)
}

/// Returns the engine with this name.
fn engine(name: &str) -> PyResult<MapEngine> {
    match name {
        "auto" => Ok(MapEngine::Auto),
        "cpu" => Ok(MapEngine::Cpu),
        "spectral" => Ok(MapEngine::Spectral),
        "gpu" => Ok(MapEngine::Gpu(Precision::F32)),
        _ => Err(refused("engine", name, "must be 'auto', 'cpu', 'spectral' or 'gpu'")),
    }
}

/// Returns the selection of these channels.
fn channels(names: &[String]) -> PyResult<Channels> {
    let selected = names.join(",").parse();
    selected.map_err(|must: String| refused("channels", &names.join(", "), &must))
}

/// Returns the maximum push-angle error, if it is allowed.
pub fn tolerance(degrees: Option<f64>) -> PyResult<Option<f64>> {
    match degrees {
        Some(degrees) if !TOLERANCE_DEG.contains(&degrees) => {
            let [least, most] =
                [TOLERANCE_DEG.start(), TOLERANCE_DEG.end()].map(|end| digits(*end));
            let must = format!("tolerance_deg = {degrees}: must be between {least} and {most}");
            Err(PyValueError::new_err(must))
        }
        _ => Ok(degrees),
    }
}

/// Returns the exception of a refused text.
pub fn refused(argument: &str, value: &str, must: &str) -> PyErr {
    PyValueError::new_err(format!("{argument} = '{value}': {must}"))
}
