//! What plots and their insets are drawn of: lines, discs, and the pens for them.

use super::data::{Disc, Ink, Line, Stroke};
use super::window::Window;
use crate::render::axes::FRAME;
use crate::render::palette::{BLANK, BLUE, GREY, INK, Rgb};
use crate::render::picture::{Area, Pen, Picture};

/// Width of lines.
pub(super) const LINE: f64 = 3.0;
/// Radius of a point of a line that has no neighbour, and of the smallest disc.
const POINT: f64 = 5.0;
const DISC: f64 = 3.0;

/// The colour that an ink stands for.
pub(super) const fn colour(ink: Ink) -> Rgb {
    match ink {
        Ink::Black => INK,
        Ink::Blue => BLUE,
        Ink::Grey => GREY,
    }
}

/// What a line is drawn with.
pub(super) fn pen(line: &Line) -> Pen {
    Pen {
        width: LINE,
        colour: colour(line.ink),
        dashed: line.stroke == Stroke::Dashed,
    }
}

/// What an open dot is drawn with.
pub(super) const fn rim(ink: Ink) -> Pen {
    Pen::solid(LINE, colour(ink))
}

/// Draws a disc in the data units of `window`, which fills `body`.
pub(super) fn disc(picture: &mut Picture, body: Area, window: &Window, disc: &Disc) {
    let centre = window.place(body, disc.centre);
    let radius = window.pixels(body, disc.radius).max(DISC);
    let fill = if disc.dark { GREY } else { BLANK };
    picture.circle(centre, radius, fill, Some(Pen::solid(FRAME, INK)));
}

/// Draws drawable points the way a line is drawn; a single one is a dot.
pub(super) fn polyline(
    picture: &mut Picture,
    body: Area,
    window: &Window,
    points: &[[f64; 2]],
    line: &Line,
) {
    let pen = pen(line);
    let places = points.iter().map(|point| window.place(body, *point));
    match places.collect::<Vec<_>>()[..] {
        [] => {}
        [only] => picture.circle(only, POINT, pen.colour, None),
        ref places => picture.polyline(places, pen),
    }
}
