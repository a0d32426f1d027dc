//! A picture as plain data: marks in the order in which they are drawn.

use super::font::{self, Fitted};
use super::palette::{Fill, INK, Rgb};

/// Lengths of a dash and of a gap, in pixels along the middle of the line. Round ends take a line's width from the gap
/// to the dash. The first dash of a line that begins at a dot is seen.
pub(super) const DASHES: [f64; 2] = [14.0, 10.0];

/// A rectangle of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    pub(super) const fn new([left, top]: [f64; 2], [width, height]: [f64; 2]) -> Self {
        Self {
            left,
            top,
            width,
            height,
        }
    }

    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The point at fractions `x` from the left and `y` from the bottom.
    pub(super) fn point(&self, x: f64, y: f64) -> [f64; 2] {
        [self.left + x * self.width, self.bottom() - y * self.height]
    }
}

/// What a line is drawn with; its ends and corners are round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pen {
    pub(super) width: f64,
    pub(super) colour: Rgb,
    /// With the [`DASHES`], beginning with a whole dash.
    pub(super) dashed: bool,
}

impl Pen {
    /// A pen without gaps.
    pub(super) const fn solid(width: f64, colour: Rgb) -> Self {
        Self {
            width,
            colour,
            dashed: false,
        }
    }
}

/// Where a text stands relative to its point; its capitals are centred on the point across the line of writing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Anchor {
    Left,
    Centre,
    Right,
    /// Centred, running upwards.
    Upwards,
}

/// Something drawn. All but rasters is in the picture's own units.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    /// A line through points.
    Polyline(Vec<[f64; 2]>, Pen),
    /// Corners and fill of an area.
    Polygon(Vec<[f64; 2]>, Rgb),
    /// Centre, radius and fill of a circle, under an outline about its edge.
    Circle([f64; 2], f64, Rgb, Option<Pen>),
    /// A line of text, its point and its size.
    Text(String, [f64; 2], f64, Anchor),
    /// Upper left corner and size in pixels, all of them inside the picture, and their colours row by row.
    Raster([usize; 2], [usize; 2], Vec<Rgb>),
}

/// A picture that has been laid out, to be saved in any format.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in units: pixels of a picture in its natural size.
    pub(super) size: [f64; 2],
    /// Pixels per unit.
    pub(super) scale: f64,
    pub(super) marks: Vec<Mark>,
}

impl Picture {
    /// An empty white picture of a natural size, enlarged to `width` pixels.
    pub(super) fn new(size: [f64; 2], width: Option<u32>) -> Self {
        let size = size.map(f64::ceil);
        Self {
            size,
            scale: width.map_or(1.0, |width| f64::from(width) / size[0]),
            marks: Vec::new(),
        }
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn pixels(&self) -> [usize; 2] {
        self.size
            .map(|length| (length * self.scale).round().max(1.0) as usize)
    }

    /// The characters of its texts that its pixels show as boxes; an SVG document has them.
    #[must_use]
    pub fn missing_glyphs(&self) -> Vec<char> {
        let texts = self.marks.iter().filter_map(|mark| match mark {
            Mark::Text(text, ..) => Some(text.as_str()),
            _ => None,
        });
        font::missing_glyphs(&texts.collect::<String>())
    }

    pub(super) fn polyline(&mut self, points: &[[f64; 2]], pen: Pen) {
        self.marks.push(Mark::Polyline(points.to_vec(), pen));
    }

    /// The outline of an area.
    pub(super) fn frame(&mut self, area: Area, width: f64) {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
        let corners = corners.map(|(x, y)| area.point(x, y));
        self.polyline(&corners, Pen::solid(width, INK));
    }

    /// An area; one of fewer than three corners is nothing.
    pub(super) fn polygon(&mut self, corners: Vec<[f64; 2]>, fill: Rgb) {
        if corners.len() > 2 {
            self.marks.push(Mark::Polygon(corners, fill));
        }
    }

    pub(super) fn circle(&mut self, at: [f64; 2], radius: f64, fill: Rgb, outline: Option<Pen>) {
        self.marks.push(Mark::Circle(at, radius, fill, outline));
    }

    /// A line of text, in which control characters are blanks; an empty one is nothing.
    pub(super) fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: Anchor) {
        if !text.is_empty() {
            let text = text.replace(char::is_control, " ");
            self.marks.push(Mark::Text(text, at, size, anchor));
        }
    }

    /// A text in the size in which it fits.
    pub(super) fn fitted(&mut self, (text, size): &Fitted, at: [f64; 2], anchor: Anchor) {
        self.text(text, at, *size, anchor);
    }

    /// Fills an area; `fill` is asked for each pixel, by its fractions from the left and the bottom.
    pub(super) fn raster(&mut self, area: Area, fill: impl Fn(f64, f64) -> Fill) {
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
        self.marks.push(Mark::Raster(corner, size, pixels));
    }
}
