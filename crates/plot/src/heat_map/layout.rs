//! Layout of a heat map: one panel, or a contact sheet of many.

use super::colour_scale::BAR_ROOM;
use super::{HeatMap, PanelAxis, PanelCells, Shading};
use crate::frame::axes::{Axes, BELOW};
use crate::frame::heading::{ALONE, HEAD_ROOM, Heading, LINE, SIDES, TICK, TITLE, TITLE_LINE};
use crate::frame::ticks::{self, Tick};
use crate::picture::font::{self, fitted};
use crate::picture::{Anchor, Area, Picture};

/// Largest width and height of all panels of a contact sheet together, in pixels.
const SHEET: [f64; 2] = [1720.0, 1500.0];
/// Largest width and height of a panel of a contact sheet, in pixels.
const PANEL: f64 = 560.0;
/// Distance between notes, in pixels.
const NOTE: f64 = 34.0;

/// A heat map with the positions of its panels, in pixels.
pub struct HeatMapLayout {
    /// Columns and rows of panels.
    counts: [usize; 2],
    /// Width and height of all panels together.
    size: [f64; 2],
    /// Distance from one panel to the next along x and y, in pixels.
    pitch: [f64; 2],
    /// Gap between panels, in pixels.
    gap: f64,
    axes: Axes,
    /// Notes on the axes of the panels, where the axes of the picture are those of the contact sheet.
    notes: Vec<String>,
    /// Width of the curves in a panel.
    line: f64,
}

impl HeatMapLayout {
    pub fn plan(map: &HeatMap) -> Self {
        match map.panel_counts() {
            [1, 1] => Self::alone(map),
            counts => Self::contact_sheet(map, counts),
        }
    }

    fn alone(map: &HeatMap) -> Self {
        let [(x_ticks, x_label), (y_ticks, y_label)] = [&map.x, &map.y].map(|axis| axis.ticks());
        Self {
            counts: [1, 1],
            size: ALONE,
            pitch: ALONE,
            gap: 0.0,
            axes: Axes::new([(x_ticks, &x_label), (y_ticks, &y_label)], ALONE),
            notes: Vec::new(),
            line: LINE,
        }
    }

    fn contact_sheet(map: &HeatMap, counts: [usize; 2]) -> Self {
        let panels = counts.map(|panels| panels as f64);
        let pitch = PANEL.min(SHEET[0] / panels[0]).min(SHEET[1] / panels[1]);
        let gap = (0.06 * pitch).min(10.0);
        let size = panels.map(|panels| pitch * panels - gap);
        let ticks = |axis: &Option<PanelAxis>, size: f64| -> Vec<Tick> {
            let middle = |place: usize| (pitch * place as f64 + 0.5 * (pitch - gap)) / size;
            let labels = axis.iter().flat_map(|axis| ticks::labels(&axis.values));
            let labels = labels.enumerate();
            let ticks = labels.map(|(place, label)| Tick::new(middle(place), label));
            ticks.collect()
        };
        let [across, upwards] = &map.panel_axes;
        let [x_label, y_label] =
            [across, upwards].map(|axis| axis.as_ref().map_or("", |axis| axis.label.as_str()));
        let axes = [
            (ticks(across, size[0]), x_label),
            (ticks(upwards, size[1]), y_label),
        ];
        Self {
            counts,
            size,
            pitch: [pitch; 2],
            gap,
            axes: Axes::new(axes, size),
            notes: vec![
                format!("each panel, to the right: {}", map.x.summary()),
                format!("each panel, upwards: {}", map.y.summary()),
            ],
            line: (pitch / 140.0).clamp(0.8, 2.5),
        }
    }

    /// Draws all panels of the heat map, one by one, then headings, axes and the colour bar.
    pub fn draw<E>(
        &self,
        map: &HeatMap,
        mut panel: impl FnMut(usize) -> Result<PanelCells, E>,
    ) -> Result<Picture, E> {
        let [left, right] = self.axes.sides();
        let left = left.max(SIDES[0]);
        let (right, mut legend) = match &map.shading {
            Shading::Quantities(scale) if scale.range.is_some() => (BAR_ROOM, scale.legend.clone()),
            Shading::Quantities(scale) => (right.max(SIDES[1]), scale.legend.clone()),
            Shading::Codes { .. } => (right.max(SIDES[1]), Vec::new()),
        };
        legend.extend(map.legend.iter().cloned());
        let notes = self.notes.iter().map(|note| font::width(note, TICK));
        let noted = notes.fold(0.0, f64::max) + SIDES[1];
        let width = left + (self.size[0] + right).max(noted);
        let room = width - left - SIDES[1];
        let heading = Heading::plan([""; 2], legend, [left, room]);
        let body = Area::new([left, HEAD_ROOM + heading.height], self.size);
        let below = BELOW + NOTE * self.notes.len() as f64;
        let mut picture = Picture::new([width, body.bottom() + below], map.width);
        let title = fitted(&map.title, TITLE, room);
        picture.fitted(&title, [left, TITLE_LINE], Anchor::Left);
        heading.draw(&mut picture, [left, HEAD_ROOM], left);
        let [columns, rows] = self.counts;
        for index in 0..columns * rows {
            let area = self.panel_area(body, [index % columns, index / columns]);
            map.draw_panel(&mut picture, area, &panel(index)?, self.line);
        }
        if let Shading::Quantities(scale) = &map.shading {
            scale.draw_bar(&mut picture, body);
        }
        self.axes.draw(&mut picture, body, left);
        for (line, note) in self.notes.iter().enumerate() {
            let y = body.bottom() + BELOW + NOTE * (line as f64 + 0.2);
            picture.text(note, [left, y], TICK, Anchor::Left);
        }
        Ok(picture)
    }

    /// The area of the panel in a column from the left and a row from below.
    fn panel_area(&self, body: Area, [column, row]: [usize; 2]) -> Area {
        let left = body.left + self.pitch[0] * column as f64;
        let top = body.top + self.pitch[1] * (self.counts[1] - 1 - row) as f64;
        Area::new([left, top], self.pitch.map(|pitch| pitch - self.gap))
    }
}
