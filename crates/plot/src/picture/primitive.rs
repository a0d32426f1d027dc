//! Drawn elements of a picture as plain data.

use super::palette::Rgb;

/// Lengths `[dash, gap]` of dashed lines, in pixels along the middle of the line. The round ends of a dash cover one line width of each gap.
pub const DASHES: [f64; 2] = [14.0, 10.0];

/// A rectangle of the picture, in the picture's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Area {
    pub const fn new([left, top]: [f64; 2], [width, height]: [f64; 2]) -> Self {
        Self { left, top, width, height }
    }

    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Returns the point `[x, y]` of the rectangle at the fraction `x` from its left and the fraction `y` from its bottom.
    pub fn point(&self, x: f64, y: f64) -> [f64; 2] {
        [self.left + x * self.width, self.bottom() - y * self.height]
    }
}

/// The pen of a line: colour, width in pixels, and dashes. Ends and corners are round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    pub width: f64,
    pub colour: Rgb,
    /// True if the pen draws [`DASHES`]; a line begins with a whole dash.
    pub dashed: bool,
}

impl Pen {
    pub const fn solid(width: f64, colour: Rgb) -> Self {
        Self { width, colour, dashed: false }
    }
}

/// The position of a text relative to its point. Capital letters are centred on the point across the line of writing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Anchor {
    Left,
    Centre,
    Right,
    /// The text runs upwards, with its middle at the point.
    Upwards,
}

/// A drawn element of a picture. Coordinates and sizes, except those of rasters, are in the picture's units.
#[derive(Clone, Debug, PartialEq)]
pub enum Primitive {
    /// A line through points `[x, y]`, and its pen.
    Polyline(Vec<[f64; 2]>, Pen),
    /// A filled polygon with corners `[x, y]`, and its colour.
    Polygon(Vec<[f64; 2]>, Rgb),
    /// A filled circle: centre `[x, y]`, radius and colour, and the pen of its outline; `None` without an outline.
    Circle([f64; 2], f64, Rgb, Option<Pen>),
    /// A text of one line: its point `[x, y]`, its font size, and its anchor.
    Text(String, [f64; 2], f64, Anchor),
    /// A raster of pixels: upper left corner and size in pixels, all inside the picture, and their colours row by row.
    Raster([usize; 2], [usize; 2], Vec<Rgb>),
}
