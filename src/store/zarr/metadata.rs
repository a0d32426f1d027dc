//! The arrays and attributes of a store.

use super::array::{NOT_COMPUTED, ValueKind, ZarrArray, about};
use super::blocks::Blocks;
use super::identity::{AGREED, StoreIdentity};
use crate::classify::{Regime, Status};
use crate::scene::{Grid, SceneData};
use crate::store::{Channels, MapDescription};
use serde_json::{Map, Value, json};

/// Array with the number of cells of each regime: `[sweep axes.., regime]`.
pub(super) const CELLS: &str = "regime_cells";

/// Coordinate with the codes of the regimes, the last axis of [`CELLS`].
const CODES: &str = "regime_code";

/// Name, unit and meaning of every channel.
const MEANINGS: [(&str, Option<&str>, &str); 14] = [
    ("regime", None, "what becomes of the whisker"),
    ("status", None, "how that was settled"),
    (
        "arc_length_mm",
        Some("mm"),
        "arclength from the base to the contact",
    ),
    (
        "contact_angle_deg",
        Some("degree"),
        "angle of the whisker at the contact",
    ),
    (
        "force_un",
        Some("uN"),
        "force between pole and whisker, normal to both",
    ),
    (
        "base_force_x_un",
        Some("uN"),
        "force that the pole puts on the base, along its tangent",
    ),
    (
        "base_force_y_un",
        Some("uN"),
        "force that the pole puts on the base, across its tangent",
    ),
    (
        "base_moment_nnm",
        Some("nN m"),
        "moment that the pole puts on the base",
    ),
    (
        "push_chord_deg",
        Some("degree"),
        "angle at the base between the contact and the resting whisker as far away",
    ),
    (
        "contact_distance_mm",
        Some("mm"),
        "straight distance from the base to the contact",
    ),
    ("energy_nj", Some("nJ"), "energy of bending"),
    (
        "margin_deg",
        Some("degree"),
        "push angle left until detachment",
    ),
    ("newton_steps", None, "Newton steps"),
    (
        "residual",
        Some("1"),
        "distance from the wanted pole over the whisker's length",
    ),
];

/// The arrays that are filled block by block. The regimes, which mark a block as finished, are the last.
pub(super) fn arrays(grid: &Grid, blocks: &Blocks, channels: Channels) -> Vec<ZarrArray> {
    let sweep = grid.sweep.iter().map(|axis| axis.parameter.axis());
    let sweep: Vec<&str> = sweep.collect();
    let of_cells = [&sweep[..], &["distance_mm", "push_angle_deg"]].concat();
    let of_regimes = [&sweep[..], &[CODES]].concat();
    let mut arrays = vec![ZarrArray::of_whiskers(
        CELLS,
        ValueKind::Count,
        blocks,
        Regime::ALL.len(),
        &of_regimes,
        Value::Object(about(None, "cells of each regime")),
    )];
    let mut names: Vec<&str> = channels.names().filter(|name| *name != "regime").collect();
    names.push("regime");
    for name in names {
        let kind = match name {
            "regime" | "status" => ValueKind::Code,
            "newton_steps" => ValueKind::Count,
            _ => ValueKind::Quantity,
        };
        let about = Value::Object(of_channel(name));
        arrays.push(ZarrArray::of_cells(name, kind, blocks, &of_cells, about));
    }
    arrays
}

/// The attributes of a channel; codes are flags of the CF conventions.
fn of_channel(name: &str) -> Map<String, Value> {
    let meaning = MEANINGS.iter().find(|(own, ..)| *own == name);
    let (_, units, long_name) = *meaning.unwrap_or(&("", None, ""));
    let mut about = about(units, long_name);
    let mut flags = |codes: Vec<u32>, names: Vec<&str>| {
        let names = names.iter().map(|name| word(name));
        let names = names.chain(["not_computed".to_owned()]).collect::<Vec<_>>();
        let codes = codes.into_iter().chain([u32::from(NOT_COMPUTED)]);
        about.insert("flag_values".to_owned(), json!(codes.collect::<Vec<_>>()));
        about.insert("flag_meanings".to_owned(), json!(names.join(" ")));
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

/// The coordinates along every axis, with their values as bytes.
pub(super) fn coordinates(grid: &Grid) -> Vec<(ZarrArray, Vec<u8>)> {
    let inside = [
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
        (parameter.axis(), parameter.unit(), title, &axis.values)
    });
    let mut all = Vec::new();
    for (name, units, title, values) in sweep.chain(inside) {
        let about = Value::Object(about(Some(units), title));
        let array = ZarrArray::of_axis(name, ValueKind::Coordinate, values.len(), about);
        all.push((array, bytemuck::cast_slice(values).to_vec()));
    }
    let codes = Regime::ALL.map(|regime| regime.code() as u8).to_vec();
    let about = Value::Object(of_channel("regime"));
    all.push((
        ZarrArray::of_axis(CODES, ValueKind::Code, codes.len(), about),
        codes,
    ));
    all
}

/// The attributes of a store, equal on all machines of one arithmetic class.
pub(super) fn attributes(about: &MapDescription<'_>, scene: &SceneData) -> Map<String, Value> {
    let agreed = [
        ("whiskmap_version", json!(env!("CARGO_PKG_VERSION"))),
        ("engine", json!(about.engine.engine)),
        ("arithmetic", json!(about.arithmetic)),
        ("tolerances", json!(about.tolerances)),
        ("channels", json!(about.channels.to_string())),
        ("scene", json!(scene.text.to_string())),
    ];
    let agreed = agreed.map(|(name, value)| (name.to_owned(), value));
    completed(&Map::from_iter(agreed), &scene.title)
}

/// The attributes of a store: those of `found` in [`AGREED`], the `title`, and those that follow.
pub(super) fn completed(found: &Map<String, Value>, title: &str) -> Map<String, Value> {
    let agreed = AGREED.iter().filter_map(|name| {
        let value = found.get(*name)?;
        Some(((*name).to_owned(), value.clone()))
    });
    let mut attributes: Map<String, Value> = agreed.collect();
    let identity = StoreIdentity::of(&attributes).text();
    attributes.insert("Conventions".to_owned(), json!("CF-1.11"));
    attributes.insert("title".to_owned(), json!(title));
    attributes.insert(IDENTITY.to_owned(), json!(identity));
    attributes
}

/// Attribute with the identity of the store.
pub(super) const IDENTITY: &str = "identity";

/// The root's metadata, with those of all arrays.
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
