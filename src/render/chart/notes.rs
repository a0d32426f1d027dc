//! Notes: short texts and arrows among the lines.

use super::data::Note;
use super::marks::colour;
use super::window::Window;
use crate::render::font;
use crate::render::heading::NAME;
use crate::render::picture::{Anchor, Area, Pen, Picture};
use glam::DVec2;

/// From a point to the middle of the text above it, and from an arrow to the text behind it.
const ABOVE: f64 = 20.0;
const BEHIND: f64 = 6.0;
/// Width of arrows, length of their heads, and half the angle between the strokes of a head.
const ARROW: f64 = 2.5;
const HEAD: f64 = 13.0;
const HALF_ANGLE: f64 = 0.45;

/// Draws the notes inside of `window`, which fills `body`.
pub(super) fn draw(picture: &mut Picture, body: Area, window: &Window, notes: &[Note]) {
    for note in notes.iter().filter(|note| window.holds(note.at)) {
        let at = window.place(body, note.at);
        let mut text = [at[0], at[1] - ABOVE];
        if let Some(to) = note.to.filter(|to| window.holds(*to)) {
            let to = window.place(body, to);
            arrow(picture, at, to, Pen::solid(ARROW, colour(note.ink)));
            text = behind(at, to, &note.text);
        }
        picture.text(&note.text, text, NAME, Anchor::Centre);
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
