//! The attributes of an EXR map, as ASCII JSON.

use super::layout::AtlasLayout;
use super::tally::{CellCounts, regimes, statuses};
use crate::engine;
use crate::map::{Audit, EngineCells};
use crate::plan::{Channels, Digits};
use crate::scene::{Grid, Parameter, SceneData, SweepAxis, SweepVariable};
use exr::meta::attribute::{AttributeValue, Text};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};

/// Description of a map before it is computed: scene, engine, tolerances and channels.
#[derive(Clone, Copy, Debug)]
pub struct MapDescription<'a> {
    /// Scene that is computed.
    pub scene: &'a SceneData,
    /// Engine of the run, and its device.
    pub engine: &'a engine::EngineDescription,
    /// Tolerances and step limits of the run, as JSON.
    pub tolerances: &'a Value,
    /// Channels of the map that are stored.
    pub channels: Channels,
    /// Digits to which the channels of the map are rounded.
    pub digits: Digits,
    /// Rounding of the CPU of the run: the [name](whiskmap_mechanics::numerics::ArithmeticClass::name) of an arithmetic class.
    pub arithmetic: &'a str,
}

/// Axis of a map in the attribute `axes`.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct AxisAttribute {
    name: String,
    unit: String,
    /// `x` and `y` inside a panel, `panel x` and `panel y` from one panel to the next.
    direction: String,
    /// Place of the first value.
    first: String,
    values: Vec<f64>,
    /// Names of the whiskers of a table, `[row]`, whose numbers from 1 are the values; absent for numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    names: Vec<String>,
}

/// Name, unit, direction and place of the first value of the axes inside a panel.
const INSIDE: [[&str; 4]; 2] = [
    ["push_angle_deg", "deg", "x", "column 0 of the panel (left)"],
    ["distance_mm", "mm", "y", "row 0 of the panel (top)"],
];

/// Direction and place of the first value of the axes from one panel to the next.
const ATLAS: [[&str; 2]; 2] =
    [["panel x", "column 0 of the atlas (left)"], ["panel y", "row 0 of the atlas (top)"]];

/// Name of the attribute with the CRC-32C of all bytes before the offset tables, in 8 hexadecimal digits.
pub(super) const CHECKSUM: &str = "checksum";

/// Digits of the checksum of an EXR map while it is computed.
pub(super) const NO_CHECKSUM: &str = "00000000";

/// Name of the attribute with the digits of rounded channels; a file without it stores all bits.
pub(super) const DIGITS: &str = "digits";

/// Returns the text of the attribute [`DIGITS`]: the stored channels that are rounded, if any.
pub(super) fn digits(about: &MapDescription<'_>) -> Option<String> {
    let digits = about.digits.of(about.channels);
    (digits != Digits::ALL).then(|| digits.to_string())
}

/// Attributes of an EXR map: texts by name.
pub(super) type ExrAttributes = HashMap<Text, AttributeValue>;

/// Creates the attribute `name` of an EXR map with this `text`.
pub(super) fn attribute(name: &str, text: &str) -> (Text, AttributeValue) {
    (Text::from(name), AttributeValue::Text(Text::from(text)))
}

/// Encodes all attributes of an EXR map but `counts`, which [`encode_counts`] makes.
pub(super) fn encode(about: &MapDescription<'_>) -> ExrAttributes {
    let layout = AtlasLayout::of(&about.scene.grid);
    let attributes = [
        ("axes", json!(axes(&about.scene.grid))),
        ("scene", json!(about.scene.text.to_string())),
        ("title", json!(about.scene.title)),
        ("whiskmap_version", json!(env!("CARGO_PKG_VERSION"))),
        ("engine", json!(about.engine.engine)),
        ("adapter", json!(about.engine.adapter)),
        ("arithmetic", json!(about.arithmetic)),
        ("tolerances", json!(about.tolerances)),
        ("regime_names", json!(regimes())),
        ("status_names", json!(statuses())),
        ("panels", json!([layout.columns, layout.rows])),
        (CHECKSUM, json!(NO_CHECKSUM)),
    ];
    let digits = digits(about).map(|digits| (DIGITS, json!(digits)));
    let encoded = attributes.into_iter().chain(digits);
    encoded.map(|(name, value)| attribute(name, &ascii_json(&value))).collect()
}

/// Encodes the attribute `counts`, padded with spaces to [`counts_width`].
pub(super) fn encode_counts(counts: &CellCounts) -> String {
    let text = ascii_json(&json!(counts));
    format!("{text:width$}", width = counts_width())
}

/// Returns the length in bytes of the longest text that [`encode_counts`] can make.
pub(super) fn counts_width() -> usize {
    let most = |name: &'static str| (name.to_owned(), u64::MAX);
    let counts = CellCounts {
        regimes: regimes().into_values().map(most).collect(),
        statuses: statuses().into_values().map(most).collect(),
        worst_residual: Some(-f64::MIN_POSITIVE),
        engine_cells: EngineCells {
            solved: u64::MAX,
            near_edge: u64::MAX,
            missed: u64::MAX,
            not_finite: u64::MAX,
            without_row: u64::MAX,
            on_cpu_instead: u64::MAX,
        },
        audit: Audit { cells: u64::MAX, differing: u64::MAX, turned_over: u64::MAX },
    };
    ascii_json(&json!(counts)).len()
}

/// The attribute `axes` of a grid.
fn axes(grid: &Grid) -> Vec<AxisAttribute> {
    let axis = |[name, unit, direction, first]: [&str; 4], values: &[f64]| AxisAttribute {
        name: name.to_owned(),
        unit: unit.to_owned(),
        direction: direction.to_owned(),
        first: first.to_owned(),
        values: values.to_owned(),
        names: Vec::new(),
    };
    let [push_angle, distance] = INSIDE;
    let inside = [axis(push_angle, &grid.push_angle_deg), axis(distance, &grid.distance_mm)];
    let atlas = grid.atlas().into_iter().zip(ATLAS);
    let atlas = atlas.filter_map(|(sweep_axis, [direction, first])| {
        let SweepAxis { variable, values } = sweep_axis?;
        let about = [variable.name(), variable.unit(), direction, first];
        Some(AxisAttribute { names: variable.names().to_vec(), ..axis(about, values) })
    });
    inside.into_iter().chain(atlas).collect()
}

/// Returns the grid that the attribute `axes` describes.
///
/// # Errors
/// An axis is unknown, missing or one too many, or its values are not increasing.
pub(super) fn decode_axes(mut found: Vec<AxisAttribute>) -> Result<Grid, String> {
    for axis in &found {
        if axis.values.is_empty() || !axis.values.is_sorted_by(|one, next| one < next) {
            return Err(format!("the values of `{}` do not increase", axis.name));
        }
    }
    let mut take = |name: &str| {
        let place = found.iter().position(|axis| axis.name == name);
        let place = place.ok_or_else(|| format!("there is no axis {name}"))?;
        Ok::<_, String>(found.remove(place).values)
    };
    let [push_angle_deg, distance_mm] = INSIDE.map(|[name, ..]| take(name));
    let mut grid =
        Grid { push_angle_deg: push_angle_deg?, distance_mm: distance_mm?, sweep: Vec::new() };
    found.sort_by(|one, next| one.direction.cmp(&next.direction));
    for AxisAttribute { name, values, names, .. } in found {
        let are_rows = values
            .iter()
            .all(|value| (1.0..=names.len() as f64).contains(value) && value.fract() == 0.0);
        let known = Parameter::SWEPT.into_iter().map(SweepVariable::from);
        let known = known.chain(are_rows.then(|| SweepVariable::Whisker(names.into())));
        let variable = known
            .filter(|variable| grid.sweep.iter().all(|axis| axis.variable != *variable))
            .find(|variable| variable.name() == name)
            .ok_or_else(|| format!("the axis `{name}` is unknown or there twice"))?;
        grid.sweep.push(SweepAxis { variable, values });
    }
    if grid.sweep.len() > ATLAS.len() {
        return Err("an atlas has at most two axes".to_owned());
    }
    Ok(grid)
}

/// Returns a JSON value with the names of every object sorted. The order that `serde_json` keeps depends on features that other crates
/// enable.
pub(super) fn sorted(value: &Value) -> Value {
    match value {
        Value::Object(names) => {
            let names: BTreeMap<_, _> =
                names.iter().map(|(name, value)| (name.clone(), sorted(value))).collect();
            names.into_iter().collect()
        }
        Value::Array(values) => values.iter().map(sorted).collect(),
        other => other.clone(),
    }
}

/// JSON with every character beyond ASCII as `\uXXXX`, in surrogate pairs where needed: other readers refuse a file with a
/// single `µ`.
fn ascii_json(value: &Value) -> String {
    let json = sorted(value).to_string();
    let mut ascii = String::with_capacity(json.len());
    for unit in json.encode_utf16() {
        match u8::try_from(unit) {
            Ok(byte) if byte.is_ascii() => ascii.push(char::from(byte)),
            _ => ascii.push_str(&format!("\\u{unit:04x}")),
        }
    }
    ascii
}
