//! Saving pictures, with a word about what their pixels lack.

use super::failure::{Failure, say};
use std::path::Path;
use whiskmap::render::{Format, Picture};

/// Saves a picture, and says so where its pixels lack characters.
pub fn save(picture: &Picture, path: &Path, format: Format) -> Result<(), Failure> {
    if format == Format::Png {
        warn_of_boxes(picture);
    }
    Ok(picture.save(path, format)?)
}

/// Names the characters of a picture that its pixels show as boxes.
pub fn warn_of_boxes(picture: &Picture) {
    let missing: String = picture.missing_glyphs().into_iter().collect();
    if !missing.is_empty() {
        say(&format!(
            "warning: the built-in font lacks \u{201c}{missing}\u{201d}: the PNG shows boxes; an SVG has the text itself"
        ));
    }
}
