//! Exceptions for the errors of the library.

use pyo3::exceptions::{PyMemoryError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::io;
use std::path::Path;
use whiskmap::plan::PlanError;
use whiskmap::store::StoreError;
use whiskmap::terminal::escaped;
use whiskmap::trace::NoState;
use whiskmap::{Error, scene};

pyo3::create_exception!(
    whiskmap,
    SceneError,
    PyValueError,
    "A scene is refused: `key`, `value` and `allowed` say what is wrong."
);
pyo3::create_exception!(
    whiskmap,
    StateError,
    PyValueError,
    "A state of the whisker does not exist: the message says how the whisker left the pole."
);

/// Returns the exception of a refused scene. Its attributes are texts, or `None`.
pub fn of_scene(py: Python<'_>, why: &scene::SceneError) -> PyErr {
    let text = why.to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text).to_owned();
    let exception = SceneError::new_err(text);
    let instance = exception.value(py);
    let attributes = [("key", why.key()), ("value", why.value()), ("allowed", why.allowed())];
    for (name, value) in attributes {
        if let Err(why) = instance.setattr(name, value) {
            return why;
        }
    }
    exception
}

/// Returns the exception of a computation in memory.
pub fn of_front(why: &Error) -> PyErr {
    let text = why.to_string();
    match why {
        Error::Plan(why) => of_plan(why),
        Error::Tolerance { .. } => PyValueError::new_err(text),
        _ => PyRuntimeError::new_err(text),
    }
}

/// Returns the exception of a map that cannot be planned: a `ValueError` for a derivative that the scene does not have, a `MemoryError` for a
/// map that is too large.
pub fn of_plan(why: &PlanError) -> PyErr {
    let text = why.to_string();
    if matches!(why, PlanError::NotGiven { .. }) {
        return PyValueError::new_err(text);
    }
    let hint = "; lower the counts of the axes, or write a store with `whiskmap map --format zarr` and open that";
    let text = text.split("; ").next().unwrap_or(&text);
    PyMemoryError::new_err(format!("{text}{hint}"))
}

/// Returns the exception of a state that does not exist.
pub fn of_state(why: NoState) -> PyErr {
    match why {
        NoState::Failed { .. } | NoState::Cancelled => PyRuntimeError::new_err(why.to_string()),
        _ => StateError::new_err(why.to_string()),
    }
}

/// Returns the exception of a file: an `OSError` if the system refuses it, a `ValueError` if it is no map or damaged.
pub fn of_store(why: &StoreError) -> PyErr {
    match why {
        StoreError::Read(path, cause) => of_io(path, cause),
        _ => PyValueError::new_err(escaped(&why.to_string())),
    }
}

/// Returns the `OSError` of the class that belongs to the system's error number.
pub fn of_io(path: &Path, cause: &io::Error) -> PyErr {
    let shown = path.to_string_lossy().into_owned();
    match cause.raw_os_error() {
        Some(code) => {
            // Python writes the number itself.
            let text = cause.to_string().replace(&format!(" (os error {code})"), "");
            PyOSError::new_err((code, text, shown))
        }
        None => PyOSError::new_err(format!("{shown}: {cause}")),
    }
}
