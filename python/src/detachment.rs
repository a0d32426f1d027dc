//! Detachments of many whiskers at many distances, on all threads.
//!
//! Rows with the same whisker and side are computed together: one sheet serves all their distances.

use crate::arguments::{parameter, refused};
use crate::errors::{SceneError, of_scene};
use crate::scene::CheckedScene;
use crate::threads::{self, ThreadCount};
use crate::traces::single;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap::rod::Side;
use whiskmap::scene::{Parameter, Scene, SceneBuilder};
use whiskmap::sensitivity::{Derivatives, DetachmentDerivatives, Variable, detachments};
use whiskmap::shooting::Resolution;
use whiskmap::trace::{Detachment, curve_without_strain};

/// Maximum number of distances of one sheet.
const MOST_DISTANCES: usize = 4096;

/// Name of a quantity, its value, and its derivative.
type Quantity = (
    &'static str,
    fn(&Detachment) -> Option<f64>,
    fn(&Derivatives) -> f64,
);

/// Defines the quantities of an end that have derivatives, by the names of their fields.
macro_rules! quantities {
    ($($name:ident),*) => { [$((stringify!($name), |end| end.$name, |by| by.$name)),*] };
}

const QUANTITIES: [Quantity; 10] = quantities![
    push_angle_deg,
    push_chord_deg,
    contact_distance_mm,
    arc_length_mm,
    contact_angle_deg,
    force_un,
    base_force_x_un,
    base_force_y_un,
    base_moment_nnm,
    energy_nj
];

/// Arrays of whiskers, sides and distances, `[row]` each.
struct DetachmentRows<'a> {
    /// Description with the numbers that are equal in all rows.
    base: SceneBuilder,
    /// Parameters that differ from row to row, with their values.
    varying: Vec<(Parameter, &'a [f64])>,
    distance_mm: &'a [f64],
    is_cb: &'a [bool],
    /// Variables of the derivatives, `[variable]`.
    variables: Vec<Variable>,
    /// True if the rows give a taper: then the radius at the base varies at a fixed taper, otherwise at a fixed radius at the tip.
    have_taper: bool,
}

/// End of one row, and its derivatives, `[variable]`; `None` where there is none.
struct RowEnd {
    row: usize,
    end: Detachment,
    by: Vec<Option<Derivatives>>,
}

/// Error of a row whose numbers a scene refuses.
struct RefusedRow {
    row: usize,
    why: Box<whiskmap::scene::SceneError>,
}

/// Name, values `[row]` and derivatives `[row][variable]` of a quantity; NaN where there is none.
type QuantityArrays<'py> = (
    &'static str,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// Kinds of the ends, residuals, and quantities.
type DetachmentArrays<'py> = (
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<f64>>,
    Vec<QuantityArrays<'py>>,
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
    threads: Option<ThreadCount>,
) -> PyResult<DetachmentArrays<'py>> {
    let mut base = match &scene {
        Some(scene) => {
            single(&scene.0)?;
            scene.0.to_builder()
        }
        None => Scene::builder("detachment"),
    };
    for (name, value) in &fixed {
        base = base.set(parameter("argument", name)?, *value);
    }
    let columns = varying.iter();
    let columns =
        columns.map(|(name, values)| Ok((parameter("argument", name)?, values.as_slice()?)));
    let variable = |name: String| {
        name.parse()
            .map_err(|must: String| refused("jac", &name, &must))
    };
    let taper = Parameter::Taper.name();
    let rows = DetachmentRows {
        base: base.push_angle_deg([0.0]),
        varying: columns.collect::<PyResult<_>>()?,
        distance_mm: distance_mm.as_slice()?,
        is_cb: is_cb.as_slice()?,
        variables: variables
            .into_iter()
            .map(variable)
            .collect::<PyResult<_>>()?,
        have_taper: fixed.contains_key(taper) || varying.contains_key(taper),
    };
    let (count, width) = (rows.distance_mm.len(), rows.variables.len());
    let ends = threads::run(py, threads, |_| Ok(()), |cancel| rows.ends(cancel))?;
    let ends = ends.map_err(|refused| of_row(py, &refused, count))?;
    let mut kinds = vec![0; count];
    for own in &ends {
        kinds[own.row] = own.end.kind as u8;
    }
    let values = |value: fn(&Detachment) -> Option<f64>| {
        let mut values = vec![f64::NAN; count];
        for own in &ends {
            values[own.row] = value(&own.end).unwrap_or(f64::NAN);
        }
        PyArray1::from_vec(py, values)
    };
    let quantities = QUANTITIES.map(|(name, value, derivative)| {
        let mut by = vec![f64::NAN; count * width];
        for own in &ends {
            for (place, derivatives) in by[own.row * width..].iter_mut().zip(&own.by) {
                *place = derivatives.as_ref().map_or(f64::NAN, derivative);
            }
        }
        (name, values(value), PyArray1::from_vec(py, by))
    });
    let kinds = PyArray1::from_vec(py, kinds);
    Ok((kinds, values(|end| end.residual), quantities.into()))
}

impl DetachmentRows<'_> {
    /// Returns the end of every row, in any order. After a cancellation, rows are missing.
    fn ends(&self, cancel: &Arc<AtomicBool>) -> Result<Vec<RowEnd>, RefusedRow> {
        let groups = self.groups();
        let ends = groups
            .par_iter()
            .map(|rows| match cancel.load(Ordering::Relaxed) {
                true => Ok(Vec::new()),
                false => self.ends_of(rows),
            });
        let ends: Vec<Result<Vec<RowEnd>, RefusedRow>> = ends.collect();
        // The first refused row, on any number of threads.
        let refused = ends.iter().filter_map(|own| own.as_ref().err());
        let first = refused.map(|refused| refused.row).min();
        let mut all = Vec::with_capacity(self.distance_mm.len());
        for own in ends {
            match own {
                Ok(ends) => all.extend(ends),
                Err(refused) if Some(refused.row) == first => return Err(refused),
                Err(_) => {}
            }
        }
        Ok(all)
    }

    /// Rows with the same whisker and side, by growing distance, `[sheet][row]`.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut places: HashMap<Vec<u64>, usize> = HashMap::new();
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for row in 0..self.distance_mm.len() {
            let numbers = self.varying.iter().map(|(_, values)| values[row].to_bits());
            let key = numbers.chain([u64::from(self.is_cb[row])]).collect();
            let place = *places.entry(key).or_insert(groups.len());
            match groups.get_mut(place) {
                Some(group) => group.push(row),
                None => groups.push(vec![row]),
            }
        }
        for group in &mut groups {
            group.sort_by(|one, other| self.distance_mm[*one].total_cmp(&self.distance_mm[*other]));
        }
        let sheets = groups.iter().flat_map(|group| group.chunks(MOST_DISTANCES));
        sheets.map(<[_]>::to_vec).collect()
    }

    /// The ends of rows of one whisker and side.
    fn ends_of(&self, rows: &[usize]) -> Result<Vec<RowEnd>, RefusedRow> {
        let first = rows[0];
        let mut distances: Vec<f64> = rows.iter().map(|row| self.distance_mm[*row]).collect();
        distances.dedup();
        let mut builder = self.base.clone().distance_mm(&*distances);
        for (parameter, values) in &self.varying {
            builder = builder.set(*parameter, values[first]);
        }
        let scene = builder.build().map_err(|why| {
            let place = why.key().and_then(|key| {
                key.strip_prefix("grid.distance_mm[")?
                    .strip_suffix(']')?
                    .parse()
                    .ok()
            });
            let distance = place.and_then(|place: usize| distances.get(place));
            let of_distance =
                |distance: &f64| rows.iter().find(|row| self.distance_mm[**row] == *distance);
            let row = distance.and_then(of_distance).copied().unwrap_or(first);
            RefusedRow {
                row,
                why: Box::new(why),
            }
        })?;
        let side = if self.is_cb[first] {
            Side::Cb
        } else {
            Side::Cf
        };
        let ends = self.differentiated(&scene, side, &distances);
        let end = |row: &usize| {
            let place = distances.partition_point(|distance| *distance < self.distance_mm[*row]);
            let (end, by) = &ends[place];
            RowEnd {
                row: *row,
                end: *end,
                by: by.clone(),
            }
        };
        Ok(rows.iter().map(end).collect())
    }

    /// The ends of one whisker and side with their derivatives, `[distance]`.
    fn differentiated(
        &self,
        scene: &Scene,
        side: Side,
        distances: &[f64],
    ) -> Vec<(Detachment, Vec<Option<Derivatives>>)> {
        let (whisker, pole) = (&scene.whisker, &scene.pole);
        if self.variables.is_empty() {
            let ends = curve_without_strain(Resolution::FINE, whisker, pole, side, distances);
            return ends.into_iter().map(|end| (end, Vec::new())).collect();
        }
        let base = Variable::from(Parameter::BaseRadiusUm);
        let base = self
            .variables
            .iter()
            .position(|own| self.have_taper && *own == base);
        let mut variables = self.variables.clone();
        variables.extend(base.map(|_| Variable::from(Parameter::TipRadiusUm)));
        let ends = detachments(whisker, pole, side, distances, &variables);
        let end = |own: DetachmentDerivatives| {
            let mut by: Vec<Option<Derivatives>> = own.by.into_iter().map(Result::ok).collect();
            if let Some(base) = base {
                let tip = by.pop().flatten();
                by[base] = by[base]
                    .zip(tip)
                    .map(|(base, tip)| base.plus(1.0 - whisker.taper(), &tip));
            }
            (own.end, by)
        };
        ends.into_iter().map(end).collect()
    }
}

/// Returns the exception of a refused row, with its index if there are several.
fn of_row(py: Python<'_>, refused: &RefusedRow, count: usize) -> PyErr {
    let plain = of_scene(py, &refused.why);
    if count == 1 {
        return plain;
    }
    let exception = SceneError::new_err(format!("element {}: {}", refused.row, plain.value(py)));
    for name in ["key", "value", "allowed"] {
        let copied = plain.value(py).getattr(name);
        if let Err(why) = copied.and_then(|value| exception.value(py).setattr(name, value)) {
            return why;
        }
    }
    exception
}
