//! A contact sheet of many whiskers: taper to the right, curvature upwards.

use super::Error;
use super::axis;
use super::canvas::{Anchor, Area, Canvas, text_width};
use super::legend::{self, Heading, LABEL, TICK};
use super::panel;
use super::shading::Shading;
use crate::store::StoredMap;

/// All panels together are at most this wide and high, whatever their number.
const SHEET: [f64; 2] = [1720.0, 1500.0];
/// A panel is at most this wide and high.
const PANEL: f64 = 560.0;
const RIGHT: f64 = 48.0;

/// Draws every panel of a map.
pub(super) fn draw(map: &StoredMap, channel: &str, shading: &Shading) -> Result<Canvas, Error> {
    let layout = map.layout();
    let pitch = [layout.columns, layout.rows]
        .into_iter()
        .zip(SHEET)
        .fold(PANEL, |pitch, (panels, room)| {
            pitch.min(room / panels as f64)
        });
    let gap = (0.06 * pitch).min(10.0);
    let size = [layout.columns, layout.rows].map(|panels| pitch * panels as f64 - gap);

    let left = if map.grid().curvature_per_mm.is_some() {
        168.0
    } else {
        48.0
    };
    let below = if map.grid().taper.is_some() {
        180.0
    } else {
        98.0
    };
    let right = match shading {
        Shading::Scale(scale) if scale.range.is_some() => legend::BAR_ROOM,
        _ => RIGHT,
    };
    let notes = notes(map);
    let widest = text_width(&notes[0], TICK)?.max(text_width(&notes[1], TICK)?);
    let width = (left + size[0] + right).max(left + widest + RIGHT);
    let heading = Heading::plan(map.title(), shading, width - left - RIGHT)?;
    let sheet = Area {
        left,
        top: heading.height,
        width: size[0],
        height: size[1],
    };
    let mut canvas = Canvas::new(width, sheet.bottom() + below);
    heading.draw(&mut canvas, left)?;
    for index in 0..layout.panels() {
        let (column, row) = (index % layout.columns, index / layout.columns);
        let area = Area {
            left: left + pitch * column as f64,
            top: sheet.top + pitch * (layout.rows - 1 - row) as f64,
            width: pitch - gap,
            height: pitch - gap,
        };
        let line = (pitch / 140.0).clamp(0.8, 2.5);
        panel::draw(&mut canvas, area, map, channel, index, shading, line)?;
    }
    if let Shading::Scale(scale) = shading {
        legend::bar(&mut canvas, sheet, scale)?;
    }
    tapers(&mut canvas, map, sheet, pitch, gap)?;
    curvatures(&mut canvas, map, sheet, pitch, gap)?;
    for (line, note) in notes.iter().enumerate() {
        let y = sheet.bottom() + below - 62.0 + 34.0 * line as f64;
        canvas.text(note, [left, y], TICK, Anchor::Left)?;
    }
    Ok(canvas)
}

fn tapers(
    canvas: &mut Canvas,
    map: &StoredMap,
    sheet: Area,
    pitch: f64,
    gap: f64,
) -> Result<(), Error> {
    let Some(values) = &map.grid().taper else {
        return Ok(());
    };
    let labels = axis::labels(values);
    let mut free = f64::NEG_INFINITY;
    for (column, label) in labels.iter().enumerate() {
        let x = sheet.left + pitch * column as f64 + 0.5 * (pitch - gap);
        let half = 0.5 * text_width(label, TICK)?;
        if x - half > free {
            canvas.text(label, [x, sheet.bottom() + 22.0], TICK, Anchor::Centre)?;
            free = x + half + 12.0;
        }
    }
    let middle = [sheet.left + 0.5 * sheet.width, sheet.bottom() + 66.0];
    canvas.text(
        "taper (1 \u{2212} tip/base radius)",
        middle,
        LABEL,
        Anchor::Centre,
    )
}

fn curvatures(
    canvas: &mut Canvas,
    map: &StoredMap,
    sheet: Area,
    pitch: f64,
    gap: f64,
) -> Result<(), Error> {
    let Some(values) = &map.grid().curvature_per_mm else {
        return Ok(());
    };
    let labels = axis::labels(values);
    let mut free = f64::INFINITY;
    for (row, label) in labels.iter().enumerate() {
        let y = sheet.bottom() - pitch * row as f64 - 0.5 * (pitch - gap);
        if y < free {
            canvas.text(label, [sheet.left - 14.0, y], TICK, Anchor::Right)?;
            free = y - TICK;
        }
    }
    let middle = [34.0, sheet.top + 0.5 * sheet.height];
    canvas.text("curvature (1/mm)", middle, LABEL, Anchor::Upwards)
}

/// What lies inside a panel.
fn notes(map: &StoredMap) -> [String; 2] {
    let ends = |values: &[f64]| {
        let labels = axis::labels(&[values[0], values[values.len() - 1]]);
        labels.join(" to ")
    };
    [
        format!(
            "each panel, to the right: push angle {} deg, CF < 0 < CB",
            ends(&map.grid().push_angle_deg)
        ),
        format!(
            "each panel, upwards: distance at first touch {} mm",
            ends(&map.grid().distance_mm)
        ),
    ]
}
