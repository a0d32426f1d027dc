//! Check that two maps have the same scene and grid.

use crate::scene::{Grid, Parameter, Scene, SceneError, digits};
use crate::store::MapSource;

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
    /// The measured radii of the scenes are different.
    #[error("the scenes differ: whisker.profile has other radii; compare maps of one scene")]
    Profile,
    /// This version cannot read the scene of a map.
    #[error("the scene of a map: {0}")]
    Unreadable(#[from] SceneError),
}

/// Checks that the maps have the same axes, whiskers and poles.
pub(super) fn check(maps: [&MapSource; 2]) -> Result<(), super::CompareError> {
    check_grids(maps.map(MapSource::grid))?;
    let texts = [maps[0].attribute("scene")?, maps[1].attribute("scene")?];
    let [first, second] = texts.map(|text| {
        Scene::parse(text.as_str().unwrap_or_default(), "the scene of the map")
            .map_err(Mismatch::Unreadable)
    });
    Ok(check_scenes([&first?, &second?])?)
}

fn check_grids(grids: [&Grid; 2]) -> Result<(), Mismatch> {
    let [first, second] = grids.map(axes);
    let names = |axes: &[(&'static str, &[f64])]| {
        let sweep = axes[..axes.len() - 2].iter().map(|(name, _)| *name);
        let names = sweep.collect::<Vec<_>>().join(", ");
        if names.is_empty() {
            "none".to_owned()
        } else {
            names
        }
    };
    let [first_names, second_names] = [names(&first), names(&second)];
    if first_names != second_names {
        return Err(Mismatch::Axes(first_names, second_names));
    }
    let differing = first.iter().zip(&second).find(|(one, other)| one != other);
    differing.map_or(Ok(()), |((axis, one), (_, other))| {
        let [first, second] = described(one, other);
        Err(Mismatch::Axis {
            axis,
            first,
            second,
        })
    })
}

/// Returns names and values of all axes: the sweep axes, distance and push angle.
fn axes(grid: &Grid) -> Vec<(&'static str, &[f64])> {
    let sweep = grid.sweep.iter();
    let sweep = sweep.map(|axis| (axis.variable.name(), &*axis.values));
    let inside = [
        ("distance_mm", &*grid.distance_mm),
        ("push_angle_deg", &*grid.push_angle_deg),
    ];
    sweep.chain(inside).collect()
}

/// Returns texts about two lists of values: number and ends, or the first values that differ.
fn described(one: &[f64], other: &[f64]) -> [String; 2] {
    let ends = |values: &[f64]| {
        (
            values.len(),
            values.first().copied(),
            values.last().copied(),
        )
    };
    let place = one.iter().zip(other).position(|(one, other)| one != other);
    match place {
        Some(place) if ends(one) == ends(other) => {
            [one, other].map(|values| format!("value {} is {}", place + 1, digits(values[place])))
        }
        _ => [one, other].map(|values| {
            let [first, last] = [values[0], values[values.len() - 1]].map(digits);
            format!("{} values from {first} to {last}", values.len())
        }),
    }
}

fn check_scenes([first, second]: [&Scene; 2]) -> Result<(), Mismatch> {
    let whiskers = [first, second].map(|scene| scene.first_whisker());
    let [one, other] = &whiskers;
    if one.whisker == other.whisker && one.pole == other.pole {
        return Ok(());
    }
    let is_swept = |parameter| first.grid.axis(parameter).is_some();
    let all = Parameter::ALL
        .into_iter()
        .filter(|parameter| !is_swept(*parameter));
    let mut differing = all.filter(|parameter| parameter.value(first) != parameter.value(second));
    let Some(parameter) = differing.next() else {
        return Err(Mismatch::Profile);
    };
    let value = |scene| parameter.value(scene).map_or("left out".to_owned(), digits);
    Err(Mismatch::Scene {
        name: parameter.name(),
        first: value(first),
        second: value(second),
    })
}
