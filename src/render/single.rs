//! The map of one whisker.

use super::Error;
use super::axis::{self, Axis};
use super::canvas::{Anchor, Area, Canvas, text_width};
use super::legend::{self, Heading, LABEL, TICK};
use super::palette::INK;
use super::panel;
use super::shading::Shading;
use crate::store::StoredMap;

/// Size of the body, and the room around it.
const BODY: [f64; 2] = [1280.0, 880.0];
const LEFT: f64 = 136.0;
const RIGHT: f64 = 48.0;
const BELOW: f64 = 112.0;

/// Draws the only panel of a map.
pub(super) fn draw(map: &StoredMap, channel: &str, shading: &Shading) -> Result<Canvas, Error> {
    let heading = Heading::plan(map.title(), shading, BODY[0])?;
    let [width, height] = BODY;
    let body = Area {
        left: LEFT,
        top: heading.height,
        width,
        height,
    };
    let right = match shading {
        Shading::Scale(scale) if scale.range.is_some() => legend::BAR_ROOM,
        _ => RIGHT,
    };
    let mut canvas = Canvas::new(body.right() + right, body.bottom() + BELOW);
    heading.draw(&mut canvas, LEFT)?;
    panel::draw(&mut canvas, body, map, channel, 0, shading, 3.0)?;
    if let Shading::Scale(scale) = shading {
        legend::bar(&mut canvas, body, scale)?;
    }
    push_angles(&mut canvas, body, &Axis::new(&map.grid().push_angle_deg))?;
    distances(&mut canvas, body, &Axis::new(&map.grid().distance_mm))?;
    Ok(canvas)
}

fn push_angles(canvas: &mut Canvas, body: Area, axis: &Axis) -> Result<(), Error> {
    let ticks = axis.ticks();
    let mut free = f64::NEG_INFINITY;
    for (tick, label) in ticks.iter().zip(axis::labels(&ticks)) {
        let [x, y] = body.point(axis.fraction(*tick), 0.0);
        canvas.line([x, y], [x, y + 8.0], 1.5, INK, 1.0);
        let half = 0.5 * text_width(&label, TICK)?;
        if x - half > free {
            canvas.text(&label, [x, y + 26.0], TICK, Anchor::Centre)?;
            free = x + half + 10.0;
        }
    }
    let middle = [body.left + 0.5 * body.width, body.bottom() + 76.0];
    canvas.text(
        "push angle (deg)   CF < 0 < CB",
        middle,
        LABEL,
        Anchor::Centre,
    )
}

fn distances(canvas: &mut Canvas, body: Area, axis: &Axis) -> Result<(), Error> {
    let ticks = axis.ticks();
    let mut free = f64::INFINITY;
    for (tick, label) in ticks.iter().zip(axis::labels(&ticks)) {
        let [x, y] = body.point(0.0, axis.fraction(*tick));
        canvas.line([x - 8.0, y], [x, y], 1.5, INK, 1.0);
        if y < free {
            canvas.text(&label, [x - 15.0, y], TICK, Anchor::Right)?;
            free = y - TICK;
        }
    }
    let middle = [34.0, body.top + 0.5 * body.height];
    canvas.text(
        "distance at first touch (mm)",
        middle,
        LABEL,
        Anchor::Upwards,
    )
}
