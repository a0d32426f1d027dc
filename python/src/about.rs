//! Names, units, meanings and colours that Rust defines.

use crate::scene::CheckedScene;
use numpy::PyArray1;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use whiskmap::input::Quantity;
use whiskmap::mechanics::numerics::ArithmeticClass;
use whiskmap::render::{self, Ink, regime_fill};
use whiskmap::scene::Parameter;
use whiskmap::sensitivity::Variable;
use whiskmap::{Channels, Regime, store};

/// Version of the package.
#[pyfunction]
pub const fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// Arithmetic class of this processor, on which the last bits of results depend.
#[pyfunction]
pub fn arithmetic() -> &'static str {
    ArithmeticClass::detect().name()
}

/// Returns the name, the unit, the name of the sweep axis and the title of each parameter; no axis where a sweep cannot vary it.
#[pyfunction]
pub fn parameters() -> Vec<(&'static str, &'static str, Option<&'static str>, &'static str)> {
    let axis =
        |parameter: Parameter| Parameter::SWEPT.contains(&parameter).then(|| parameter.axis());
    let all = Parameter::ALL.into_iter();
    all.map(|parameter| (parameter.name(), parameter.unit(), axis(parameter), parameter.title()))
        .collect()
}

/// Returns name, unit and value of each variable of a scene's detachments; the distance has no value.
#[pyfunction]
pub fn variables(scene: &CheckedScene) -> Vec<(String, &'static str, f64)> {
    let value = |variable: Variable| match variable {
        Variable::Parameter(parameter) => parameter.value(&scene.0).unwrap_or(f64::NAN),
        _ => f64::NAN,
    };
    let all = Variable::of_detachments(&scene.0).into_iter();
    all.map(|variable| (variable.name(), variable.unit(), value(variable))).collect()
}

/// Returns the names of all channels of maps.
#[pyfunction]
pub fn channels() -> Vec<&'static str> {
    Channels::STANDARD.names().collect()
}

/// Returns the CF attributes of a channel as JSON; `None` for another name.
#[pyfunction]
pub fn channel_attributes(name: &str) -> Option<String> {
    store::channel_attributes(name).map(|attributes| attributes.to_string())
}

/// Name, CF attributes as JSON, and values of a coordinate: numbers, or names of whiskers.
pub type Coordinate<'py> = (&'static str, String, CoordinateValues<'py>);

/// Values of a coordinate.
#[derive(IntoPyObject)]
pub enum CoordinateValues<'py> {
    #[pyo3(transparent)]
    Numbers(Bound<'py, PyArray1<f64>>),
    #[pyo3(transparent)]
    Names(Vec<String>),
}

/// Returns the name, the CF attributes as JSON, and the values of each coordinate of a scene's maps, in the order of their dimensions.
#[pyfunction]
pub fn coordinates<'py>(py: Python<'py>, scene: &CheckedScene) -> Vec<Coordinate<'py>> {
    of_grid(py, &scene.0.grid)
}

/// Returns the coordinates of a grid, as [`coordinates`] does.
pub fn of_grid<'py>(py: Python<'py>, grid: &whiskmap::scene::Grid) -> Vec<Coordinate<'py>> {
    let all = store::coordinates(grid).into_iter();
    all.map(|axis| {
        let numbers: Option<Vec<f64>> = axis.values.iter().map(|value| value.number()).collect();
        let names = || axis.values.iter().map(ToString::to_string).collect();
        let values = match numbers {
            Some(numbers) => CoordinateValues::Numbers(PyArray1::from_vec(py, numbers)),
            None => CoordinateValues::Names(names()),
        };
        (axis.name, axis.attributes.to_string(), values)
    })
    .collect()
}

/// Returns code, name, colour and colour of the stripes of each regime in pictures; the last two are equal without stripes.
#[pyfunction]
pub fn regimes() -> Vec<(u32, &'static str, String, String)> {
    let all = Regime::ALL.into_iter();
    all.map(|regime| {
        let [ground, stripes] = regime_fill(regime.code()).colours().map(hexadecimal);
        (regime.code(), regime.name(), ground, stripes)
    })
    .collect()
}

/// Returns the title of the axis that shows a variable, with its unit; of detachments, if `is_end` is true.
#[pyfunction]
pub fn axis_title(name: &str, is_end: bool) -> String {
    match is_end {
        true => render::end_title(name),
        false => render::axis_title(name),
    }
}

/// Returns the colours of lines by what they show; the series are `0` to `6`.
#[pyfunction]
pub fn inks() -> BTreeMap<String, String> {
    let named = [("slip-off", Ink::Black), ("pull-off", Ink::Blue), ("background", Ink::Grey)]
        .map(|(name, ink)| (name.to_owned(), ink));
    let series = (0..7).map(|index| (index.to_string(), Ink::Series(index)));
    let all = named.into_iter().chain(series);
    all.map(|(name, ink)| (name, hexadecimal(ink.rgb()))).collect()
}

fn hexadecimal([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Returns the unit of a column by its name, in the terms of the CF conventions.
pub fn units(name: &str) -> &'static str {
    match Quantity::of(name).unit() {
        Some("deg") => "degree",
        Some("nNm") => "nN m",
        Some(unit) => unit,
        None if name.ends_with("_per_mm") => "1/mm",
        None => "1",
    }
}
