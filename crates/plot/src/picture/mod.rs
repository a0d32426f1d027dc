//! A picture as plain data: primitives in the order in which they are drawn. It becomes pixels, SVG or PDF when it is encoded.

mod bitmap;
mod coverage;
pub mod font;
pub mod palette;
mod pdf;
mod primitive;
pub mod size;
mod svg;
pub mod text;

pub use primitive::{Anchor, Area, DASHES, Pen, Primitive};

use palette::{Fill, INK, Rgb};
use size::PictureSize;
use std::path::Path;
use text::{FittedText, TextBlock};

/// The file format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PictureFormat {
    /// The PNG format, which stores a picture as pixels.
    Png,
    /// The SVG 1.1 format: lines and text as vectors, the cells of heat maps as pixels.
    Svg,
    /// The PDF 1.7 format: lines as vectors, text as outlines, the cells of heat maps as pixels.
    Pdf,
}

impl PictureFormat {
    /// Returns the format for the extension `png`, `svg` or `pdf` of a path, in upper or lower case; `None` for another extension.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match &*path.extension()?.to_str()?.to_ascii_lowercase() {
            "png" => Some(Self::Png),
            "svg" => Some(Self::Svg),
            "pdf" => Some(Self::Pdf),
            _ => None,
        }
    }
}

/// The error of a picture whose pixels cannot be encoded as PNG.
#[derive(Debug, thiserror::Error)]
#[error("cannot encode the picture as PNG: {0}")]
pub struct EncodeError(#[from] png::EncodingError);

/// A picture that has been laid out and can be encoded in any format.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in units: pixels of a picture in its natural size.
    size: [f64; 2],
    /// Pixels per unit.
    scale: f64,
    /// True if the picture has a size on paper.
    is_print: bool,
    primitives: Vec<Primitive>,
}

impl Picture {
    /// Creates an empty white picture of `units`, `[width, height]`. They are those of `size` if it is one on paper.
    pub(crate) fn new(units: [f64; 2], size: PictureSize) -> Self {
        let natural = units.map(f64::ceil);
        let (size, scale, is_print) = match size {
            PictureSize::Natural => (natural, 1.0, false),
            PictureSize::Width(pixels) => (natural, f64::from(pixels) / natural[0], false),
            PictureSize::Print(print) => (units, print.scale(), true),
        };
        Self { size, scale, is_print, primitives: Vec::new() }
    }

    /// Returns the bytes of the picture as a file; equal pictures give equal bytes.
    ///
    /// # Errors
    /// The PNG encoder refuses the pixels.
    pub fn encode(&self, format: PictureFormat) -> Result<Vec<u8>, EncodeError> {
        Ok(match format {
            PictureFormat::Png => bitmap::file(self)?,
            PictureFormat::Svg => svg::document(self)?.into_bytes(),
            PictureFormat::Pdf => pdf::document(self),
        })
    }

    /// Returns the size of the picture in pixels: `[width, height]`.
    #[must_use]
    pub fn pixels(&self) -> [usize; 2] {
        self.size.map(|length| (length * self.scale).round().max(1.0) as usize)
    }

    /// Returns the characters of the picture's texts that the built-in font lacks, each once. A PNG or PDF shows them as boxes; an SVG
    /// has them as text.
    #[must_use]
    pub fn missing_glyphs(&self) -> Vec<char> {
        let texts = self.primitives.iter().filter_map(|primitive| match primitive {
            Primitive::Text(text, ..) => Some(text.as_str()),
            _ => None,
        });
        font::missing_glyphs(&texts.collect::<String>())
    }

    pub(crate) fn polyline(&mut self, points: &[[f64; 2]], pen: Pen) {
        let line = Primitive::Polyline(points.to_vec(), pen);
        self.primitives.push(line);
    }

    /// Draws the outline of a rectangle, `width` pixels wide.
    pub(crate) fn frame(&mut self, area: Area, width: f64) {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]
            .map(|(x, y)| area.point(x, y));
        self.polyline(&corners, Pen::solid(width, INK));
    }

    /// Fills a polygon with corners `[x, y]`; fewer than three corners draw nothing.
    pub(crate) fn polygon(&mut self, corners: Vec<[f64; 2]>, fill: Rgb) {
        if corners.len() > 2 {
            self.primitives.push(Primitive::Polygon(corners, fill));
        }
    }

    pub(crate) fn circle(&mut self, at: [f64; 2], radius: f64, fill: Rgb, outline: Option<Pen>) {
        let circle = Primitive::Circle(at, radius, fill, outline);
        self.primitives.push(circle);
    }

    /// Draws a line of text with blanks for control characters; an empty text draws nothing.
    pub(crate) fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: Anchor) {
        if !text.is_empty() {
            let text = text.replace(char::is_control, " ");
            self.primitives.push(Primitive::Text(text, at, size, anchor));
        }
    }

    pub(crate) fn fitted(&mut self, (text, size): &FittedText, at: [f64; 2], anchor: Anchor) {
        self.text(text, at, *size, anchor);
    }

    /// Draws the lines of a text, the first one at a point and the others below it, or to its right if the text runs upwards.
    pub(crate) fn block(&mut self, block: &TextBlock, [x, y]: [f64; 2], anchor: Anchor) {
        for (index, line) in block.lines.iter().enumerate() {
            let step = block.leading() * index as f64;
            let at = match anchor {
                Anchor::Upwards => [x + step, y],
                _ => [x, y + step],
            };
            self.text(line, at, block.size, anchor);
        }
    }

    /// Fills a rectangle pixel by pixel; `fill` gets the pixel's fractions from the left and from the bottom.
    pub(crate) fn raster(&mut self, area: Area, fill: impl Fn(f64, f64) -> Fill) {
        let ends = [[area.left, area.right()], [area.top, area.bottom()]];
        let limits = self.pixels();
        let [across, down] = [0, 1].map(|axis| {
            let [first, end] = ends[axis].map(|at| (at * self.scale).round().max(0.0) as usize);
            let first = first.min(limits[axis] - 1);
            first..end.clamp(first + 1, limits[axis])
        });
        let size = [across.len(), down.len()];
        let mut pixels = Vec::with_capacity(size[0] * size[1]);
        for y in down.clone() {
            let up = (down.end - y) as f64 - 0.5;
            for x in across.clone() {
                let right = (x - across.start) as f64 + 0.5;
                let fill = fill(right / size[0] as f64, up / size[1] as f64);
                pixels.push(fill.at((x + y) as f64 / self.scale));
            }
        }
        let corner = [across.start, down.start];
        self.primitives.push(Primitive::Raster(corner, size, pixels));
    }
}
