//! An axis of the sweep: `{ from, to, count, scale }` or an explicit list, turned into values.

use std::fmt;

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use super::error::{DECIMAL_POINTS, Fault};
use super::limits::{Limits, Number};

/// More values than this on one axis are a slip of the pen, and would be refused before they are made.
const MOST_VALUES: usize = 65_536;

/// An axis as the file has it.
pub(super) enum Axis {
    List(Vec<Number>),
    Range(Range),
}

/// `count` values from `from` to `to`; one value needs no `to`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Range {
    from: Number,
    to: Option<Number>,
    count: Spanned<i64>,
    #[serde(default)]
    scale: Scale,
}

/// How the values of a range are spaced.
#[derive(Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Scale {
    /// At equal distances.
    #[default]
    Linear,
    /// At equal ratios.
    Log,
}

/// The values of an axis: within the limits, strictly increasing, at least one.
pub(super) fn values(axis: &Spanned<Axis>, key: &str, limits: &Limits) -> Result<Vec<f64>, Fault> {
    match axis.get_ref() {
        Axis::List(list) if (1..=MOST_VALUES).contains(&list.len()) => listed(list, key, limits),
        Axis::List(list) => {
            let must = format!(
                "must have between 1 and {MOST_VALUES} values, has {}",
                list.len()
            );
            Err(Fault::new(key, axis.span(), must))
        }
        Axis::Range(axis) => range(axis, key, limits),
    }
}

fn listed(list: &[Number], key: &str, limits: &Limits) -> Result<Vec<f64>, Fault> {
    let mut values: Vec<f64> = Vec::with_capacity(list.len());
    for (i, number) in list.iter().enumerate() {
        let key = format!("{key}[{i}]");
        let value = limits.check(&key, number)?;
        if let Some(before) = values.last().filter(|before| value <= **before) {
            // `10,5` was meant as one number.
            let is_tight = i > 0 && list[i - 1].span().end + 1 == number.span().start;
            let is_comma = is_tight && [*before, value].iter().all(|own| own.fract() == 0.0);
            let hint = if is_comma { DECIMAL_POINTS } else { "" };
            let must = format!("must be greater than the value before it ({before}){hint}");
            return Err(Fault::new(key, number.span(), must));
        }
        values.push(value);
    }
    Ok(values)
}

fn range(axis: &Range, key: &str, limits: &Limits) -> Result<Vec<f64>, Fault> {
    let count_key = format!("{key}.count");
    let to_key = format!("{key}.to");
    let refuse_count = |must: String| Fault::new(&*count_key, axis.count.span(), must);

    let count = usize::try_from(*axis.count.get_ref())
        .ok()
        .filter(|count| (1..=MOST_VALUES).contains(count))
        .ok_or_else(|| refuse_count(format!("must be between 1 and {MOST_VALUES}")))?;
    let from_key = format!("{key}.from");
    let from = limits.check(&from_key, &axis.from)?;
    if axis.scale == Scale::Log && from <= 0.0 {
        let must = "must be greater than 0 where scale is \"log\"";
        return Err(Fault::new(from_key, axis.from.span(), must));
    }
    let Some(end) = &axis.to else {
        return match count {
            1 => Ok(vec![from]),
            _ => Err(refuse_count("must be 1 where `to` is left out".into())),
        };
    };
    let to = limits.check(&to_key, end)?;
    if count == 1 {
        return if from == to {
            Ok(vec![from])
        } else {
            let must = format!("must be left out or equal to from ({from}) where count is 1");
            Err(Fault::new(to_key, end.span(), must))
        };
    }
    if to <= from {
        let must = format!("must be greater than from ({from})");
        return Err(Fault::new(to_key, end.span(), must));
    }

    let last = count - 1;
    let values: Vec<f64> = (0..count)
        .map(|i| match i {
            // `from + (to - from)` may miss `to` by a rounding.
            _ if i == last => to,
            _ if axis.scale == Scale::Log => from * libm::pow(to / from, i as f64 / last as f64),
            _ => from + (to - from) * i as f64 / last as f64,
        })
        .collect();
    if values.is_sorted_by(|a, b| a < b) {
        Ok(values)
    } else {
        Err(refuse_count(format!(
            "must be smaller: between {from} and {to}, neighbours would coincide"
        )))
    }
}

impl<'de> Deserialize<'de> for Axis {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AxisVisitor)
    }
}

/// Chooses by the value's kind; unlike an untagged enum, it keeps the spans and the inner messages.
struct AxisVisitor;

impl<'de> Visitor<'de> for AxisVisitor {
    type Value = Axis;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of numbers or { from, to, count }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Axis, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(Axis::List)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<Axis, A::Error> {
        Deserialize::deserialize(MapAccessDeserializer::new(table)).map(Axis::Range)
    }
}
