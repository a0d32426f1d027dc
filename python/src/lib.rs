//! Extension module `whiskmap._whiskmap`: the library in terms of plain Python values and numpy arrays.
//!
//! The package in `python/whiskmap` gives them names, units and documentation. Nothing here prints, and every error is an exception.

mod about;
mod arguments;
mod columns;
mod command;
mod detachment;
mod errors;
mod fits;
mod lazy;
mod locate;
mod maps;
mod motion;
mod plan;
mod scene;
mod stored;
mod threads;
mod traces;
mod tracking;

/// Functions and classes of the module; `_whiskmap.pyi` has their types.
#[pyo3::pymodule(gil_used = false)]
mod _whiskmap {
    #[pymodule_export]
    use super::about::{
        arithmetic, axis_title, channel_attributes, channels, coordinates, inks, parameters,
        regimes, variables, version,
    };
    #[pymodule_export]
    use super::command::run_command;
    #[pymodule_export]
    use super::detachment::detachment;
    #[pymodule_export]
    use super::errors::{SceneError, StateError};
    #[pymodule_export]
    use super::fits::{design, designs, fit};
    #[pymodule_export]
    use super::lazy::ComputedMap;
    #[pymodule_export]
    use super::locate::locate;
    #[pymodule_export]
    use super::maps::map;
    #[pymodule_export]
    use super::motion::{force, texture, whisk};
    #[pymodule_export]
    use super::plan::plan;
    #[pymodule_export]
    use super::scene::{CheckedScene, unused_columns};
    #[pymodule_export]
    use super::stored::StoredMap;
    #[pymodule_export]
    use super::traces::{branch, curve, shape};
    #[pymodule_export]
    use super::tracking::read_tracking;
}
