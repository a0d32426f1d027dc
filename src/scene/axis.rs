//! Values of a scene's axis: a list, or a range with a number of values.

use super::error::SceneFault;
use super::limits::{NumberLimits, digits};

/// Most values of one axis.
const MOST_VALUES: usize = 65_536;

/// Start of the message about values of an axis that do not increase.
pub(super) const NOT_GROWING: &str = "must be greater than the value before it";

/// Values of an axis as a scene gives them. A built scene accepts strictly increasing values only.
///
/// ```
/// use whiskmap::scene::AxisValues;
///
/// let list: AxisValues = [1.0, 2.5].into();
/// assert_eq!(list, AxisValues::List(vec![1.0, 2.5]));
/// let range = AxisValues::linear(-70.0, 70.0, 512);
/// # let _ = range;
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum AxisValues {
    /// List of all values of an axis, in the axis' unit, `[value]`.
    List(Vec<f64>),
    /// Range of `count` values of an axis from `from` to `to`; a range of one value needs no `to`.
    Range {
        /// First value of the range, in the axis' unit.
        from: f64,
        /// Last value of the range, in the axis' unit; `None` for a range of one value.
        to: Option<f64>,
        /// Number of values of the range.
        count: usize,
        /// Spacing of the values of the range: linear or logarithmic.
        scale: AxisScale,
    },
}

/// Spacing of the values of a range: equal differences or equal ratios.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum AxisScale {
    /// Equal differences between neighbouring values of a range.
    #[default]
    Linear,
    /// Equal ratios of neighbouring values of a range.
    Log,
}

impl Default for AxisValues {
    fn default() -> Self {
        Self::List(Vec::new())
    }
}

impl From<Vec<f64>> for AxisValues {
    fn from(values: Vec<f64>) -> Self {
        Self::List(values)
    }
}

impl From<&[f64]> for AxisValues {
    fn from(values: &[f64]) -> Self {
        Self::List(values.to_vec())
    }
}

impl<const N: usize> From<[f64; N]> for AxisValues {
    fn from(values: [f64; N]) -> Self {
        Self::List(values.to_vec())
    }
}

impl AxisValues {
    /// Creates a range of `count` values with equal differences, from `from` to `to`, in the axis' unit.
    #[must_use]
    pub const fn linear(from: f64, to: f64, count: usize) -> Self {
        Self::Range { from, to: Some(to), count, scale: AxisScale::Linear }
    }

    /// Returns the values of the axis `key`, in its unit, if they are within the limits, strictly increasing, and at least one,
    /// `[value]`.
    pub(super) fn checked(&self, key: &str, limits: &NumberLimits) -> Result<Vec<f64>, SceneFault> {
        match self {
            Self::List(list) if (1..=MOST_VALUES).contains(&list.len()) => {
                listed(list, key, limits)
            }
            Self::List(list) => {
                let count = list.len();
                let must = format!("must have between 1 and {MOST_VALUES} values, has {count}");
                Err(SceneFault::new(key, must))
            }
            &Self::Range { from, to, count, scale } => {
                let values = range(key, limits, [Some(from), to], count, scale == AxisScale::Log)?;
                if values.is_sorted_by(|a, b| a < b) {
                    return Ok(values);
                }
                let ends = format!("{from} and {}", to.unwrap_or(from));
                let must = format!("must be smaller: between {ends}, neighbours would coincide");
                Err(SceneFault::of_value(format!("{key}.count"), count.to_string(), must))
            }
        }
    }
}

fn listed(list: &[f64], key: &str, limits: &NumberLimits) -> Result<Vec<f64>, SceneFault> {
    for (i, &value) in list.iter().enumerate() {
        let key = || format!("{key}[{i}]");
        limits.check(&key(), value)?;
        if let Some(before) = list[..i].last().filter(|before| value <= **before) {
            let must = format!("{NOT_GROWING} ({before})");
            return Err(SceneFault::of_value(key(), digits(value), must));
        }
    }
    Ok(list.to_vec())
}

fn range(
    key: &str,
    limits: &NumberLimits,
    ends: [Option<f64>; 2],
    count: usize,
    is_log: bool,
) -> Result<Vec<f64>, SceneFault> {
    let refuse = |name: &str, value: String, must: String| {
        Err(SceneFault::of_value(format!("{key}.{name}"), value, must))
    };
    if !(1..=MOST_VALUES).contains(&count) {
        let must = format!("must be between 1 and {MOST_VALUES}");
        return refuse("count", count.to_string(), must);
    }
    let from = limits.check(&format!("{key}.from"), ends[0].unwrap_or(f64::NAN))?;
    if is_log && from <= 0.0 {
        let must = "must be greater than 0 where scale is \"log\"".to_owned();
        return refuse("from", digits(from), must);
    }
    let Some(to) = ends[1] else {
        return match count {
            1 => Ok(vec![from]),
            _ => refuse("count", count.to_string(), "must be 1 where `to` is left out".to_owned()),
        };
    };
    limits.check(&format!("{key}.to"), to)?;
    match count {
        1 if from == to => return Ok(vec![from]),
        1 => {
            let must = format!("must be left out or equal to from ({from}) where count is 1");
            return refuse("to", digits(to), must);
        }
        _ if to <= from => {
            let must = format!("must be greater than from ({from})");
            return refuse("to", digits(to), must);
        }
        _ => {}
    }
    let last = count - 1;
    let values = (0..count).map(|i| match i {
        // `from + (to - from)` may miss `to` by a rounding.
        _ if i == last => to,
        _ if is_log => from * libm::pow(to / from, i as f64 / last as f64),
        _ => from + (to - from) * i as f64 / last as f64,
    });
    Ok(values.collect())
}
