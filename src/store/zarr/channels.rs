//! Channels of a store: kind, unit and meaning, and flags of codes, by the CF conventions.

use super::array::about;
use super::encoding::ValueKind::{self, Code, Count, Quantity};
use crate::classify::{Regime, Status};
use crate::plan::channels::CHANNELS;
use crate::scene::Parameter;
use crate::store::NOT_COMPUTED;
use serde_json::{Value, json};

/// Returns the attributes of a channel of maps, by the CF conventions: unit, meaning, and flags of codes; `None` for another name.
#[must_use]
pub fn channel_attributes(name: &str) -> Option<Value> {
    channel(name).map(|(_, about)| about)
}

/// Returns kind and attributes of a channel; `None` for another name.
pub(super) fn channel(name: &str) -> Option<(ValueKind, Value)> {
    if let Some((_, units, meaning, _)) = CHANNELS.iter().find(|(known, ..)| *known == name) {
        let kind = match (name, units) {
            (_, Some(_)) => Quantity,
            ("newton_steps", None) => Count,
            _ => Code,
        };
        return Some((kind, with_flags(name, about(*units, meaning))));
    }
    let mut all = Parameter::ALL.into_iter();
    let parameter = all.find(|parameter| parameter.push_derivative() == name)?;
    let units = match parameter.unit() {
        "1" => "degree".to_owned(),
        unit => format!("degree/({unit})"),
    };
    let meaning = format!("derivative of detachment angle by {}", parameter.name());
    Some((Quantity, about(Some(&units), &meaning)))
}

/// Returns the attributes of a channel with its flags, if its values are codes.
pub(super) fn with_flags(name: &str, mut about: Value) -> Value {
    let mut flags = |codes: Vec<u32>, names: Vec<&str>| {
        let names = names.iter().map(|name| word(name));
        let names = names.chain(["not_computed".to_owned()]).collect::<Vec<_>>();
        let codes = codes.into_iter().chain([u32::from(NOT_COMPUTED)]);
        about["flag_values"] = json!(codes.collect::<Vec<_>>());
        about["flag_meanings"] = json!(names.join(" "));
    };
    match name {
        "regime" => {
            flags(Regime::ALL.map(Regime::code).to_vec(), Regime::ALL.map(Regime::name).to_vec())
        }
        "status" => {
            flags(Status::ALL.map(Status::code).to_vec(), Status::ALL.map(Status::name).to_vec())
        }
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
