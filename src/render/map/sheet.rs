//! Where the panels of a map stand: one whisker alone, or a contact sheet with the first sweep axis to the right and the
//! second upwards.

use super::cells::Cells;
use super::panel;
use super::scale::BAR_ROOM;
use super::shading::Shading;
use crate::render::axes::{Axes, BELOW};
use crate::render::error::Error;
use crate::render::font::{self, fitted};
use crate::render::heading::{ALONE, HEAD_ROOM, Heading, SIDES, TICK, TITLE, TITLE_LINE};
use crate::render::picture::{Anchor, Area, Picture};
use crate::render::ticks::{self, Tick};
use crate::render::units;
use crate::scene::SweepAxis;
use crate::store::{Layout, Slice};

/// All panels of a contact sheet together are at most this wide and high, whatever their number.
const SHEET: [f64; 2] = [1720.0, 1500.0];
/// A panel of a contact sheet is at most this wide and high.
const PANEL: f64 = 560.0;
/// From one note to the next.
const NOTE: f64 = 34.0;

const PUSH_ANGLE: &str = "push angle (deg)   CF < 0 < CB";
const DISTANCE: &str = "distance at first touch (mm)";

/// The panels of a map laid out.
pub(super) struct Sheet {
    /// Width and height of all panels together.
    size: [f64; 2],
    /// From one panel to the next, and the part of it that is left free.
    pitch: [f64; 2],
    gap: f64,
    axes: Axes,
    /// What lies inside a panel, where the axes do not say it.
    notes: Vec<String>,
    /// Width of the lines in a panel.
    line: f64,
}

impl Sheet {
    pub(super) fn of(map: &Slice) -> Self {
        if map.layout().panels() == 1 {
            Self::alone(map)
        } else {
            Self::atlas(map)
        }
    }

    fn alone(map: &Slice) -> Self {
        let (label, unit) = distance(map);
        let across = Cells::new(&map.grid().push_angle_deg).ticks(1.0);
        let upwards = Cells::new(&map.grid().distance_mm).ticks(unit);
        Self {
            size: ALONE,
            pitch: ALONE,
            gap: 0.0,
            axes: Axes::new([(across, PUSH_ANGLE), (upwards, &label)], ALONE),
            notes: Vec::new(),
            line: 3.0,
        }
    }

    fn atlas(map: &Slice) -> Self {
        let (layout, grid) = (map.layout(), map.grid());
        let panels = [layout.columns, layout.rows].map(|panels| panels as f64);
        let pitch = PANEL.min(SHEET[0] / panels[0]).min(SHEET[1] / panels[1]);
        let gap = (0.06 * pitch).min(10.0);
        let size = panels.map(|panels| pitch * panels - gap);
        let label = |axis: &SweepAxis| match axis.parameter.unit() {
            "1" => axis.parameter.title().to_owned(),
            unit => format!("{} ({unit})", axis.parameter.title()),
        };
        let [across, upwards] = grid.atlas();
        let labels = [across, upwards].map(|axis| axis.map_or_else(String::new, label));
        let ticks = |axis: Option<&SweepAxis>, size: f64| {
            let middle = |place: usize| (pitch * place as f64 + 0.5 * (pitch - gap)) / size;
            let labels = axis.map_or_else(Vec::new, |own| ticks::labels(&own.values));
            let labels = labels.into_iter().enumerate();
            let ticks = labels.map(|(place, label)| Tick::new(middle(place), label));
            ticks.collect()
        };
        let axes = [
            (ticks(across, size[0]), &*labels[0]),
            (ticks(upwards, size[1]), &*labels[1]),
        ];
        let ends = |values: &[f64], unit: f64| {
            ticks::labels(&[values[0] / unit, values[values.len() - 1] / unit]).join(" to ")
        };
        let (distance, unit) = distance(map);
        let angles = ends(&grid.push_angle_deg, 1.0);
        let distances = ends(&grid.distance_mm, unit);
        Self {
            size,
            pitch: [pitch; 2],
            gap,
            axes: Axes::new(axes, size),
            notes: vec![
                format!("each panel, to the right: {PUSH_ANGLE}, {angles}"),
                format!("each panel, upwards: {distance}, {distances}"),
            ],
            line: (pitch / 140.0).clamp(0.8, 2.5),
        }
    }

    /// Draws every panel with what stands around them.
    pub(super) fn draw(
        &self,
        map: &Slice,
        channel: &str,
        shading: &Shading,
        wanted: Option<u32>,
    ) -> Result<Picture, Error> {
        let [left, right] = self.axes.sides();
        let left = left.max(SIDES[0]);
        let right = match shading {
            Shading::Scale(scale) if scale.range.is_some() => BAR_ROOM,
            _ => right.max(SIDES[1]),
        };
        let notes = self.notes.iter().map(|note| font::width(note, TICK));
        let noted = notes.fold(0.0, f64::max) + SIDES[1];
        let width = left + (self.size[0] + right).max(noted);
        let room = width - left - SIDES[1];
        let heading = Heading::plan([""; 2], shading.samples(), [left, room]);
        let body = Area::new([left, HEAD_ROOM + heading.height], self.size);
        let below = BELOW + NOTE * self.notes.len() as f64;
        let mut picture = Picture::new([width, body.bottom() + below], wanted);
        let title = fitted(&map.title(), TITLE, room);
        picture.fitted(&title, [left, TITLE_LINE], Anchor::Left);
        heading.draw(&mut picture, [left, HEAD_ROOM], left);
        let layout = map.layout();
        for index in 0..layout.panels() {
            let area = self.panel(body, layout, index);
            let cells = (map, channel, index);
            panel::draw(&mut picture, area, cells, shading, self.line)?;
        }
        if let Shading::Scale(scale) = shading {
            scale.bar(&mut picture, body);
        }
        self.axes.draw(&mut picture, body, left);
        for (line, note) in self.notes.iter().enumerate() {
            let y = body.bottom() + BELOW + NOTE * (line as f64 + 0.2);
            picture.text(note, [left, y], TICK, Anchor::Left);
        }
        Ok(picture)
    }

    /// Where a panel stands.
    fn panel(&self, body: Area, layout: Layout, index: usize) -> Area {
        let (column, row) = (index % layout.columns, index / layout.columns);
        let left = body.left + self.pitch[0] * column as f64;
        let top = body.top + self.pitch[1] * (layout.rows - 1 - row) as f64;
        Area::new([left, top], self.pitch.map(|pitch| pitch - self.gap))
    }
}

/// The label of the distances and its unit in mm.
fn distance(map: &Slice) -> (String, f64) {
    let largest = map.grid().distance_mm.last().copied().unwrap_or_default();
    units::readable(DISTANCE, largest)
}
