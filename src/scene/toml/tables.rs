//! Keys of a scene file, and a reader that accepts these and no others.

use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};

use super::rows::{PairList, ProfileRows, RestPoints};
use crate::scene::SceneBuilder;
use crate::scene::axis::{AxisScale, AxisValues};
use crate::scene::parameter::Parameter;
use crate::scene::profile;
use crate::scene::shape;

/// The value of a key: its kind, and its place in the description.
#[derive(Clone, Copy, PartialEq)]
enum KeyValue {
    Title,
    Number(Parameter),
    Rows,
    RestPoints,
    RestDegree,
    RestCurvature,
    PushAngles,
    Distances,
    Sweep(Parameter),
    OutputName,
    Deviations,
    Surface,
    Table,
}

/// Keys that may be left out, also in a table that is given; the axes of the sweep may be left out, too.
const OPTIONAL: [&str; 21] = [
    Parameter::BaseRadiusUm.key(),
    Parameter::TipRadiusUm.key(),
    "whisker.profile",
    "whisker.rest",
    shape::DEGREE_KEY,
    shape::CURVATURE_KEY,
    Parameter::ProfileScale.key(),
    Parameter::TipExtensionMm.key(),
    "whisker.curvature",
    Parameter::ParabolaPerMm.key(),
    Parameter::VertexMm.key(),
    "whisker.curvature.euler_spiral",
    "whisker.projection",
    "whisker.follicle",
    "whisker.modulus_gradient",
    "pole",
    "contact",
    "output",
    "output.name",
    "uncertainty",
    "surface",
];

/// Every key of a scene file that is no table of keys.
fn keys() -> impl Iterator<Item = (&'static str, KeyValue)> {
    let numbers = Parameter::ALL
        .into_iter()
        .filter(|own| *own != Parameter::Taper)
        .map(|own| (own.key(), KeyValue::Number(own)));
    let axes = Parameter::SWEPT.map(|own| (own.axis_key(), KeyValue::Sweep(own)));
    let before = [("title", KeyValue::Title)];
    let between = [
        (profile::KEY, KeyValue::Rows),
        (shape::POINTS_KEY, KeyValue::RestPoints),
        (shape::DEGREE_KEY, KeyValue::RestDegree),
        (shape::CURVATURE_KEY, KeyValue::RestCurvature),
        ("grid.push_angle_deg", KeyValue::PushAngles),
        ("grid.distance_mm", KeyValue::Distances),
    ];
    let after = [
        ("output.name", KeyValue::OutputName),
        ("uncertainty", KeyValue::Deviations),
        ("surface", KeyValue::Surface),
    ];
    let all = before.into_iter().chain(numbers).chain(between);
    all.chain(axes).chain(after)
}

/// Names and values of the keys of the table at `path`, which is empty or ends in a dot.
fn keys_in(path: &str) -> Vec<(&'static str, KeyValue)> {
    let mut inside: Vec<(&str, KeyValue)> = Vec::new();
    for (key, value) in keys() {
        let (name, value) = match key.strip_prefix(path).map(|key| (key, key.split_once('.'))) {
            None => continue,
            Some((_, Some((table, _)))) => (table, KeyValue::Table),
            Some((name, None)) => (name, value),
        };
        if inside.iter().all(|(other, _)| *other != name) {
            inside.push((name, value));
        }
    }
    inside
}

/// Values of a scene file: right in type, not yet checked. The axes of the sweep are in the order of the file.
#[derive(Default)]
pub(super) struct SceneTable {
    pub builder: SceneBuilder,
    pub rows: Option<PairList<ProfileRows>>,
    pub rest: Option<PairList<RestPoints>>,
    /// Degree of the traced curvature; `None` if cross-validation chooses it.
    pub rest_degree: Option<i64>,
    /// Coefficients of the traced curvature; `None` if they are those of the fit.
    pub rest_curvature: Option<Vec<f64>>,
    /// Standard deviations of the scene's numbers by name, each in its unit; `None` without the table.
    pub deviations: Option<BTreeMap<String, f64>>,
}

impl<'de> Deserialize<'de> for SceneTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut scene = Self::default();
        let path = String::new();
        let reader = TableReader(path, &mut scene);
        reader.deserialize(deserializer).map(|()| scene)
    }
}

/// Reads the table at a path, which is empty or ends in a dot, into a scene.
struct TableReader<'a>(String, &'a mut SceneTable);

impl<'de> DeserializeSeed<'de> for TableReader<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for TableReader<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut table: A) -> Result<(), A::Error> {
        let Self(path, scene) = self;
        let keys = keys_in(&path);
        let mut missing = keys.clone();
        missing.retain(|(name, value)| {
            let is_axis = matches!(value, KeyValue::Sweep(_));
            !is_axis && !OPTIONAL.contains(&&*format!("{path}{name}"))
        });
        while let Some(key @ (name, value)) = table.next_key_seed(KeyReader(&keys))? {
            missing.retain(|other| *other != key);
            let builder = &mut scene.builder;
            match value {
                KeyValue::Title => builder.title = table.next_value()?,
                KeyValue::Number(parameter) => builder.numbers.set(parameter, table.next_value()?),
                KeyValue::Rows => scene.rows = Some(table.next_value()?),
                KeyValue::RestPoints => scene.rest = Some(table.next_value()?),
                KeyValue::RestDegree => scene.rest_degree = Some(table.next_value()?),
                KeyValue::RestCurvature => scene.rest_curvature = Some(table.next_value()?),
                KeyValue::PushAngles => builder.push_angle_deg = table.next_value()?,
                KeyValue::Distances => builder.distance_mm = table.next_value()?,
                KeyValue::Sweep(parameter) => {
                    builder.sweep.push((parameter, table.next_value()?));
                }
                KeyValue::OutputName => builder.name = Some(table.next_value()?),
                KeyValue::Surface => builder.surface = Some(table.next_value()?),
                KeyValue::Deviations => scene.deviations = Some(table.next_value()?),
                KeyValue::Table => {
                    table.next_value_seed(TableReader(format!("{path}{name}."), scene))?;
                }
            }
        }
        // Traced points have a length.
        let is_traced = scene.rest.is_some();
        missing
            .retain(|(name, _)| !is_traced || format!("{path}{name}") != Parameter::LengthMm.key());
        let absent = missing.first();
        absent.map_or(Ok(()), |(name, _)| Err(A::Error::missing_field(name)))
    }
}

/// Reads one of these keys.
struct KeyReader<'a>(&'a [(&'static str, KeyValue)]);

impl<'de> DeserializeSeed<'de> for KeyReader<'_> {
    type Value = (&'static str, KeyValue);

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        let name = String::deserialize(deserializer)?;
        let known = self.0.iter().find(|(own, _)| *own == name);
        known.copied().ok_or_else(|| {
            let names = self.0.iter().map(|(own, _)| format!("`{own}`"));
            let names: Vec<String> = names.collect();
            let expected = match &names[..] {
                [only] => only.clone(),
                [one, other] => format!("{one} or {other}"),
                _ => format!("one of {}", names.join(", ")),
            };
            D::Error::custom(format!("unknown field `{name}`, expected {expected}"))
        })
    }
}

/// `{ from, to, count, scale }`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RangeTable {
    from: f64,
    to: Option<f64>,
    count: i64,
    #[serde(default)]
    scale: AxisScale,
}

impl<'de> Deserialize<'de> for AxisValues {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AxisVisitor)
    }
}

/// Chooses by the value's kind. Unlike an untagged enum, it keeps the places and the inner messages.
struct AxisVisitor;

impl<'de> Visitor<'de> for AxisVisitor {
    type Value = AxisValues;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of numbers or { from, to, count }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<AxisValues, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(AxisValues::List)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<AxisValues, A::Error> {
        let range: RangeTable = Deserialize::deserialize(MapAccessDeserializer::new(table))?;
        Ok(AxisValues::Range {
            from: range.from,
            to: range.to,
            // A negative count is refused like 0.
            count: usize::try_from(range.count).unwrap_or(0),
            scale: range.scale,
        })
    }
}
