//! TOML files of scenes: reading, writing and editing of the text.

mod pairs;
mod read;
mod tables;
mod whiskers;
mod write;

pub(in crate::scene) use tables::SceneFile;
pub(in crate::scene) use whiskers::YIELD_STRAIN;
pub use write::SceneText;

use crate::input::shortened;
use std::ops::Range;
use toml_edit::{Document, Item};

/// Key of the taper, which a scene file may give instead of the radius at the tip.
pub(in crate::scene) const TAPER_KEY: &str = "whisker.taper";

/// Key of the yield strain, which marks states and changes none.
pub(in crate::scene) const YIELD_KEY: &str = "whisker.yield_strain";

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
