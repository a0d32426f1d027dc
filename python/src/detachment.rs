//! Detachments of many whiskers at many distances, on all threads.
//!
//! Rows with the same whisker and side are computed together: one sheet serves all their distances.

use crate::arguments::parameter;
use crate::errors::{SceneError, of_scene};
use crate::scene::CheckedScene;
use crate::threads;
use crate::traces::single;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap::rod::Side;
use whiskmap::scene::{Parameter, Scene, SceneBuilder};
use whiskmap::shooting::Resolution;
use whiskmap::trace::{Detachment, curve_without_strain};

/// Maximum number of distances of one sheet.
const MOST_DISTANCES: usize = 4096;

/// Quantity of a detachment; NaN where there is none.
type Quantity = (&'static str, fn(&Detachment) -> Option<f64>);

/// Quantities of the result, in the order of its fields.
const QUANTITIES: [Quantity; 11] = [
    ("push_angle_deg", |end| end.push_angle_deg),
    ("push_chord_deg", |end| end.push_chord_deg),
    ("contact_distance_mm", |end| end.contact_distance_mm),
    ("arc_length_mm", |end| end.arc_length_mm),
    ("contact_angle_deg", |end| end.contact_angle_deg),
    ("force_un", |end| end.force_un),
    ("base_force_x_un", |end| end.base_force_x_un),
    ("base_force_y_un", |end| end.base_force_y_un),
    ("base_moment_nnm", |end| end.base_moment_nnm),
    ("energy_nj", |end| end.energy_nj),
    ("residual", |end| end.residual),
];

/// Arrays of whiskers, sides and distances, `[row]` each.
struct DetachmentRows<'a> {
    /// Description with the numbers that are equal in all rows.
    base: SceneBuilder,
    /// Parameters that differ from row to row, with their values.
    varying: Vec<(Parameter, &'a [f64])>,
    distance_mm: &'a [f64],
    is_cb: &'a [bool],
}

/// Error of a row whose numbers a scene refuses.
struct RefusedRow {
    row: usize,
    why: whiskmap::scene::SceneError,
}

/// Kinds of the ends, and the quantities by name, `[row]`.
type DetachmentArrays<'py> = (
    Bound<'py, PyArray1<u8>>,
    Vec<(&'static str, Bound<'py, PyArray1<f64>>)>,
);

/// Computes one detachment for each row: `fixed` numbers, `varying` ones `[row]`, distances and sides.
#[pyfunction]
pub fn detachment<'py>(
    py: Python<'py>,
    scene: Option<PyRef<'py, CheckedScene>>,
    fixed: BTreeMap<String, f64>,
    varying: BTreeMap<String, PyReadonlyArray1<'py, f64>>,
    distance_mm: PyReadonlyArray1<'py, f64>,
    is_cb: PyReadonlyArray1<'py, bool>,
    threads: Option<usize>,
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
    let columns: PyResult<Vec<_>> = varying
        .iter()
        .map(|(name, values)| Ok((parameter("argument", name)?, values.as_slice()?)))
        .collect();
    let rows = DetachmentRows {
        base: base.push_angle_deg([0.0]),
        varying: columns?,
        distance_mm: distance_mm.as_slice()?,
        is_cb: is_cb.as_slice()?,
    };
    let count = rows.distance_mm.len();
    let ends = threads::run(py, threads, |_| Ok(()), |cancel| rows.ends(cancel))?;
    let ends = ends.map_err(|refused| of_row(py, &refused, count))?;
    let mut kinds = vec![0; count];
    for (row, end) in &ends {
        kinds[*row] = end.kind as u8;
    }
    let quantities = QUANTITIES.map(|(name, value)| {
        let mut values = vec![f64::NAN; count];
        for (row, end) in &ends {
            values[*row] = value(end).unwrap_or(f64::NAN);
        }
        (name, PyArray1::from_vec(py, values))
    });
    Ok((PyArray1::from_vec(py, kinds), quantities.into()))
}

impl DetachmentRows<'_> {
    /// Returns the row and its end for every row, in any order. After a cancellation, rows are missing.
    fn ends(&self, cancel: &Arc<AtomicBool>) -> Result<Vec<(usize, Detachment)>, RefusedRow> {
        let groups = self.groups();
        let ends = groups
            .par_iter()
            .map(|rows| match cancel.load(Ordering::Relaxed) {
                true => Ok(Vec::new()),
                false => self.ends_of(rows),
            });
        let ends: Vec<Result<Vec<_>, RefusedRow>> = ends.collect();
        let first = ends
            .iter()
            .filter_map(|own| own.as_ref().err())
            .map(|refused| refused.row)
            .min();
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
    fn ends_of(&self, rows: &[usize]) -> Result<Vec<(usize, Detachment)>, RefusedRow> {
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
            RefusedRow { row, why }
        })?;
        let side = if self.is_cb[first] {
            Side::Cb
        } else {
            Side::Cf
        };
        let ends = curve_without_strain(
            Resolution::FINE,
            &scene.whisker,
            &scene.pole,
            side,
            &distances,
        );
        let end = |row: &usize| {
            let place = distances.partition_point(|distance| *distance < self.distance_mm[*row]);
            (*row, ends[place])
        };
        Ok(rows.iter().map(end).collect())
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
