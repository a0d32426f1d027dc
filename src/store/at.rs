//! Values wanted on axes.

use crate::input::Quantity;
use std::str::FromStr;

/// A value wanted on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct At {
    /// The axis by its name, such as `taper` or `distance_mm`.
    pub axis: String,
    /// The value, in the unit of the axis.
    pub value: f64,
}

/// Reads `AXIS=VALUE`; the value of a length or an angle may have another unit than the axis.
///
/// ```
/// use whiskmap::store::At;
///
/// let at: At = "distance_mm = 1.5cm".parse()?;
/// assert_eq!((&*at.axis, at.value), ("distance_mm", 15.0));
/// # Ok::<(), String>(())
/// ```
impl FromStr for At {
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

/// How close a value must be to the only one of an axis, relative to it: messages and file names have
/// four digits.
const ROUNDED: f64 = 5e-4;

/// Whether `wanted` is at most half a step beyond the axis of these `values`.
pub(super) fn is_near(values: &[f64], wanted: f64) -> bool {
    let half_steps = match values {
        [only] => [ROUNDED * only.abs(); 2],
        [first, second, ..] => {
            let [last, before] = [1, 2].map(|back| values[values.len() - back]);
            [second - first, last - before].map(|step| step / 2.0)
        }
        [] => return false,
    };
    let [below, above] = half_steps;
    values[0] - below <= wanted && wanted <= values[values.len() - 1] + above
}

/// The place of the value nearest to `wanted`.
pub(super) fn nearest(values: &[f64], wanted: f64) -> usize {
    let apart = |value: &f64| (value - wanted).abs();
    let places = values.iter().enumerate();
    let nearest = places.min_by(|(_, a), (_, b)| apart(a).total_cmp(&apart(b)));
    nearest.map_or(0, |(place, _)| place)
}
