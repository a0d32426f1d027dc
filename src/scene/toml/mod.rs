//! TOML files of scenes: reading, writing and editing of the text.

mod pairs;
mod read;
mod tables;
mod whiskers;
mod write;

pub(in crate::scene) use tables::SceneFile;
pub(in crate::scene) use whiskers::YIELD_STRAIN;
pub use write::SceneText;

use crate::input::{each_once, shortened};
use crate::scene::grid::SweepVariable;
use crate::scene::parameter::Parameter;
use crate::scene::{profile, shape, smooth};
use std::ops::Range;
use toml_edit::{Document, Item};

/// Key of the taper, which a scene file may give instead of the radius at the tip.
pub(in crate::scene) const TAPER_KEY: &str = "whisker.taper";

/// Key of the yield strain, which marks states and changes none.
pub(in crate::scene) const YIELD_KEY: &str = "whisker.yield_strain";

/// Keys of a scene file that belong to no parameter and to no sweep axis.
const OTHER_KEYS: [&str; 18] = [
    TAPER_KEY,
    YIELD_KEY,
    profile::KEY,
    smooth::SMOOTH_KEY,
    shape::POINTS_KEY,
    shape::DEGREE_KEY,
    shape::CURVATURE_KEY,
    "grid.push_angle_deg",
    "grid.distance_mm",
    SweepVariable::TABLE,
    "output.name",
    "uncertainty.profile_radius_um",
    "surface.distance_mm",
    "surface.spacing_um",
    "surface.asperity_radius_um",
    "surface.length_mm",
    "surface.jitter",
    "surface.seed",
];

/// Returns the places in a scene file of a `name`: keys that end with it or belong to the parameter of this name, and tables, in brackets.
/// Empty without such a place.
fn places_of(name: &str) -> Vec<String> {
    let parameters = Parameter::ALL.into_iter().filter(|one| *one != Parameter::Taper);
    let axes = Parameter::SWEPT.into_iter().map(Parameter::axis_key);
    let keys = parameters.clone().map(Parameter::key).chain(OTHER_KEYS).chain(axes);
    let place = |key: &str| {
        let parts: Vec<&str> = key.split('.').collect();
        let found = parts.iter().position(|part| *part == name)?;
        let is_table = found + 1 < parts.len();
        Some(if is_table { format!("[{}]", parts[..=found].join(".")) } else { key.to_owned() })
    };
    let mut named = parameters.filter(|parameter| parameter.name() == name);
    let named = named.next().map(|parameter| parameter.key().to_owned());
    let places: Vec<String> = named.into_iter().chain(keys.filter_map(place)).collect();
    each_once(&places)
}

/// Returns the place of the value of `key` in the text of a scene, such as `grid.distance_mm[1]` or `grid.friction.from`.
fn place_in(text: &str, key: &str) -> Option<Range<usize>> {
    place(Document::parse(text).ok()?.as_item(), key)
}

fn place(item: &Item, key: &str) -> Option<Range<usize>> {
    if key.is_empty() {
        return item.span();
    }
    if let Some((index, rest)) = key.strip_prefix('[').and_then(|key| key.split_once(']')) {
        let value = item.as_array()?.get(index.parse().ok()?)?;
        return value.span().filter(|_| rest.is_empty());
    }
    let key = key.strip_prefix('.').unwrap_or(key);
    item.as_table_like()?.iter().find_map(|(name, inner)| {
        let rest = key.strip_prefix(&*shortened(name))?;
        let is_whole = rest.is_empty() || rest.starts_with(['.', '[']);
        is_whole.then(|| place(inner, rest))?
    })
}
