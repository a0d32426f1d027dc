//! Draws lines, discs, notes and insets, given in data units, into an area of the picture.

use super::window::{Window, drawable};
use super::{Disc, Inset, Line, Note, Plot, Stroke};
use crate::frame::axes::FRAME;
use crate::frame::heading::{LINE, NAME};
use crate::picture::palette::{BLANK, GREY, INK};
use crate::picture::{Anchor, Area, Pen, Picture, font};
use glam::DVec2;

/// Radius of a point of a line that has no neighbour, in pixels.
const POINT: f64 = 5.0;
/// Radius of the smallest disc, in pixels.
const DISC: f64 = 3.0;
/// Side of an inset, as a fraction of the height of the body.
const INSET: f64 = 0.5;
/// Distance of a text's middle above its point, in pixels.
const ABOVE: f64 = 20.0;
/// Distance of a text behind its arrow, in pixels.
const BEHIND: f64 = 6.0;
/// Width of arrows, in pixels.
const ARROW: f64 = 2.5;
/// Length of the heads of arrows, in pixels.
const HEAD: f64 = 13.0;
/// Half the angle between the strokes of an arrow's head, in radians.
const HALF_ANGLE: f64 = 0.45;

/// Returns the pen that draws a line of a chart.
pub fn pen(line: &Line) -> Pen {
    Pen { width: LINE, colour: line.ink.rgb(), dashed: line.stroke == Stroke::Dashed }
}

/// A window of data, and the area of the picture that shows it.
#[derive(Clone, Copy)]
pub struct Viewport {
    pub body: Area,
    pub window: Window,
}

impl Viewport {
    /// Converts a point `[x, y]` from data units to the picture's units.
    pub fn place(&self, point: [f64; 2]) -> [f64; 2] {
        self.window.place(self.body, point)
    }

    pub fn disc(&self, picture: &mut Picture, disc: &Disc) {
        let radius = self.window.pixels(self.body, disc.radius).max(DISC);
        let fill = if disc.dark { GREY } else { BLANK };
        let rim = Pen::solid(FRAME, INK);
        picture.circle(self.place(disc.centre), radius, fill, Some(rim));
    }

    /// Draws the parts of a line between its breaks; if `clipped`, only what lies inside the window.
    pub fn line(&self, picture: &mut Picture, line: &Line, clipped: bool) {
        for stretch in line.points.split(|point| !drawable(*point)) {
            if clipped {
                for part in self.window.clipped(stretch) {
                    self.stretch(picture, &part, line);
                }
            } else {
                self.stretch(picture, stretch, line);
            }
        }
    }

    /// Draws drawable points with the pen of a line; a single point is a dot.
    fn stretch(&self, picture: &mut Picture, points: &[[f64; 2]], line: &Line) {
        let pen = pen(line);
        let places = points.iter().map(|point| self.place(*point));
        match places.collect::<Vec<_>>()[..] {
            [] => {}
            [only] => picture.circle(only, POINT, pen.colour, None),
            ref places => picture.polyline(places, pen),
        }
    }

    /// Draws the notes that lie inside the window of data.
    pub fn notes(&self, picture: &mut Picture, notes: &[Note]) {
        for note in notes.iter().filter(|note| self.window.holds(note.at)) {
            let at = self.place(note.at);
            let mut text = [at[0], at[1] - ABOVE];
            if let Some(to) = note.to.filter(|to| self.window.holds(*to)) {
                let to = self.place(to);
                arrow(picture, at, to, Pen::solid(ARROW, note.ink.rgb()));
                text = behind(at, to, &note.text);
            }
            picture.text(&note.text, text, NAME, Anchor::Centre);
        }
    }

    /// Draws an inset: a square of `plot`, enlarged.
    pub fn inset(&self, picture: &mut Picture, plot: &Plot, inset: &Inset) {
        let square = self.window.square(inset.centre, inset.half);
        if !(inset.half > 0.0 && square.is_open()) {
            return;
        }
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]];
        let outline = corners.map(|[x, y]| self.place([square.x[x], square.y[y]]));
        picture.polyline(&outline, Pen::solid(FRAME, GREY));

        let side = INSET * self.body.height;
        let [x, y] = self.body.point(inset.place[0], inset.place[1]);
        let larger = Self {
            body: Area::new([x - 0.5 * side, y - 0.5 * side], [side, side]),
            window: square,
        };
        for disc in plot.discs.iter().filter(|disc| square.holds_disc(disc)) {
            larger.disc(picture, disc);
        }
        for line in plot.lines.iter().chain(&inset.lines) {
            larger.line(picture, line, true);
        }
        larger.notes(picture, &inset.notes);
        picture.frame(larger.body, FRAME);
    }
}

/// The middle of a text at the beginning of an arrow, which does not run through it.
fn behind(from: [f64; 2], to: [f64; 2], text: &str) -> [f64; 2] {
    let (from, to) = (DVec2::from(from), DVec2::from(to));
    let back = (from - to).normalize_or_zero();
    let half = 0.5 * DVec2::new(font::width(text, NAME), NAME);
    (from + (back.abs().dot(half) + BEHIND) * back).to_array()
}

fn arrow(picture: &mut Picture, from: [f64; 2], to: [f64; 2], pen: Pen) {
    picture.polyline(&[from, to], pen);
    let tip = DVec2::from(to);
    let back = (DVec2::from(from) - tip).normalize_or_zero();
    let sides =
        [-HALF_ANGLE, HALF_ANGLE].map(|angle| tip + HEAD * DVec2::from_angle(angle).rotate(back));
    picture.polyline(&[sides[0].to_array(), to, sides[1].to_array()], pen);
}
