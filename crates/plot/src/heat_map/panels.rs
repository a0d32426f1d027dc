//! Panels of a heat map in columns and rows.
//!
//! Panels along two axes stand along both. Panels along one axis fill rows from the left, and have their value above them.

use super::{HeatMap, PanelAxis};
use crate::frame::heading::NAME;
use crate::picture::text::TextBlock;
use crate::picture::{Anchor, Area, Picture};

/// Gap between panels, as a fraction of their distance.
const GAP: f64 = 0.06;
/// Largest gap between panels.
const LARGEST_GAP: f64 = 10.0;
/// Height of the space above a panel for a label of one line.
const LABEL: f64 = 1.5 * NAME;
/// Most panels along one axis that stand in one row.
const IN_ONE_ROW: usize = 3;

/// Grid of the panels of a heat map: columns, rows, and the sizes of panels in units of the picture.
#[derive(Clone, Debug)]
pub struct PanelGrid {
    /// Number of panels of the heat map.
    pub count: usize,
    /// Columns and rows of panels.
    counts: [usize; 2],
    /// Texts above the panels, `[panel]`; empty for panels along two axes.
    texts: Vec<String>,
    /// Texts above the panels in lines as long as a panel is wide.
    labels: Vec<TextBlock>,
    /// Height of the highest label.
    highest: f64,
    /// Distance from one panel to the next along each axis, `[x, y]`, in units of the picture.
    pub pitch: [f64; 2],
    /// Gap between panels.
    gap: f64,
}

impl PanelGrid {
    /// Chooses columns and rows for the panels of a heat map, without sizes.
    pub fn of(map: &HeatMap) -> Self {
        let sizes = map.panel_axes.each_ref();
        let sizes = sizes.map(|axis| axis.as_ref().map_or(1, |axis| axis.texts.len()));
        let count = sizes[0] * sizes[1];
        let alone = match &map.panel_axes {
            [Some(axis), None] | [None, Some(axis)] if count > 1 => Some(axis),
            _ => None,
        };
        let columns =
            if count > IN_ONE_ROW { (count as f64).sqrt().ceil() as usize } else { count };
        let texts = |axis: &PanelAxis| axis.texts.clone();
        Self {
            count,
            counts: match alone {
                Some(_) => [columns, count.div_ceil(columns)],
                None => sizes,
            },
            texts: alone.map(texts).unwrap_or_default(),
            labels: Vec::new(),
            highest: 0.0,
            pitch: [0.0; 2],
            gap: 0.0,
        }
    }

    /// Returns true if the heat map is a contact sheet of several panels.
    pub fn is_sheet(&self) -> bool {
        self.counts != [1, 1]
    }

    /// Returns true if the panels have their values above them.
    pub const fn has_labels(&self) -> bool {
        !self.texts.is_empty()
    }

    /// Returns the labels above panels of this `width`, in units of the picture, and the height of the highest one.
    fn labels(&self, width: f64) -> (Vec<TextBlock>, f64) {
        let blocks = self.texts.iter().map(|text| TextBlock::new(text, NAME, width));
        let blocks: Vec<TextBlock> = blocks.collect();
        let heights = blocks.iter().map(|block| LABEL + block.below_first());
        let highest = heights.fold(0.0, f64::max);
        (blocks, highest)
    }

    /// Returns the size `[width, height]` of all square panels together: at most `sheet`, with panels of at most the side `panel`. All are in units
    /// of the picture.
    pub fn natural(&self, sheet: [f64; 2], panel: f64) -> [f64; 2] {
        let counts = self.counts.map(|count| count as f64);
        let pitch = panel.min(sheet[0] / counts[0]).min(sheet[1] / counts[1]);
        let width = pitch * counts[0] - gap(pitch);
        [width, self.height(width)]
    }

    /// Returns the height of all square panels together if their width together is `width`, both in units of the picture.
    pub fn height(&self, width: f64) -> f64 {
        let [columns, rows] = self.counts.map(|count| count as f64);
        let gap = gap(width / (columns - GAP));
        let side = (width + gap) / columns - gap;
        rows * (side + gap + self.labels(side).1) - gap
    }

    /// Returns the grid with panels sized for an area `[width, height]`, in units of the picture.
    pub fn in_area(self, area: [f64; 2]) -> Self {
        let counts = self.counts.map(|count| count as f64);
        let gap_in = |axis: usize, taken: f64| match self.is_sheet() {
            true => gap((area[axis] - taken) / (counts[axis] - GAP)).max(0.0),
            false => 0.0,
        };
        let across = gap_in(0, 0.0);
        let (labels, highest) = self.labels((area[0] + across) / counts[0] - across);
        let gap = across.min(gap_in(1, counts[1] * highest));
        let pitch = [0, 1].map(|axis| (area[axis] + gap) / counts[axis]);
        Self { pitch, gap, labels, highest, ..self }
    }

    /// Returns the middle of the panels at an index `place` along an `axis`, as a fraction of the area `[width, height]`.
    pub fn middle(&self, axis: usize, place: usize, area: [f64; 2]) -> f64 {
        let panel = self.pitch[axis] - self.gap;
        (self.pitch[axis] * place as f64 + 0.5 * panel) / area[axis]
    }

    /// Returns the area of the panel with this `index`, where `body` is the area of all panels.
    pub fn area(&self, body: Area, index: usize) -> Area {
        let [columns, rows] = self.counts;
        let [column, row] = [index % columns, index / columns];
        // Along an axis, panels stand upwards; in rows of one axis, they are read from the top.
        let from_top = if self.has_labels() { row } else { rows - 1 - row };
        let left = body.left + self.pitch[0] * column as f64;
        let top = body.top + self.pitch[1] * from_top as f64 + self.highest;
        let [width, height] = self.pitch.map(|pitch| pitch - self.gap);
        Area::new([left, top], [width, height - self.highest])
    }

    /// Draws the label of the panel with this `index` above the panel's `area`; nothing without a label.
    pub fn draw_label(&self, picture: &mut Picture, area: Area, index: usize) {
        if let Some(label) = self.labels.get(index) {
            let [x, y] = area.point(0.5, 1.0);
            let at = [x, y - 0.5 * LABEL - label.below_first()];
            picture.block(label, at, Anchor::Centre);
        }
    }
}

/// The gap between panels at this distance.
fn gap(pitch: f64) -> f64 {
    (GAP * pitch).min(LARGEST_GAP)
}
