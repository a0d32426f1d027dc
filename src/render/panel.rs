//! The cells of one panel, and the detachment boundary over them.

use super::Error;
use super::axis::Axis;
use super::boundary;
use super::canvas::{Area, Canvas};
use super::palette::{INK, WHITE};
use super::shading::Shading;
use crate::store::StoredMap;

/// Draws panel `index` of a channel into `area`, distance upwards, with lines of the given width.
pub(super) fn draw(
    canvas: &mut Canvas,
    area: Area,
    map: &StoredMap,
    channel: &str,
    index: usize,
    shading: &Shading,
    width: f64,
) -> Result<(), Error> {
    let grid = map.grid();
    let (x, y) = (
        Axis::new(&grid.push_angle_deg),
        Axis::new(&grid.distance_mm),
    );
    let samples = map.read_panel(channel, index)?;
    let columns = grid.push_angle_deg.len();
    canvas.paint(area, |across, up| {
        shading.fill(samples.value(y.cell(up) * columns + x.cell(across)))
    });
    let rest = x.fraction(0.0);
    if rest > 0.0 && rest < 1.0 {
        canvas.line(
            area.point(rest, 0.0),
            area.point(rest, 1.0),
            0.5 * width,
            WHITE,
            0.7,
        );
    }
    if let Shading::Names(names) = shading
        && names.boundary
    {
        let margin_deg = map.read_panel("margin_deg", index)?;
        for segment in boundary::segments(grid, &margin_deg) {
            let [from, to] = segment
                .map(|[angle, distance]| area.point(x.fraction(angle), y.fraction(distance)));
            canvas.line(from, to, width, INK, 1.0);
        }
    }
    canvas.frame(area, 0.5 * width);
    Ok(())
}
