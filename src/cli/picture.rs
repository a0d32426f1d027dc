//! Saving pictures, with a word about what their pixels lack.

use super::failure::{Failure, say};
use super::files::unwritten;
use std::io::Write;
use std::path::Path;
use whiskmap::render::{Format, Picture};
use whiskmap::store::{Output, TemporaryFiles};

/// Saves a picture, and says so where its pixels lack characters.
pub fn save(
    picture: &Picture,
    path: &Path,
    format: Format,
    temporary: &TemporaryFiles,
) -> Result<(), Failure> {
    if format == Format::Png {
        warn_of_boxes(picture);
    }
    let bytes = picture.encode(format)?;
    let output = Output::create(path, temporary);
    let written = output.and_then(|mut output| {
        output.write_all(&bytes)?;
        output.finish()
    });
    written.map_err(|cause| unwritten(path, cause))
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
