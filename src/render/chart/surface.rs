//! What charts are drawn on.

use super::dashes;
use crate::render::Error;
use crate::render::canvas::{Anchor, Canvas};
use crate::render::palette::Rgb;

/// Lengths of a dash and of a gap, in pixels along the middle of the line. Round ends take a line's width from the gap
/// to the dash. The first dash of a line that begins at a dot is seen.
pub(super) const DASHES: [f64; 2] = [14.0, 10.0];

/// What a line is drawn with; its ends and corners are round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pen {
    /// In pixels.
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

/// A picture in pixels from the upper left.
pub(super) trait Surface {
    /// A line through at least two points.
    fn polyline(&mut self, points: &[[f64; 2]], pen: Pen);

    /// A filled circle, under an outline of the pen's width about its edge.
    fn circle(&mut self, centre: [f64; 2], radius: f64, fill: Rgb, outline: Option<Pen>);

    /// A text as [`Canvas::text`] writes it.
    fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: Anchor) -> Result<(), Error>;
}

impl Surface for Canvas {
    fn polyline(&mut self, points: &[[f64; 2]], pen: Pen) {
        if pen.dashed {
            for dash in dashes::cut(points, DASHES) {
                self.stroke(&dash, pen.width, pen.colour, 1.0);
            }
        } else {
            self.stroke(points, pen.width, pen.colour, 1.0);
        }
    }

    fn circle(&mut self, centre: [f64; 2], radius: f64, fill: Rgb, outline: Option<Pen>) {
        let inside = match outline {
            Some(pen) => {
                self.stroke(&[centre], 2.0 * radius + pen.width, pen.colour, 1.0);
                radius - 0.5 * pen.width
            }
            None => radius,
        };
        self.stroke(&[centre], 2.0 * inside, fill, 1.0);
    }

    fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: Anchor) -> Result<(), Error> {
        Self::text(self, text, at, size, anchor)
    }
}
