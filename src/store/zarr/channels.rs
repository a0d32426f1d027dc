//! Channels of a store: kind, unit and meaning, and flags of codes, by the CF conventions.

use super::array::about;
use super::encoding::ValueKind::{self, Code, Count, Quantity};
use crate::classify::{Regime, Status};
use crate::scene::Parameter;
use crate::store::NOT_COMPUTED;
use serde_json::{Value, json};

/// Name, kind, unit and meaning of a channel.
type ChannelLine = (&'static str, ValueKind, Option<&'static str>, &'static str);

/// Name, kind, unit and meaning of every channel but the derivatives.
#[rustfmt::skip]
pub(super) const CHANNELS: [ChannelLine; 15] = [
    ("regime", Code, None, "what happens to the whisker"),
    ("status", Code, None, "how the regime was found"),
    ("arc_length_mm", Quantity, Some("mm"), "arclength from base to contact"),
    ("contact_angle_deg", Quantity, Some("degree"), "angle of tangent at contact"),
    ("force_un", Quantity, Some("uN"), "normal part of the contact force"),
    ("base_force_x_un", Quantity, Some("uN"), "force on base along its tangent"),
    ("base_force_y_un", Quantity, Some("uN"), "force on base across its tangent"),
    ("base_moment_nnm", Quantity, Some("nN m"), "moment of pole on the base"),
    ("push_chord_deg", Quantity, Some("degree"), "chord angle between contact and rest"),
    ("contact_distance_mm", Quantity, Some("mm"), "straight distance from base to contact"),
    ("energy_nj", Quantity, Some("nJ"), "energy of bending"),
    ("margin_deg", Quantity, Some("degree"), "push angle left until detachment"),
    ("newton_steps", Count, None, "Newton steps"),
    ("residual", Quantity, Some("1"), "distance from pole over whisker length"),
    ("peak_strain", Quantity, Some("1"), "largest bending strain at the surface"),
];

/// Returns the attributes of a channel of maps, by the CF conventions: unit, meaning, and flags of codes; `None` for another name.
#[must_use]
pub fn channel_attributes(name: &str) -> Option<Value> {
    channel(name).map(|(_, about)| about)
}

/// Returns kind and attributes of a channel; `None` for another name.
pub(super) fn channel(name: &str) -> Option<(ValueKind, Value)> {
    if let Some((_, kind, units, meaning)) = CHANNELS.iter().find(|(own, ..)| *own == name) {
        return Some((*kind, with_flags(name, about(*units, meaning))));
    }
    let mut all = Parameter::ALL.into_iter();
    let parameter = all.find(|own| own.push_derivative() == name)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::channel_names;
    use crate::store::Channels;

    /// A channel that is missing here would be missing in every store.
    #[test]
    fn every_channel_of_a_map_has_a_line() {
        let names = CHANNELS.iter().map(|(name, ..)| *name);
        assert!(names.eq(Channels::STANDARD.with("peak_strain").names()));
        assert!(channel_names().all(|name| channel(name).is_some()));
    }
}
