//! Insets: a square of a plot, enlarged.

use super::data::{Inset, Plot};
use super::marks::{disc, polyline};
use super::notes;
use super::window::{Window, drawable};
use crate::render::axes::FRAME;
use crate::render::palette::GREY;
use crate::render::picture::{Area, Pen, Picture};

/// Side of an inset, as a part of the height of the body.
const SIDE: f64 = 0.5;

/// Draws `inset` into the `body` of `plot`, which shows `window`.
pub(super) fn draw(picture: &mut Picture, body: Area, window: &Window, plot: &Plot, inset: &Inset) {
    let square = window.square(inset.centre, inset.half);
    if !(inset.half > 0.0 && square.is_open()) {
        return;
    }
    let corners = [[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]];
    let outline = corners.map(|[x, y]| window.place(body, [square.x[x], square.y[y]]));
    picture.polyline(&outline, Pen::solid(FRAME, GREY));

    let side = SIDE * body.height;
    let [x, y] = body.point(inset.place[0], inset.place[1]);
    let larger = Area::new([x - 0.5 * side, y - 0.5 * side], [side, side]);
    for one in plot.discs.iter().filter(|one| square.holds_disc(one)) {
        disc(picture, larger, &square, one);
    }
    for line in plot.lines.iter().chain(&inset.lines) {
        for stretch in line.points.split(|point| !drawable(*point)) {
            for part in square.clipped(stretch) {
                polyline(picture, larger, &square, &part, line);
            }
        }
    }
    notes::draw(picture, larger, &square, &inset.notes);
    picture.frame(larger, FRAME);
}
