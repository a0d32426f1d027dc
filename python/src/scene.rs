//! Checked scenes.

use crate::arguments::{parameter, refused};
use crate::errors::{of_io, of_scene};
use crate::threads;
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Read;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use whiskmap::input::did_you_mean;
use whiskmap::scene::{
    AxisScale, AxisValues, Coordinate, Deviations, FrameDeviations, Parameter, Scene, SceneBuilder,
    Surface, SweepVariable, WhiskerRow,
};
use whiskmap::store::{AxisValue, scene_at};
use whiskmap::traced::TracedShape;

/// Name of the standard deviation of measured radii.
const PROFILE_RADIUS: &str = "profile_radius_um";

/// A scene that has passed every check, with its description as plain values.
#[pyclass(frozen, module = "whiskmap._whiskmap")]
pub struct CheckedScene(pub Scene);

/// Values of an axis: a list, or first value, last value, number of values and scale.
#[derive(FromPyObject, IntoPyObject)]
pub enum AxisTuple {
    Range(f64, Option<f64>, usize, String),
    #[pyo3(transparent)]
    List(Vec<f64>),
}

/// Points of a traced shape, `[point][x, y]` in millimetres, and its degree; `None` if cross-validation chooses the degree.
type Traced = (Vec<[f64; 2]>, Option<usize>);

/// Surface: distance in mm, spacing and asperity radius in um, length in mm, jitter, and seed.
type SurfaceTuple = (f64, f64, f64, f64, f64, u32);

/// Measured rows, `[row][arclength, radius]` in millimetres and micrometres, and whether they are smoothed.
type Measured = (Vec<[f64; 2]>, bool);

/// Row of a table of whiskers: name, numbers by name, measured rows, and traced points.
type RowTuple = (String, Vec<(String, f64)>, Option<Vec<[f64; 2]>>, Option<Vec<[f64; 2]>>);

/// Description of a scene: title, numbers by name, measured rows, traced points, axes by name, standard deviations by name, surface, table
/// of whiskers, and name.
type Description = (
    String,
    BTreeMap<String, f64>,
    Option<Measured>,
    Option<Traced>,
    Vec<(String, AxisTuple)>,
    Option<BTreeMap<String, f64>>,
    Option<SurfaceTuple>,
    Option<Vec<RowTuple>>,
    Option<String>,
);

/// Name of the yield strain among the numbers, of which it is no parameter.
const YIELD_STRAIN: &str = "yield_strain";

#[pymethods]
impl CheckedScene {
    /// Reads a scene file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        // Only a file that can be read is a scene that is refused. A folder can be opened.
        let opened = File::open(&path).and_then(|mut file| match file.metadata()?.is_dir() {
            true => file.read(&mut [0]).map(drop),
            false => Ok(()),
        });
        opened.map_err(|cause| of_io(&path, &cause))?;
        let scene = py.detach(|| Scene::read(&path));
        scene.map(Self).map_err(|why| of_scene(py, &why))
    }

    /// Checks the text of a scene file, which messages call `origin`.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, origin: &str) -> PyResult<Self> {
        let scene = Scene::parse(text, origin);
        scene.map(Self).map_err(|why| of_scene(py, &why))
    }

    /// Checks the description of a scene. Numbers with the names `changed` are refused if a column of the table gives them.
    #[staticmethod]
    fn build(
        py: Python<'_>,
        description: Description,
        changed: BTreeSet<String>,
    ) -> PyResult<Self> {
        let (title, numbers, rows, traced, axes, deviations, surface, table, name) = description;
        let mut builder = Scene::builder(title);
        let set = |builder: SceneBuilder, (name, value): (&String, &f64)| {
            Ok::<_, PyErr>(match &**name {
                YIELD_STRAIN => builder.yield_strain(*value),
                _ => builder.set(parameter("whisker", name)?, *value),
            })
        };
        builder = numbers.iter().try_fold(builder, set)?;
        if let Some((rows, smooth)) = rows {
            builder = builder.profile(rows).smooth_profile(smooth);
        }
        if let Some((points, degree)) = traced {
            let fit = |cancel: &Arc<AtomicBool>| TracedShape::fit_until(points, degree, cancel);
            let shape = threads::run(py, None, |_| Ok(()), fit)?;
            builder = builder.traced(shape.map_err(|why| of_scene(py, &why.into()))?);
        }
        for (name, values) in axes {
            let values = axis_values(&name, values)?;
            builder = match &*name {
                "push_angle_deg" => builder.push_angle_deg(values),
                "distance_mm" => builder.distance_mm(values),
                _ => builder.sweep(swept(&name)?, values),
            };
        }
        if let Some(deviations) = deviations {
            builder = builder.uncertainty(uncertainty(&deviations)?);
        }
        if let Some((distance_mm, spacing_um, asperity_radius_um, length_mm, jitter, seed)) =
            surface
        {
            builder = builder.surface(Surface {
                distance_mm,
                spacing_um,
                asperity_radius_um,
                length_mm,
                jitter,
                seed,
            });
        }
        if let Some(rows) = table {
            let rows = rows.into_iter().map(whisker_row);
            builder = builder.whiskers(rows.collect::<PyResult<Vec<_>>>()?);
        }
        // The builder refuses numbers that are set after the table.
        let mut changed = numbers.iter().filter(|(name, _)| changed.contains(*name));
        builder = changed.try_fold(builder, set)?;
        if let Some(name) = name {
            builder = builder.name(name);
        }
        let build = || builder.build();
        py.detach(build).map(Self).map_err(|why| of_scene(py, &why))
    }

    /// Returns the description from which [`CheckedScene::build`] makes an equal scene.
    fn description(&self) -> Description {
        let builder = self.0.to_builder();
        let parameters =
            Parameter::ALL.into_iter().filter(|parameter| *parameter != Parameter::Taper);
        let numbers = parameters.filter_map(|parameter| {
            Some((parameter.name().to_owned(), builder.number(parameter)?))
        });
        let yield_strain = self.0.given_yield_strain();
        let given = numbers.chain(yield_strain.map(|strain| (YIELD_STRAIN.to_owned(), strain)));
        let axes = builder.axes();
        (
            self.0.title.clone(),
            given.collect(),
            self.0.measured_rows().map(|rows| (rows.to_vec(), self.0.smooth_radii().is_some())),
            self.0.traced().map(|shape| {
                let degree = (!shape.is_degree_chosen).then_some(shape.degree);
                (shape.points_mm.clone(), degree)
            }),
            axes.map(|(name, values)| (name.to_owned(), axis_tuple(values))).collect(),
            self.0.uncertainty.as_ref().map(deviations_by_name),
            self.0.surface.map(|surface| {
                (
                    surface.distance_mm,
                    surface.spacing_um,
                    surface.asperity_radius_um,
                    surface.length_mm,
                    surface.jitter,
                    surface.seed,
                )
            }),
            (!self.0.table.is_empty()).then(|| self.0.table_rows().iter().map(row_tuple).collect()),
            Some(self.0.name.clone()),
        )
    }

    /// Returns the names of the rows of the table that have no whisker, with the reasons.
    fn refused(&self) -> Vec<(String, String)> {
        let refused = self.0.refused();
        refused.map(|(name, reason)| (name.to_owned(), reason.to_owned())).collect()
    }

    /// Returns the scene with the whisker `name` of the table alone.
    fn whisker(&self, py: Python<'_>, name: &str) -> PyResult<Self> {
        let wanted = AxisValue {
            axis: SweepVariable::WHISKER.to_owned(),
            value: Coordinate::Name(name.to_owned()),
        };
        let (scene, _) = scene_at(&self.0, &[wanted], true)
            .map_err(|why| PyKeyError::new_err(why.to_string()))?;
        let alone = scene.of_whisker(0);
        alone.map(Self).map_err(|why| of_scene(py, &why))
    }

    /// Returns the scene as the text of a file.
    fn to_toml(&self) -> String {
        self.0.to_toml()
    }

    /// Returns one line for each number that looks like another unit.
    fn warnings(&self) -> Vec<String> {
        self.0.warnings()
    }

    /// Returns degree, rms distance in mm and whether the degree was chosen, of a fit to traced points.
    fn rest_fit(&self) -> Option<(usize, f64, bool)> {
        let traced = self.0.traced()?;
        Some((traced.degree, traced.rms_mm, traced.is_degree_chosen))
    }

    /// Returns degree and rms residual in um of the polynomial that replaces the measured radii.
    fn profile_fit(&self) -> Option<(usize, f64)> {
        let smooth = self.0.smooth_radii()?;
        Some((smooth.degree, smooth.rms_um))
    }

    /// Returns the yield strain of the whisker, of a table the first one that exists; `None` without one.
    fn yield_strain(&self) -> Option<f64> {
        self.0.whisker.yield_strain
    }

    /// Scenes are equal if all their values are, whatever their texts.
    fn __eq__(&self, other: &Self) -> bool {
        let (scene, other) = (&*self.0, &*other.0);
        scene.title == other.title
            && scene.whisker == other.whisker
            && scene.pole == other.pole
            && scene.grid == other.grid
            && scene.table == other.table
            && scene.uncertainty == other.uncertainty
            && scene.surface == other.surface
            && scene.name == other.name
    }
}

/// Returns a note about the columns among `names` that a table of whiskers does not have; `None` without such a column. A name that is most
/// likely meant as a column that the table lacks is refused.
#[pyfunction]
pub fn unused_columns(names: Vec<String>) -> PyResult<Option<String>> {
    let texts: Vec<&str> = names.iter().map(String::as_str).collect();
    if let Some(what) = WhiskerRow::misnamed(&texts) {
        return Err(PyValueError::new_err(format!("table: {what}")));
    }
    let known = WhiskerRow::columns;
    let unused: Vec<&str> = names
        .iter()
        .filter(|name| known().all(|column| column != *name))
        .map(String::as_str)
        .collect();
    let hints = unused.iter().filter_map(|name| {
        let hint = did_you_mean(name, known());
        (!hint.is_empty()).then(|| format!("; `{name}` is not known{hint}"))
    });
    let hint = hints.take(1).collect::<String>();
    let note = || format!("columns that are not used: {}{hint}", unused.join(", "));
    Ok((!unused.is_empty()).then(note))
}

fn whisker_row((name, numbers, rows, points): RowTuple) -> PyResult<WhiskerRow> {
    let mut row = WhiskerRow::new(name);
    for (name, value) in numbers {
        row = match &*name {
            YIELD_STRAIN => row.yield_strain(value),
            _ => match Parameter::of_column(&name) {
                Some(parameter) => row.set(parameter, value),
                None => row.set(parameter("table", &name)?, value),
            },
        };
    }
    if let Some(rows) = rows {
        row = row.profile(rows);
    }
    Ok(match points {
        Some(points) => row.rest_points(points),
        None => row,
    })
}

fn row_tuple(row: &WhiskerRow) -> RowTuple {
    let numbers = row.numbers().iter();
    let numbers = numbers.map(|(parameter, value)| (parameter.name(), *value));
    let yield_strain = row.given_yield_strain().map(|strain| (YIELD_STRAIN, strain));
    let numbers = numbers.chain(yield_strain);
    (
        row.name().to_owned(),
        numbers.map(|(name, value)| (name.to_owned(), value)).collect(),
        row.measured_rows().map(<[_]>::to_vec),
        row.points_mm().map(<[_]>::to_vec),
    )
}

fn axis_values(name: &str, values: AxisTuple) -> PyResult<AxisValues> {
    Ok(match values {
        AxisTuple::List(list) => list.into(),
        AxisTuple::Range(from, to, count, scale) => AxisValues::Range {
            from,
            to,
            count,
            scale: match &*scale {
                "linear" => AxisScale::Linear,
                "log" => AxisScale::Log,
                _ => {
                    return Err(refused(
                        &format!("{name}.scale"),
                        &scale,
                        "must be 'linear' or 'log'",
                    ));
                }
            },
        },
    })
}

fn axis_tuple(values: &AxisValues) -> AxisTuple {
    match values {
        AxisValues::List(list) => AxisTuple::List(list.clone()),
        AxisValues::Range { from, to, count, scale } => {
            let scale = if *scale == AxisScale::Log { "log" } else { "linear" };
            AxisTuple::Range(*from, *to, *count, scale.to_owned())
        }
    }
}

/// Returns the parameter that a sweep axis of this name varies.
fn swept(name: &str) -> PyResult<Parameter> {
    let mut all = Parameter::SWEPT.into_iter();
    all.find(|parameter| parameter.axis() == name).ok_or_else(|| {
        let known = Parameter::SWEPT.map(Parameter::axis).join(", ");
        refused("grid.sweep", name, &format!("must be one of {known}"))
    })
}

fn uncertainty(by_name: &BTreeMap<String, f64>) -> PyResult<Deviations> {
    let mut deviations = Deviations::default();
    for (name, deviation) in by_name {
        if name == PROFILE_RADIUS {
            deviations.profile_radius_um = Some(*deviation);
        } else if !deviations.frames.set(name, *deviation) {
            deviations.parameters.push((parameter("uncertainty", name)?, *deviation));
        }
    }
    Ok(deviations)
}

fn deviations_by_name(deviations: &Deviations) -> BTreeMap<String, f64> {
    let parameters = deviations
        .parameters
        .iter()
        .map(|(parameter, deviation)| (parameter.name().to_owned(), *deviation));
    let rows = deviations.profile_radius_um.map(|deviation| (PROFILE_RADIUS.to_owned(), deviation));
    let names = FrameDeviations::NAMES.into_iter();
    let named = names.zip(deviations.frames.values());
    let frames = named.filter_map(|(name, deviation)| Some((name.to_owned(), deviation?)));
    parameters.chain(rows).chain(frames).collect()
}
