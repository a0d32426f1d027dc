//! Values selected on the axes of a map or a store.

use crate::input::{Quantity, did_you_mean};
use crate::scene::{LONGEST_TITLE, Scene, digits, rounded};
use std::str::FromStr;

/// Selected value of an axis of a map or a store.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisValue {
    /// Name of the selected axis, such as `taper` or `distance_mm`.
    pub axis: String,
    /// Selected value, in the unit of the axis.
    pub value: f64,
}

/// Reads `AXIS=VALUE`; the value of a length or an angle may have another unit than the axis.
///
/// ```
/// use whiskmap::store::AxisValue;
///
/// let at: AxisValue = "distance_mm = 1.5cm".parse()?;
/// assert_eq!((&*at.axis, at.value), ("distance_mm", 15.0));
/// # Ok::<(), String>(())
/// ```
impl FromStr for AxisValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (axis, value) = text
            .split_once('=')
            .ok_or("must be AXIS=VALUE, such as taper=0.9")?;
        let axis = axis.trim();
        let value = Quantity::of(axis).parse(value)?;
        let axis = axis.to_owned();
        Ok(Self { axis, value })
    }
}

/// Error of a selected value that an axis does not have.
#[derive(Debug, thiserror::Error)]
#[error("{axis}: {why}")]
pub struct InvalidAxisValue {
    axis: String,
    why: String,
}

impl InvalidAxisValue {
    pub(super) fn new(at: &AxisValue, why: impl ToString) -> Self {
        Self {
            axis: at.axis.clone(),
            why: why.to_string(),
        }
    }
}

/// Returns the scene with one value on each sweep axis in `wanted`, the nearest one, and the names of these axes with their values. The
/// title names the values.
///
/// # Errors
/// An axis is unknown or given twice, ends more than half a step before the value, or does not have it although `exact`.
pub fn scene_at(
    scene: &Scene,
    wanted: &[AxisValue],
    exact: bool,
) -> Result<(Scene, ChosenValues), InvalidAxisValue> {
    let sweep = scene.grid.sweep.iter();
    let axes: Vec<_> = sweep
        .map(|axis| (axis.parameter.axis(), &*axis.values))
        .collect();
    let (mut builder, mut chosen) = (scene.to_builder(), ChosenValues::new());
    for at in wanted {
        let select = select(&axes, &chosen, at, exact);
        let (axis, index) = select.map_err(|why| InvalidAxisValue::new(at, why))?;
        let (name, value) = (axes[axis].0, axes[axis].1[index]);
        builder = builder.sweep(scene.grid.sweep[axis].parameter, [value]);
        chosen.push((name, value));
    }
    if let Some(at) = wanted.last() {
        let title = titled(&scene.title, &chosen);
        let title: String = title.chars().take(LONGEST_TITLE).collect();
        let built = builder.title(title).build();
        return match built {
            Ok(scene) => Ok((scene, chosen)),
            Err(why) => Err(InvalidAxisValue::new(at, why)),
        };
    }
    Ok((scene.clone(), chosen))
}

/// Names and values of selected axes, each in the unit of its axis: `[axis]`.
pub type ChosenValues = Vec<(&'static str, f64)>;

/// Returns names of selected axes, and their values as text to four digits.
pub(super) fn readable(chosen: &ChosenValues) -> impl Iterator<Item = (&'static str, String)> {
    let text = |(name, value): &(_, f64)| (*name, digits(rounded(*value, 4)));
    chosen.iter().map(text)
}

/// Returns a title with the selected values, but for those that it has already, as that of an extracted part.
pub(super) fn titled(title: &str, chosen: &ChosenValues) -> String {
    let chosen = readable(chosen).map(|(name, value)| format!(", {name} = {value}"));
    let is_new = |part: &String| !title.ends_with(&**part) && !title.contains(&format!("{part}, "));
    let new = chosen.filter(is_new);
    std::iter::once(title.to_owned()).chain(new).collect()
}

/// Returns the indices of the axis and of the value that `at` selects on `axes`, of which some are `chosen` already.
pub(super) fn select(
    axes: &[(&'static str, &[f64])],
    chosen: &ChosenValues,
    at: &AxisValue,
    exact: bool,
) -> Result<(usize, usize), String> {
    let names = || axes.iter().map(|(name, _)| *name).collect::<Vec<_>>();
    let axis = axes.iter().position(|(name, _)| *name == at.axis);
    let unknown = || match &*names() {
        [] => "there is no sweep axis".to_owned(),
        names => {
            let hint = did_you_mean(&at.axis, names.iter().copied());
            format!("must be one of the axes, {}{hint}", names.join(", "))
        }
    };
    let axis = axis.ok_or_else(unknown)?;
    let (name, values) = axes[axis];
    let index = nearest(values, at.value);
    let value = values[index];
    if exact && value != at.value {
        let [wanted, value] = [at.value, value].map(|own| with_unit(name, own));
        return Err(format!(
            "{wanted} is no value of the axis; the nearest is {value}"
        ));
    }
    check_near(name, values, at.value)?;
    if chosen.iter().any(|(other, _)| *other == name) {
        return Err("is given twice".to_owned());
    }
    Ok((axis, index))
}

/// Relative distance at which a value still selects the only value of an axis: messages and file names have four digits.
const ROUNDED: f64 = 5e-4;

/// Checks that `wanted` is at most half a step beyond the `values` of the axis `name`.
fn check_near(name: &str, values: &[f64], wanted: f64) -> Result<(), String> {
    let (first, last) = (values[0], values[values.len() - 1]);
    let [below, above] = match values {
        [only] => [ROUNDED * only.abs(); 2],
        _ => [values[1] - first, last - values[values.len() - 2]].map(|step| step / 2.0),
    };
    if first - below <= wanted && wanted <= last + above {
        return Ok(());
    }
    let [wanted, first, last] = [wanted, first, last].map(|own| with_unit(name, own));
    Err(match values {
        [_] => format!("{wanted} is not on the axis, which has one value, {first}"),
        _ => format!(
            "{wanted} is more than half a step beyond the axis, which goes from {first} to {last}"
        ),
    })
}

/// Returns a value of the axis `name` as text, with the unit of a length or an angle.
fn with_unit(name: &str, value: f64) -> String {
    match Quantity::of(name).unit() {
        Some(unit) => format!("{} {unit}", digits(value)),
        None => digits(value),
    }
}

/// Returns the index of the value nearest to `wanted`.
fn nearest(values: &[f64], wanted: f64) -> usize {
    let apart = |value: &f64| (value - wanted).abs();
    let places = values.iter().enumerate();
    let nearest = places.min_by(|(_, a), (_, b)| apart(a).total_cmp(&apart(b)));
    nearest.map_or(0, |(place, _)| place)
}

#[cfg(test)]
mod tests {
    use super::{check_near, nearest};

    #[test]
    fn values_beyond_an_axis_are_refused_with_its_unit() {
        for (name, values, wanted, why) in [
            (
                "distance_mm",
                [15.66].as_slice(),
                15.7,
                "15.7 mm is not on the axis, which has one value, 15.66 mm",
            ),
            (
                "friction",
                &[0.0, 0.2],
                0.4,
                "0.4 is more than half a step beyond the axis, which goes from 0 to 0.2",
            ),
        ] {
            assert_eq!(check_near(name, values, wanted), Err(why.to_owned()));
        }
        assert_eq!(check_near("taper", &[0.5, 0.9], 1.1), Ok(()));
        // A single value is selected by every number that rounds to its four digits.
        let is_near = |wanted| check_near("taper", &[0.1001], wanted).is_ok();
        assert_eq!(
            [0.10005, 0.10015, 0.1000, 0.1002].map(is_near),
            [true, true, false, false]
        );
    }

    #[test]
    fn of_two_values_as_near_the_first_is_selected() {
        assert_eq!(
            [1.4, 1.5, 1.6].map(|wanted| nearest(&[1.0, 2.0], wanted)),
            [0, 0, 1]
        );
    }
}
