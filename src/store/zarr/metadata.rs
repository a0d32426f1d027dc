//! Arrays and attributes of a store.

use super::array::{ZarrArray, about};
use super::blocks::Blocks;
use super::channels::{channel, with_flags};
use super::encoding::ChunkEncoding;
use super::encoding::ValueKind::{self, Code, Count};
use super::identity::{AGREED, IDENTITY, StoreIdentity};
use crate::classify::Regime;
use crate::plan::channels::CHANNELS;
use crate::plan::{Channels, Digits, STATE_CHANNELS};
use crate::scene::{Coordinate, Grid, Parameter, SceneData};
use crate::store::MapDescription;
use crate::store::attributes::{DIGITS, digits};
use serde_json::{Map, Value, json};

/// Name of the array with the number of cells of each regime: `[sweep axes.., regime]`.
pub(super) const CELLS: &str = "regime_cells";

/// Coordinate with the codes of the regimes, the last axis of [`CELLS`].
const CODES: &str = "regime_code";

/// The arrays that are filled block by block. The regimes, which mark a block as finished, are the last.
pub(super) fn arrays(
    grid: &Grid,
    blocks: &Blocks,
    (channels, digits): (Channels, Digits),
) -> Vec<ZarrArray> {
    let sweep: Vec<&str> = grid.sweep.iter().map(|axis| axis.variable.name()).collect();
    let of_cells = [&sweep[..], &["distance_mm", "push_angle_deg"]].concat();
    let of_regimes = [&sweep[..], &[CODES]].concat();
    let mut arrays = vec![ZarrArray::in_blocks(
        CELLS,
        Count,
        blocks,
        (&[[Regime::ALL.len(); 3]], ChunkEncoding::default()),
        &of_regimes,
        about(None, "cells of each regime"),
    )];
    let ([distances, push_angles], [chunk, filled]) = (blocks.panel, blocks.distances());
    let sizes = [[distances, filled, chunk], [push_angles; 3]];
    let others = channels.names().filter(|name| *name != "regime");
    for name in others.chain(["regime"]) {
        let Some((kind, mut about)) = channel(name) else {
            continue;
        };
        // Columns make quantities 8 % smaller, but a line of margins is the one before it, shifted, and derivatives are equal along a line.
        let is_turned =
            STATE_CHANNELS.contains(&name) || ["residual", "peak_strain"].contains(&name);
        let kept_bits = digits.mantissa_bits(name);
        let encoding = ChunkEncoding { width: is_turned.then_some(push_angles), kept_bits };
        let sizes = (&sizes[..], encoding);
        if let Some(bits) = kept_bits {
            about["quantization"] = json!(QUANTIZATION);
            about["quantization_nsb"] = json!(bits);
        }
        arrays.push(ZarrArray::in_blocks(name, kind, blocks, sizes, &of_cells, about));
    }
    arrays
}

/// Array without axes whose attributes describe the rounding (CF conventions, 8.4).
const QUANTIZATION: &str = "quantization";

/// Coordinate of maps: values along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisCoordinate {
    /// Name of the coordinate and of its dimension.
    pub name: &'static str,
    /// Attributes of the coordinate by the CF conventions: unit and meaning.
    pub attributes: Value,
    /// Values of the coordinate in its unit, or names of whiskers, `[value]`.
    pub values: Vec<Coordinate>,
}

/// Returns the coordinates of a grid in the order of the dimensions of channels, `[axis]`: sweep axes, distances and push angles.
#[must_use]
pub fn coordinates(grid: &Grid) -> Vec<AxisCoordinate> {
    let numbers = |values: &[f64]| values.iter().copied().map(Coordinate::Number).collect();
    let inside = [
        AxisCoordinate {
            name: "distance_mm",
            attributes: about(Some("mm"), "distance at first touch"),
            values: numbers(&grid.distance_mm),
        },
        AxisCoordinate {
            name: "push_angle_deg",
            attributes: about(Some("degree"), "push angle (positive: CB)"),
            values: numbers(&grid.push_angle_deg),
        },
    ];
    let sweep = grid.sweep.iter().map(|axis| {
        let variable = &axis.variable;
        let unit = variable.parameter().map(Parameter::unit);
        AxisCoordinate {
            name: variable.name(),
            attributes: about(unit, variable.title()),
            values: axis.coordinates().collect(),
        }
    });
    sweep.chain(inside).collect()
}

/// The coordinates along every axis, and the description of the rounding if there is any, with their values as bytes.
pub(super) fn constants(grid: &Grid, digits: Digits) -> Vec<(ZarrArray, Vec<u8>)> {
    let mut all = Vec::new();
    for axis in coordinates(grid) {
        let (kind, bytes) = packed(&axis.values);
        let array = ZarrArray::of_axis(axis.name, kind, axis.values.len(), axis.attributes);
        all.push((array, bytes));
    }
    let codes = Regime::ALL.map(|regime| regime.code() as u8).to_vec();
    let (_, units, meaning, _) = CHANNELS[0];
    let about = with_flags("regime", about(units, meaning));
    all.push((ZarrArray::of_axis(CODES, Code, codes.len(), about), codes));
    if digits != Digits::ALL {
        let about = json!({
            "algorithm": "bitround",
            "implementation": concat!("whiskmap version ", env!("CARGO_PKG_VERSION")),
        });
        all.push((ZarrArray::scalar(QUANTIZATION, Code, about), vec![0]));
    }
    all
}

/// Returns the kind of the values of an axis, and their bytes in a chunk.
fn packed(values: &[Coordinate]) -> (ValueKind, Vec<u8>) {
    let numbers: Option<Vec<f64>> = values.iter().map(Coordinate::number).collect();
    if let Some(numbers) = numbers {
        return (ValueKind::Coordinate, bytemuck::cast_slice(&numbers).to_vec());
    }
    // `vlen-utf8`: the number of texts, then each with its length.
    let count = |count: usize| (count as u32).to_le_bytes();
    let mut bytes = count(values.len()).to_vec();
    for value in values {
        let name = value.to_string();
        bytes.extend(count(name.len()));
        bytes.extend(name.into_bytes());
    }
    (ValueKind::Name, bytes)
}

/// Returns the attributes of a store, equal on all machines of one arithmetic class.
pub(super) fn attributes(about: &MapDescription<'_>, scene: &SceneData) -> Map<String, Value> {
    let required = [
        ("whiskmap_version", json!(env!("CARGO_PKG_VERSION"))),
        ("engine", json!(about.engine.engine)),
        ("arithmetic", json!(about.arithmetic)),
        ("tolerances", json!(about.tolerances)),
        ("channels", json!(about.channels.to_string())),
        ("scene", json!(scene.text.to_string())),
    ];
    let digits = digits(about).map(|digits| (DIGITS, json!(digits)));
    let all = required.into_iter().chain(digits);
    let agreed = all.map(|(name, value)| (name.to_owned(), value));
    completed(&Map::from_iter(agreed), &scene.title)
}

/// Returns the attributes of a store: the attributes of `found` in [`AGREED`], the `title`, and the attributes that follow from these.
pub(super) fn completed(found: &Map<String, Value>, title: &str) -> Map<String, Value> {
    let agreed = AGREED.iter().filter_map(|name| {
        let value = found.get(*name)?;
        Some(((*name).to_owned(), value.clone()))
    });
    let mut attributes: Map<String, Value> = agreed.collect();
    let identity = StoreIdentity::of(&attributes).text();
    // Version 1.12 defines the attributes of rounded arrays.
    let is_rounded = attributes.contains_key(DIGITS);
    let conventions = if is_rounded { "CF-1.12" } else { "CF-1.11" };
    attributes.insert("Conventions".to_owned(), json!(conventions));
    attributes.insert("title".to_owned(), json!(title));
    attributes.insert(IDENTITY.to_owned(), json!(identity));
    attributes
}

/// Returns the metadata of the store's root, with the metadata of all arrays.
pub(super) fn group<'a>(
    attributes: &Map<String, Value>,
    arrays: impl Iterator<Item = &'a ZarrArray>,
) -> Value {
    let arrays = arrays.map(|array| (array.name.clone(), array.metadata.clone()));
    json!({
        "zarr_format": 3,
        "node_type": "group",
        "attributes": attributes,
        "consolidated_metadata": {
            "kind": "inline",
            "must_understand": false,
            "metadata": arrays.collect::<Map<_, _>>(),
        },
    })
}
