//! Ticks and labels around the body of a plot or a heat map.

use super::heading::{LABEL, TICK};
use super::spacing::Spacing;
use super::ticks::Tick;
use crate::picture::palette::INK;
use crate::picture::text::TextBlock;
use crate::picture::{Anchor, Area, Pen, Picture};

/// Width of the lines of frames and ticks, in pixels.
pub const FRAME: f64 = 1.5;

/// Space beside a body without ticks and label.
const FREE: f64 = 16.0;

/// Ticks and labels of the two axes of a plot or a heat map.
pub struct Axes {
    x_ticks: Vec<Tick>,
    y_ticks: Vec<Tick>,
    x_label: TextBlock,
    y_label: TextBlock,
    spacing: Spacing,
}

impl Axes {
    /// Lays out the ticks and the label of both axes, x first, for a body of this width and height in pixels. Labels may be empty.
    pub fn new(
        [(x_ticks, x_label), (y_ticks, y_label)]: [(Vec<Tick>, &str); 2],
        [width, height]: [f64; 2],
        spacing: Spacing,
    ) -> Self {
        Self {
            x_ticks,
            y_ticks,
            x_label: TextBlock::new(x_label, LABEL, width),
            y_label: TextBlock::new(y_label, LABEL, height),
            spacing,
        }
    }

    /// Returns the width that tick labels take to the left and right of the body, in pixels: `[left, right]`.
    pub fn sides(&self) -> [f64; 2] {
        let widest = self.y_ticks.iter().map(|tick| tick.width);
        let widest = widest.fold(0.0, f64::max);
        if is_bare(&self.y_ticks, &self.y_label) && is_bare(&self.x_ticks, &self.x_label) {
            return [FREE; 2];
        }
        let beside = self.spacing.y_label + self.y_label.below_first() + 0.6 * LABEL + 16.0;
        let last = self.x_ticks.last();
        let end = last.map_or(0.0, |last| 0.5 * last.width);
        [beside + widest + 15.0, end + 8.0]
    }

    /// Returns the height that ticks and label take below the body, in pixels.
    pub fn below(&self) -> f64 {
        match is_bare(&self.x_ticks, &self.x_label) {
            true => 2.0 * FREE,
            false => self.spacing.below + self.x_label.below_first(),
        }
    }

    /// Draws the axes around `body`, with `left` pixels of space to its left. Labels that would overlap are left out.
    pub fn draw(&self, picture: &mut Picture, body: Area, left: f64) {
        let pen = Pen::solid(FRAME, INK);
        let mut free = f64::NEG_INFINITY;
        for tick in &self.x_ticks {
            let [x, y] = body.point(tick.at, 0.0);
            picture.polyline(&[[x, y], [x, y + 8.0]], pen);
            if x - 0.5 * tick.width > free {
                picture.text(&tick.label, [x, y + 26.0], TICK, Anchor::Centre);
                free = x + 0.5 * tick.width + 10.0;
            }
        }
        let mut free = f64::INFINITY;
        for tick in &self.y_ticks {
            let [x, y] = body.point(0.0, tick.at);
            picture.polyline(&[[x - 8.0, y], [x, y]], pen);
            if y < free {
                picture.text(&tick.label, [x - 15.0, y], TICK, Anchor::Right);
                free = y - TICK;
            }
        }
        let [x, y] = body.point(0.5, 0.0);
        picture.block(&self.x_label, [x, y + self.spacing.x_label], Anchor::Centre);
        let [x, y] = body.point(0.0, 0.5);
        picture.block(&self.y_label, [x - left + self.spacing.y_label, y], Anchor::Upwards);
    }
}

/// Returns true for an axis without texts.
fn is_bare(ticks: &[Tick], label: &TextBlock) -> bool {
    ticks.iter().all(|tick| tick.label.is_empty()) && label.lines.iter().all(String::is_empty)
}
