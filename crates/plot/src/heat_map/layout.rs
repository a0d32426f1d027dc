//! Layout of a heat map, in units of the picture: one panel, or a contact sheet of many.

use super::{HeatMap, PanelAxis, PanelCells, Shading};
use crate::frame::axes::Axes;
use crate::frame::heading::{
    ALONE, HEAD_ROOM, Heading, LINE, LegendEntry, SIDES, TICK, TITLE, TITLE_LINE,
};
use crate::frame::regions::RegionNames;
use crate::frame::ticks::{self, Tick};
use crate::picture::size::{PictureSize, SizeError};
use crate::picture::text::TextBlock;
use crate::picture::{Anchor, Area, Picture, font};

/// Largest width and height of all panels of a contact sheet together, in pixels.
const SHEET: [f64; 2] = [1720.0, 1500.0];
/// Largest width and height of a panel of a contact sheet, in pixels.
const PANEL: f64 = 560.0;
/// Distance between notes, in pixels.
const NOTE: f64 = 34.0;
/// Gap between panels, as a fraction of their distance.
const GAP: f64 = 0.06;
/// Layouts until panels and the labels around them agree: the labels depend on the panels.
const PASSES: usize = 3;

/// A heat map with the positions of its panels, in units of the picture.
pub struct HeatMapLayout<'a> {
    map: &'a HeatMap,
    /// Columns and rows of panels.
    counts: [usize; 2],
    /// Distance from one panel to the next along x and y.
    pitch: [f64; 2],
    /// Gap between panels.
    gap: f64,
    axes: Axes,
    regions: RegionNames,
    /// Notes on the axes of the panels, where the axes of the picture are those of the contact sheet.
    notes: Vec<TextBlock>,
    title: TextBlock,
    heading: Heading,
    /// Space to the left of all panels.
    left: f64,
    /// The area of all panels.
    body: Area,
    /// Width of the curves in a panel.
    line: f64,
    /// Width and height of the picture.
    units: [f64; 2],
    size: PictureSize,
}

impl<'a> HeatMapLayout<'a> {
    pub fn plan(map: &'a HeatMap, size: PictureSize) -> Result<Self, SizeError> {
        let counts = map.panel_counts();
        let natural = match counts {
            [1, 1] => ALONE,
            counts => {
                let panels = counts.map(|panels| panels as f64);
                let pitch = PANEL.min(SHEET[0] / panels[0]).min(SHEET[1] / panels[1]);
                panels.map(|panels| pitch * panels - gap(pitch))
            }
        };
        let PictureSize::Print(print) = size else {
            return Ok(Self::around(map, natural, SIDES, size));
        };
        let mut layout = Self::around(map, natural, [0.0; 2], size);
        for _ in 0..PASSES {
            let bodies = [layout.body.width, layout.body.height];
            let bodies = print.bodies(layout.units, bodies, natural[1] / natural[0]);
            layout = Self::around(map, bodies, [0.0; 2], size);
        }
        let bodies = [layout.body.width, layout.body.height];
        layout.units = print.fitted(layout.units, bodies)?;
        Ok(layout)
    }

    /// Lays a heat map out around panels that have the size `area` together, with at least `least` space `[left, right]` beside them.
    fn around(map: &'a HeatMap, area: [f64; 2], least: [f64; 2], size: PictureSize) -> Self {
        let counts = map.panel_counts();
        let is_sheet = counts != [1, 1];
        let panels = counts.map(|panels| panels as f64);
        let gap = match is_sheet {
            true => gap([0, 1]
                .map(|axis| area[axis] / (panels[axis] - GAP))
                .into_iter()
                .fold(f64::INFINITY, f64::min)),
            false => 0.0,
        };
        let pitch = [0, 1].map(|axis| (area[axis] + gap) / panels[axis]);
        let axes = match is_sheet {
            false => {
                let [(x_ticks, x_label), (y_ticks, y_label)] =
                    [(&map.x, area[0]), (&map.y, area[1])].map(|(axis, room)| axis.ticks(room));
                Axes::new([(x_ticks, &x_label), (y_ticks, &y_label)], area)
            }
            true => sheet_axes(map, area, pitch.map(|pitch| pitch - gap), pitch),
        };
        let [left, right] = axes.sides();
        let left = left.max(least[0]);
        let (right, legend) = match &map.shading {
            Shading::Quantities(scale) => {
                let right = scale.bar_room(area[1]).unwrap_or(right.max(least[1]));
                (right, &scale.legend[..])
            }
            Shading::Codes { .. } => (right.max(least[1]), &[][..]),
        };
        let legend: Vec<LegendEntry> = legend.iter().chain(&map.legend).cloned().collect();
        let texts = if is_sheet { map.notes() } else { Vec::new() };
        let noted = match size {
            PictureSize::Print(_) => 0.0,
            _ => {
                texts
                    .iter()
                    .map(|note| font::width(note, TICK))
                    .fold(0.0, f64::max)
                    + SIDES[1]
            }
        };
        let width = left + (area[0] + right).max(noted);
        let room = width - left - right.min(SIDES[1]);
        let notes: Vec<_> = texts
            .iter()
            .map(|note| TextBlock::new(note, TICK, room))
            .collect();
        let title = TextBlock::new(&map.title, TITLE, room);
        let heading = Heading::plan([""; 2], legend, [left, room]);
        let alone = map.regions.as_ref().filter(|_| !is_sheet);
        let regions = RegionNames::plan(alone, map.x.fraction(0.0), area[0]);
        let top = HEAD_ROOM + title.below_first() + heading.height + regions.height();
        let body = Area::new([left, top], area);
        let noted: f64 = notes.iter().map(|note| NOTE + note.below_first()).sum();
        Self {
            map,
            counts,
            pitch,
            gap,
            units: [width, body.bottom() + axes.below() + noted],
            axes,
            regions,
            notes,
            title,
            heading,
            left,
            body,
            line: match is_sheet {
                true => (pitch[0] / 140.0).clamp(0.8, 2.5),
                false => LINE,
            },
            size,
        }
    }

    /// Draws all panels of the heat map, one by one, then headings, axes and the colour bar.
    pub fn draw<E>(
        &self,
        mut panel: impl FnMut(usize) -> Result<PanelCells, E>,
    ) -> Result<Picture, E> {
        let (map, body, left) = (self.map, self.body, self.left);
        let mut picture = Picture::new(self.units, self.size);
        picture.block(&self.title, [left, TITLE_LINE], Anchor::Left);
        let head = HEAD_ROOM + self.title.below_first();
        self.heading.draw(&mut picture, [left, head], left);
        let [columns, rows] = self.counts;
        for index in 0..columns * rows {
            let area = self.panel_area([index % columns, index / columns]);
            map.draw_panel(&mut picture, area, &panel(index)?, self.line);
        }
        if let Shading::Quantities(scale) = &map.shading {
            scale.draw_bar(&mut picture, body);
        }
        self.axes.draw(&mut picture, body, left);
        self.regions.draw(&mut picture, body);
        let mut y = body.bottom() + self.axes.below() + 0.2 * NOTE;
        for note in &self.notes {
            picture.block(note, [left, y], Anchor::Left);
            y += NOTE + note.below_first();
        }
        Ok(picture)
    }

    /// The area of the panel in a column from the left and a row from below.
    fn panel_area(&self, [column, row]: [usize; 2]) -> Area {
        let left = self.body.left + self.pitch[0] * column as f64;
        let top = self.body.top + self.pitch[1] * (self.counts[1] - 1 - row) as f64;
        Area::new([left, top], self.pitch.map(|pitch| pitch - self.gap))
    }
}

/// The gap between panels at this distance.
fn gap(pitch: f64) -> f64 {
    (GAP * pitch).min(10.0)
}

/// The axes of a contact sheet of this `area`: ticks at the middles of its panels.
fn sheet_axes(map: &HeatMap, area: [f64; 2], panel: [f64; 2], pitch: [f64; 2]) -> Axes {
    let ticks = |side: usize| -> Vec<Tick> {
        let axis: &Option<PanelAxis> = &map.panel_axes[side];
        let middle = |place: usize| (pitch[side] * place as f64 + 0.5 * panel[side]) / area[side];
        let labels = axis.iter().flat_map(|axis| ticks::labels(&axis.values));
        let labels = labels.enumerate();
        let ticks = labels.map(|(place, label)| Tick::new(middle(place), label));
        ticks.collect()
    };
    let label = |side: usize| {
        map.panel_axes[side]
            .as_ref()
            .map_or("", |axis| &*axis.label)
    };
    Axes::new([(ticks(0), label(0)), (ticks(1), label(1))], area)
}
