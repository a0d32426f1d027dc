//! Layout of a heat map, in units of the picture: one panel, or a contact sheet of many.

use super::panels::PanelGrid;
use super::{HeatMap, PanelCells, Shading};
use crate::frame::axes::Axes;
use crate::frame::heading::{ALONE, Heading, LINE, LegendEntry, SIDES, TICK, TITLE};
use crate::frame::regions::RegionNames;
use crate::frame::spacing::Spacing;
use crate::frame::ticks::Tick;
use crate::picture::size::{PictureSize, SizeError};
use crate::picture::text::TextBlock;
use crate::picture::{Anchor, Area, Picture, font};

/// Largest width and height of all panels of a contact sheet together, in pixels.
const SHEET: [f64; 2] = [1720.0, 1500.0];
/// Largest width and height of a panel of a contact sheet, in pixels.
const PANEL: f64 = 560.0;
/// Room above where the heat map has no title.
const UNTITLED: f64 = 24.0;
/// Distance between notes, in pixels.
const NOTE: f64 = 34.0;
/// Layouts until panels and the labels around them agree: the labels depend on the panels.
const PASSES: usize = 3;

/// A heat map with the positions of its panels, in units of the picture.
pub struct HeatMapLayout<'a> {
    map: &'a HeatMap,
    panels: PanelGrid,
    axes: Axes,
    regions: RegionNames,
    /// Notes on the axes of the panels, where the axes of the picture are those of the contact sheet.
    notes: Vec<TextBlock>,
    title: TextBlock,
    /// Height of the title and the room around it.
    head: f64,
    heading: Heading,
    /// Space to the left of all panels.
    left: f64,
    /// Position of the title and the notes from the left.
    head_left: f64,
    spacing: Spacing,
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
        let grid = PanelGrid::of(map);
        let natural = match grid.is_sheet() {
            false => ALONE,
            true => grid.natural(SHEET, PANEL),
        };
        let PictureSize::Print(print) = size else {
            return Ok(Self::around(map, natural, SIDES, size));
        };
        let mut layout = Self::around(map, natural, [0.0; 2], size);
        for _ in 0..PASSES {
            let bodies = [layout.body.width, layout.body.height];
            let ratio = match grid.is_sheet() {
                false => natural[1] / natural[0],
                true => grid.height(bodies[0]) / bodies[0],
            };
            let bodies = print.bodies(layout.units, bodies, ratio, 0.0);
            layout = Self::around(map, bodies, [0.0; 2], size);
        }
        let bodies = [layout.body.width, layout.body.height];
        layout.units = print.fitted(layout.units, bodies, 0.0)?;
        Ok(layout)
    }

    /// Lays a heat map out around panels that have the size `area` together, with at least `least` space `[left, right]` beside them.
    fn around(map: &'a HeatMap, area: [f64; 2], least: [f64; 2], size: PictureSize) -> Self {
        let spacing = Spacing::of(size);
        let panels = PanelGrid::of(map).in_area(area);
        let is_sheet = panels.is_sheet();
        let axes = match is_sheet {
            false => {
                let [(x_ticks, x_label), (y_ticks, y_label)] =
                    [(&map.x, area[0]), (&map.y, area[1])].map(|(axis, room)| axis.ticks(room));
                Axes::new([(x_ticks, &x_label), (y_ticks, &y_label)], area, spacing)
            }
            true => sheet_axes(map, area, &panels, spacing),
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
            _ => texts.iter().map(|note| font::width(note, TICK)).fold(0.0, f64::max) + SIDES[1],
        };
        let width = left + (area[0] + right).max(noted);
        let right = width - left - area[0];
        // On a screen, title and legend extend over the colour bar.
        let beyond = match spacing.edge {
            None => right - right.min(SIDES[1]),
            Some(_) => 0.0,
        };
        let body = [left, area[0] + beyond, right - beyond];
        let [before, room] = spacing.head_span(body);
        let notes: Vec<_> = texts.iter().map(|note| TextBlock::new(note, TICK, room)).collect();
        let title = TextBlock::new(&map.title, TITLE, room);
        let heading = Heading::plan([""; 2], legend, body, spacing);
        let alone = map.regions.as_ref().filter(|_| !is_sheet);
        let regions = RegionNames::plan(alone, map.x.fraction(0.0), area[0]);
        let head = match &*map.title {
            "" => UNTITLED,
            _ => spacing.head_room + title.below_first(),
        };
        let top = head + heading.height + regions.height();
        let body = Area::new([left, top], area);
        let noted: f64 = notes.iter().map(|note| NOTE + note.below_first()).sum();
        Self {
            map,
            units: [width, body.bottom() + axes.below() + noted],
            axes,
            regions,
            notes,
            title,
            head,
            heading,
            left,
            head_left: left - before,
            spacing,
            body,
            line: match is_sheet {
                true => (panels.pitch[0] / 140.0).clamp(0.8, 2.5),
                false => LINE,
            },
            panels,
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
        let title = [self.head_left, self.spacing.title_line];
        picture.block(&self.title, title, Anchor::Left);
        self.heading.draw(&mut picture, [left, self.head], left);
        for index in 0..self.panels.count {
            let area = self.panels.area(body, index);
            map.draw_panel(&mut picture, area, &panel(index)?, self.line);
            self.panels.draw_label(&mut picture, area, index);
        }
        if let Shading::Quantities(scale) = &map.shading {
            scale.draw_bar(&mut picture, body);
        }
        self.axes.draw(&mut picture, body, left);
        self.regions.draw(&mut picture, body);
        let mut y = body.bottom() + self.axes.below() + 0.2 * NOTE;
        for note in &self.notes {
            picture.block(note, [self.head_left, y], Anchor::Left);
            y += NOTE + note.below_first();
        }
        Ok(picture)
    }
}

/// The axes of a contact sheet of this `area`: ticks at the middles of its panels, or none if the values are above them.
fn sheet_axes(map: &HeatMap, area: [f64; 2], panels: &PanelGrid, spacing: Spacing) -> Axes {
    let axes = map.panel_axes.each_ref();
    if panels.has_labels() {
        return Axes::new([(Vec::new(), ""), (Vec::new(), "")], area, spacing);
    }
    let ticks = |side: usize| -> Vec<Tick> {
        let labels = axes[side].iter().flat_map(|axis| axis.texts.iter().cloned()).enumerate();
        let ticks = labels.map(|(place, label)| Tick::new(panels.middle(side, place, area), label));
        ticks.collect()
    };
    let label = |side: usize| axes[side].as_ref().map_or("", |axis| &*axis.label);
    Axes::new([(ticks(0), label(0)), (ticks(1), label(1))], area, spacing)
}
