//! Check that two maps have the same scene and grid.

use crate::scene::{Coordinate, Grid, Parameter, Scene, SceneError, TableWhisker, Whisker, digits};
use crate::store::{MapSource, coordinates};

/// Difference between two maps that cannot be compared cell by cell.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Mismatch {
    /// The maps have different axes; the texts name them.
    #[error(
        "the sweep axes differ: {0} in the first map, {1} in the second; compare slices with equal axes"
    )]
    Axes(String, String),
    /// An axis has different values; the texts describe them.
    #[error(
        "the axis {axis} differs: {first} in the first map, {second} in the second; compare maps of one grid"
    )]
    Axis {
        /// Name of the axis.
        axis: &'static str,
        /// Values of the axis in the first map.
        first: String,
        /// Values of the axis in the second map.
        second: String,
    },
    /// A parameter of the scene has different values.
    #[error(
        "the scenes differ: {name} is {first} in the first map, {second} in the second; compare maps of one scene"
    )]
    Scene {
        /// Name of the parameter.
        name: &'static str,
        /// Value of the parameter in the first map.
        first: String,
        /// Value of the parameter in the second map.
        second: String,
    },
    /// The shapes of the scenes are different, which no number describes; the text is their key.
    #[error("the scenes differ: {0} is not the same in both maps; compare maps of one scene")]
    Shape(&'static str),
    /// A row of the table of whiskers is different; the text is the name of its whisker.
    #[error(
        "the scenes differ: the whisker {0} of the table is not the same in both maps; compare maps of one scene"
    )]
    TableRow(String),
    /// This version cannot read the scene of a map.
    #[error("the scene of a map: {0}")]
    Unreadable(#[from] SceneError),
}

/// Checks that the maps have the same axes, whiskers and poles.
pub(super) fn check(maps: [&MapSource; 2]) -> Result<(), super::CompareError> {
    check_grids(maps.map(MapSource::grid))?;
    let [first, second] = [maps[0].scene()?, maps[1].scene()?];
    let scenes = [&first.map_err(Mismatch::Unreadable)?, &second.map_err(Mismatch::Unreadable)?];
    Ok(check_scenes(scenes)?)
}

fn check_grids(grids: [&Grid; 2]) -> Result<(), Mismatch> {
    let [first_names, second_names] = grids.map(|grid| match grid.sweep_names() {
        names if names.is_empty() => "none".to_owned(),
        names => names,
    });
    if first_names != second_names {
        return Err(Mismatch::Axes(first_names, second_names));
    }
    let [first, second] = grids.map(coordinates);
    let mut axes = first.iter().zip(&second);
    let differing = axes.find(|(one, other)| one.values != other.values);
    differing.map_or(Ok(()), |(one, other)| {
        let [first, second] = described(&one.values, &other.values);
        Err(Mismatch::Axis { axis: one.name, first, second })
    })
}

/// Returns texts about two lists of values: number and ends, or the first values that differ.
fn described(one: &[Coordinate], other: &[Coordinate]) -> [String; 2] {
    let ends = |values: &[Coordinate]| {
        let ends = [values.first().cloned(), values.last().cloned()];
        (values.len(), ends)
    };
    let place = one.iter().zip(other).position(|(one, other)| one != other);
    match place {
        Some(place) if ends(one) == ends(other) => {
            [one, other].map(|values| format!("value {} is {}", place + 1, values[place]))
        }
        _ => [one, other].map(|values| {
            let [first, last] = [&values[0], &values[values.len() - 1]];
            format!("{} values from {first} to {last}", values.len())
        }),
    }
}

/// Checks that two scenes have the same axes, whiskers and poles, so that [`compare`](super::compare) can compare their maps.
///
/// # Errors
/// The first difference.
pub fn check_same([first, second]: [&Scene; 2]) -> Result<(), Mismatch> {
    check_grids([&first.grid, &second.grid])?;
    check_scenes([first, second])
}

fn check_scenes([first, second]: [&Scene; 2]) -> Result<(), Mismatch> {
    // Marks of yielding are no part of a state.
    let unmarked = |whisker: &Whisker| Whisker { yield_strain: None, ..whisker.clone() };
    let found = |row: &TableWhisker| match &row.found {
        Ok((whisker, pole)) => Some((unmarked(whisker), *pole)),
        Err(_) => None,
    };
    // The names of the rows are on an axis, and equal.
    let mut rows = first.table.iter().zip(&*second.table);
    if let Some((row, _)) = rows.find(|(one, other)| found(one) != found(other)) {
        return Err(Mismatch::TableRow(row.name.clone()));
    }
    let [one, other] = [first, second].map(|scene| scene.first_whisker());
    let [whisker, other_whisker] = [&one, &other].map(|swept| unmarked(&swept.whisker));
    if !first.table.is_empty() || whisker == other_whisker && one.pole == other.pole {
        return Ok(());
    }
    let is_swept = |parameter| first.grid.axis(parameter).is_some();
    let all = Parameter::ALL.into_iter().filter(|parameter| !is_swept(*parameter));
    let mut differing = all.filter(|parameter| parameter.value(first) != parameter.value(second));
    let Some(parameter) = differing.next() else {
        return Err(Mismatch::Shape(if whisker.traced == other_whisker.traced {
            "whisker.profile"
        } else {
            "whisker.rest"
        }));
    };
    let value = |scene| parameter.value(scene).map_or("left out".to_owned(), digits);
    Err(Mismatch::Scene { name: parameter.name(), first: value(first), second: value(second) })
}
