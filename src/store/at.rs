//! Values selected on the axes of a map or a store.

use crate::input::{Quantity, did_you_mean, shortened};
use crate::scene::{Coordinate, LONGEST_TITLE, Scene, SweepAxis, SweepVariable, digits};
use std::str::FromStr;

/// Selected value of an axis of a map or a store.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisValue {
    /// Name of the selected axis, such as `taper` or `distance_mm`.
    pub axis: String,
    /// Selected value, in the unit of the axis, or name of a whisker.
    pub value: Coordinate,
}

/// Reads `AXIS=VALUE`; the value of a length or an angle may have another unit than the axis. On the axis `whisker` it is a name.
///
/// ```
/// use whiskmap::store::AxisValue;
///
/// let at: AxisValue = "distance_mm = 1.5cm".parse()?;
/// assert_eq!((&*at.axis, at.value.number()), ("distance_mm", Some(15.0)));
/// # Ok::<(), String>(())
/// ```
impl FromStr for AxisValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (axis, value) = text.split_once('=').ok_or("must be AXIS=VALUE, such as taper=0.9")?;
        let axis = axis.trim();
        let value = match axis {
            SweepVariable::WHISKER => Coordinate::Name(value.trim().to_owned()),
            _ => Coordinate::Number(Quantity::of(axis).parse(value)?),
        };
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
        Self { axis: at.axis.clone(), why: why.to_string() }
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
    let axes: Vec<_> = sweep.map(NamedAxis::of).collect();
    let (mut builder, mut chosen) = (scene.to_builder(), ChosenValues::new());
    for at in wanted {
        let select = select(&axes, &chosen, at, exact);
        let (axis, index) = select.map_err(|why| InvalidAxisValue::new(at, why))?;
        let (sweep_axis, value) = (&scene.grid.sweep[axis], axes[axis].values[index]);
        let value = sweep_axis.variable.coordinate(value);
        let mut refused = scene.refused();
        if let Coordinate::Name(name) = &value
            && let Some((_, reason)) = refused.find(|(whisker, _)| whisker == name)
        {
            return Err(InvalidAxisValue::new(at, format!("{name}: {reason}")));
        }
        builder = builder.fixed(sweep_axis.variable.name(), &value);
        chosen.push((sweep_axis.variable.name(), value));
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
pub type ChosenValues = Vec<(&'static str, Coordinate)>;

/// Name and values of an axis, and the names of the whiskers of a table whose rows the values number.
pub(super) struct NamedAxis<'a> {
    pub name: &'static str,
    pub values: &'a [f64],
    pub names: &'a [String],
}

impl<'a> NamedAxis<'a> {
    /// Returns name and values of a sweep axis.
    pub fn of(axis: &'a SweepAxis) -> Self {
        Self { name: axis.variable.name(), values: &axis.values, names: axis.variable.names() }
    }
}

/// Returns names of selected axes, and their values as text to six digits.
pub(super) fn readable(chosen: &ChosenValues) -> impl Iterator<Item = (&'static str, String)> {
    let text = |(name, value): &(_, Coordinate)| (*name, value.rounded(6).to_string());
    chosen.iter().map(text)
}

/// Returns `title` with the selected values that it does not have already; the title of an extracted part has some.
pub(super) fn titled(title: &str, chosen: &ChosenValues) -> String {
    let chosen = readable(chosen).map(|(name, value)| format!(", {name} = {value}"));
    let is_new = |part: &String| !title.ends_with(&**part) && !title.contains(&format!("{part}, "));
    let new = chosen.filter(is_new);
    std::iter::once(title.to_owned()).chain(new).collect()
}

/// Returns the indices of the axis and of the value that `at` selects on `axes`, of which some are `chosen` already.
pub(super) fn select(
    axes: &[NamedAxis<'_>],
    chosen: &ChosenValues,
    at: &AxisValue,
    exact: bool,
) -> Result<(usize, usize), String> {
    let names = || axes.iter().map(|axis| axis.name).collect::<Vec<_>>();
    let axis = axes.iter().position(|axis| axis.name == at.axis);
    let unknown = || match &*names() {
        [] => "there is no sweep axis".to_owned(),
        names => {
            let hint = did_you_mean(&at.axis, names.iter().copied());
            format!("must be one of the axes, {}{hint}", names.join(", "))
        }
    };
    let axis = axis.ok_or_else(unknown)?;
    let NamedAxis { name, values, names } = &axes[axis];
    let index = match &at.value {
        Coordinate::Name(wanted) => named(values, names, wanted)?,
        Coordinate::Number(wanted) => numbered(name, values, *wanted, exact)?,
    };
    if chosen.iter().any(|(other, _)| other == name) {
        return Err("is given twice".to_owned());
    }
    Ok((axis, index))
}

/// Returns the index of the whisker `wanted` among the `values` of an axis, which number the rows of a table with these `names`.
fn named(values: &[f64], names: &[String], wanted: &str) -> Result<usize, String> {
    let row = names.iter().position(|name| name == wanted);
    let index = row.and_then(|row| values.iter().position(|value| *value == (row + 1) as f64));
    index.ok_or_else(|| {
        let rows = values.iter().filter_map(|value| names.get(*value as usize - 1));
        let known: Vec<&str> = rows.map(String::as_str).collect();
        let hint = did_you_mean(wanted, known.iter().copied());
        let shown = known.iter().take(MOST_SHOWN).map(|name| shortened(name));
        let shown = shown.collect::<Vec<_>>().join(", ");
        let rest = match known.len().saturating_sub(MOST_SHOWN) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("there is no whisker {}; must be one of {shown}{rest}{hint}", shortened(wanted))
    })
}

/// Number of names of whiskers that a message lists.
const MOST_SHOWN: usize = 12;

/// Returns the index of the value of the axis `name` that is nearest to `wanted`, and equal to it if `exact`.
fn numbered(name: &str, values: &[f64], wanted: f64, exact: bool) -> Result<usize, String> {
    let index = nearest(values, wanted);
    let value = values[index];
    if exact && value != wanted {
        let [wanted, value] = [wanted, value].map(|number| with_unit(name, number));
        return Err(format!("{wanted} is no value of the axis; the nearest is {value}"));
    }
    check_near(name, values, wanted)?;
    Ok(index)
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
    let [wanted, first, last] = [wanted, first, last].map(|number| with_unit(name, number));
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
        assert_eq!([0.10005, 0.10015, 0.1000, 0.1002].map(is_near), [true, true, false, false]);
    }

    #[test]
    fn of_two_values_as_near_the_first_is_selected() {
        assert_eq!([1.4, 1.5, 1.6].map(|wanted| nearest(&[1.0, 2.0], wanted)), [0, 0, 1]);
    }
}
