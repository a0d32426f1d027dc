//! Values selected on the axes of a map or a store.

use crate::input::Quantity;
use crate::scene::digits;
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

/// Relative distance at which a value still selects the only value of an axis: messages and file names have four digits.
const ROUNDED: f64 = 5e-4;

/// Checks that `wanted` is at most half a step beyond the `values` of the axis `name`.
pub(super) fn check_near(name: &str, values: &[f64], wanted: f64) -> Result<(), String> {
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
pub(super) fn with_unit(name: &str, value: f64) -> String {
    match Quantity::of(name).unit() {
        Some(unit) => format!("{} {unit}", digits(value)),
        None => digits(value),
    }
}

/// Returns the index of the value nearest to `wanted`.
pub(super) fn nearest(values: &[f64], wanted: f64) -> usize {
    let apart = |value: &f64| (value - wanted).abs();
    let places = values.iter().enumerate();
    let nearest = places.min_by(|(_, a), (_, b)| apart(a).total_cmp(&apart(b)));
    nearest.map_or(0, |(place, _)| place)
}

#[cfg(test)]
mod tests {
    use super::check_near;

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
    }
}
