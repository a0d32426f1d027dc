//! Arrays and attributes of a store.

use super::array::{ZarrArray, about};
use super::blocks::Blocks;
use super::encoding::ChunkEncoding;
use super::encoding::ValueKind::{self, Code, Coordinate, Count, Quantity};
use super::identity::{AGREED, StoreIdentity};
use crate::classify::{Regime, Status};
use crate::plan::{Digits, STATE_CHANNELS};
use crate::scene::{Grid, Parameter, SceneData};
use crate::store::attributes::{DIGITS, digits};
use crate::store::{Channels, MapDescription, NOT_COMPUTED};
use serde_json::{Map, Value, json};

/// Name, kind, unit and meaning of a channel.
type ChannelLine = (&'static str, ValueKind, Option<&'static str>, &'static str);

/// Name of the array with the number of cells of each regime: `[sweep axes.., regime]`.
pub(super) const CELLS: &str = "regime_cells";

/// Coordinate with the codes of the regimes, the last axis of [`CELLS`].
const CODES: &str = "regime_code";

/// Name, kind, unit and meaning of every channel but the derivatives.
#[rustfmt::skip]
const CHANNELS: [ChannelLine; 14] = [
    ("regime", Code, None, "what becomes of the whisker"),
    ("status", Code, None, "how that was settled"),
    ("arc_length_mm", Quantity, Some("mm"), "arclength from the base to the contact"),
    ("contact_angle_deg", Quantity, Some("degree"), "angle of the whisker at the contact"),
    ("force_un", Quantity, Some("uN"), "force between pole and whisker, normal to both"),
    ("base_force_x_un", Quantity, Some("uN"), "force that the pole puts on the base, along its tangent"),
    ("base_force_y_un", Quantity, Some("uN"), "force that the pole puts on the base, across its tangent"),
    ("base_moment_nnm", Quantity, Some("nN m"), "moment that the pole puts on the base"),
    ("push_chord_deg", Quantity, Some("degree"), "angle at the base between the contact and the resting whisker as far away"),
    ("contact_distance_mm", Quantity, Some("mm"), "straight distance from the base to the contact"),
    ("energy_nj", Quantity, Some("nJ"), "energy of bending"),
    ("margin_deg", Quantity, Some("degree"), "push angle left until detachment"),
    ("newton_steps", Count, None, "Newton steps"),
    ("residual", Quantity, Some("1"), "distance from the wanted pole over the whisker's length"),
];

/// The arrays that are filled block by block. The regimes, which mark a block as finished, are the last.
pub(super) fn arrays(
    grid: &Grid,
    blocks: &Blocks,
    (channels, digits): (Channels, Digits),
) -> Vec<ZarrArray> {
    let sweep = grid.sweep.iter().map(|axis| axis.parameter.axis());
    let sweep: Vec<&str> = sweep.collect();
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
        let is_turned = STATE_CHANNELS.contains(&name) || name == "residual";
        let kept_bits = digits.mantissa_bits(name);
        let encoding = ChunkEncoding {
            width: is_turned.then_some(push_angles),
            kept_bits,
        };
        let sizes = (&sizes[..], encoding);
        if let Some(bits) = kept_bits {
            about["quantization"] = json!(QUANTIZATION);
            about["quantization_nsb"] = json!(bits);
        }
        arrays.push(ZarrArray::in_blocks(
            name, kind, blocks, sizes, &of_cells, about,
        ));
    }
    arrays
}

/// The attributes of a channel; codes are flags of the CF conventions.
fn with_flags(name: &str, mut about: Value) -> Value {
    let mut flags = |codes: Vec<u32>, names: Vec<&str>| {
        let names = names.iter().map(|name| word(name));
        let names = names.chain(["not_computed".to_owned()]).collect::<Vec<_>>();
        let codes = codes.into_iter().chain([u32::from(NOT_COMPUTED)]);
        about["flag_values"] = json!(codes.collect::<Vec<_>>());
        about["flag_meanings"] = json!(names.join(" "));
    };
    match name {
        "regime" => flags(
            Regime::ALL.map(Regime::code).to_vec(),
            Regime::ALL.map(Regime::name).to_vec(),
        ),
        "status" => flags(
            Status::ALL.map(Status::code).to_vec(),
            Status::ALL.map(Status::name).to_vec(),
        ),
        _ => {}
    }
    about
}

/// A name as one word.
fn word(name: &str) -> String {
    let parts = name.split(|c: char| !c.is_ascii_alphanumeric());
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    parts.join("_")
}

/// Array without axes whose attributes describe the rounding (CF conventions, 8.4).
const QUANTIZATION: &str = "quantization";

/// Returns the attributes of a channel of maps, by the CF conventions: unit, meaning, and flags of codes; `None` for another name.
#[must_use]
pub fn channel_attributes(name: &str) -> Option<Value> {
    channel(name).map(|(_, about)| about)
}

/// Returns kind and attributes of a channel; `None` for another name.
fn channel(name: &str) -> Option<(ValueKind, Value)> {
    if let Some((_, kind, units, meaning)) = CHANNELS.iter().find(|(own, ..)| *own == name) {
        return Some((*kind, with_flags(name, about(*units, meaning))));
    }
    let mut all = Parameter::ALL.into_iter();
    let parameter = all.find(|own| own.push_derivative() == name)?;
    let units = match parameter.unit() {
        "1" => "degree".to_owned(),
        unit => format!("degree/({unit})"),
    };
    let meaning = format!(
        "derivative of the push angle at detachment by {}",
        parameter.name()
    );
    Some((Quantity, about(Some(&units), &meaning)))
}

/// Coordinate of maps: values along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisCoordinate<'a> {
    /// Name of the coordinate and of its dimension.
    pub name: &'static str,
    /// Attributes of the coordinate by the CF conventions: unit and meaning.
    pub attributes: Value,
    /// Values of the coordinate in its unit, `[value]`.
    pub values: &'a [f64],
}

/// Returns the coordinates of a grid in the order of the dimensions of channels, `[axis]`: sweep axes, distances and push angles.
#[must_use]
pub fn coordinates(grid: &Grid) -> Vec<AxisCoordinate<'_>> {
    let inside: [(_, _, _, &[f64]); 2] = [
        (
            "distance_mm",
            "mm",
            "distance at first touch",
            &grid.distance_mm,
        ),
        (
            "push_angle_deg",
            "degree",
            "push angle; CF < 0 < CB",
            &grid.push_angle_deg,
        ),
    ];
    let sweep = grid.sweep.iter().map(|axis| {
        let parameter = axis.parameter;
        let title = parameter.title();
        (parameter.axis(), parameter.unit(), title, &*axis.values)
    });
    let all = sweep.chain(inside);
    all.map(|(name, units, title, values)| AxisCoordinate {
        name,
        attributes: about(Some(units), title),
        values,
    })
    .collect()
}

/// The coordinates along every axis, and the description of the rounding if there is any, with their values as bytes.
pub(super) fn constants(grid: &Grid, digits: Digits) -> Vec<(ZarrArray, Vec<u8>)> {
    let mut all = Vec::new();
    for own in coordinates(grid) {
        let array = ZarrArray::of_axis(own.name, Coordinate, own.values.len(), own.attributes);
        all.push((array, bytemuck::cast_slice(own.values).to_vec()));
    }
    let codes = Regime::ALL.map(|regime| regime.code() as u8).to_vec();
    let (_, _, units, meaning) = CHANNELS[0];
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

/// Returns the attributes of a store, equal on all machines of one arithmetic class.
pub(super) fn attributes(about: &MapDescription<'_>, scene: &SceneData) -> Map<String, Value> {
    let agreed = [
        ("whiskmap_version", json!(env!("CARGO_PKG_VERSION"))),
        ("engine", json!(about.engine.engine)),
        ("arithmetic", json!(about.arithmetic)),
        ("tolerances", json!(about.tolerances)),
        ("channels", json!(about.channels.to_string())),
        ("scene", json!(scene.text.to_string())),
    ];
    let digits = digits(about).map(|digits| (DIGITS, json!(digits)));
    let agreed = agreed.into_iter().chain(digits);
    let agreed = agreed.map(|(name, value)| (name.to_owned(), value));
    completed(&Map::from_iter(agreed), &scene.title)
}

/// Returns the attributes of a store: those of `found` in [`AGREED`], the `title`, and those that follow.
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

/// Name of the attribute with the identity of the store.
pub(super) const IDENTITY: &str = "identity";

/// Returns the metadata of the store's root, with those of all arrays.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::channel_names;

    /// A channel that is missing here would be missing in every store.
    #[test]
    fn every_channel_of_a_map_has_a_line() {
        let names = CHANNELS.iter().map(|(name, ..)| *name);
        assert!(names.eq(Channels::STANDARD.names()));
        assert!(channel_names().all(|name| channel(name).is_some()));
    }
}
