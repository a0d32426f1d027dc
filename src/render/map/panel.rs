//! The cells of one panel, and the detachment boundary over them.

use super::boundary;
use super::cells::Cells;
use super::scale::is_mark;
use super::shading::Shading;
use crate::render::error::Error;
use crate::render::palette::{INK, WHITE};
use crate::render::picture::{Area, Pen, Picture};
use crate::store::{Samples, Slice};

/// Draws panel `index` of a channel into `area`, distance upwards, with lines of the given width.
pub(super) fn draw(
    picture: &mut Picture,
    area: Area,
    (map, channel, index): (&Slice, &str, usize),
    shading: &Shading,
    width: f64,
) -> Result<(), Error> {
    let grid = map.grid();
    let angles = Cells::new(&grid.push_angle_deg);
    let distances = Cells::new(&grid.distance_mm);
    let samples = map.read_panel(channel, index)?;
    let marks = match shading {
        Shading::Scale(scale) if scale.has_marks => Some(map.read_panel("status", index)?),
        _ => None,
    };
    let columns = grid.push_angle_deg.len();
    picture.raster(area, |across, up| {
        let cell = distances.cell(up) * columns + angles.cell(across);
        let fill = shading.fill(samples.value(cell));
        match &marks {
            Some(Samples::U32(codes)) if is_mark(codes[cell]) => fill.hatched(),
            _ => fill,
        }
    });
    let rest = angles.fraction(0.0);
    if rest > 0.0 && rest < 1.0 {
        let ends = [area.point(rest, 0.0), area.point(rest, 1.0)];
        picture.polyline(&ends, Pen::solid(0.5 * width, WHITE));
    }
    if let Shading::Names { boundary: true, .. } = shading {
        let margin_deg = map.read_panel("margin_deg", index)?;
        for stretch in boundary::stretches(grid, &margin_deg) {
            let place = |[angle, distance]: [f64; 2]| {
                area.point(angles.fraction(angle), distances.fraction(distance))
            };
            let places: Vec<_> = stretch.into_iter().map(place).collect();
            picture.polyline(&places, Pen::solid(width, INK));
        }
    }
    picture.frame(area, 0.5 * width);
    Ok(())
}
