//! What a picture is saved as.

use super::error::Error;
use super::picture::Picture;
use super::{bitmap, svg};
use std::path::Path;

/// The format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Pixels.
    Png,
    /// SVG 1.1: lines and text as such, the cells of maps as pixels.
    Svg,
}

impl Format {
    /// The format that the ending of a file's name stands for, in capitals or not.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "png" => Some(Self::Png),
            "svg" => Some(Self::Svg),
            _ => None,
        }
    }
}

impl Picture {
    /// The picture in a format; equal pictures give equal bytes.
    ///
    /// # Errors
    ///
    /// The encoder refuses the pixels.
    pub fn encode(&self, format: Format) -> Result<Vec<u8>, Error> {
        Ok(match format {
            Format::Png => bitmap::file(self)?,
            Format::Svg => svg::document(self)?.into_bytes(),
        })
    }
}
