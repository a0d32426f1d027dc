//! Colour scales of heat maps, and the colour bar.

use super::summary::ValueSummary;
use crate::frame::axes::FRAME;
use crate::frame::heading::{LABEL, LegendEntry, TICK};
use crate::frame::ticks::{self, Tick};
use crate::frame::units;
use crate::picture::palette::{self, Fill, INK};
use crate::picture::{Anchor, Area, Pen, Picture};

/// Width of the space for the colour bar, to the right of the picture's body, in pixels.
pub const BAR_ROOM: f64 = 190.0;

/// Options of a colour scale: label, range, and linear or logarithmic.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScaleOptions {
    /// Label of the colour bar. A label that ends in a known unit changes to the unit in which the values read best.
    pub label: String,
    /// Name in the legend of cells whose value is not finite.
    pub blank: String,
    /// True if the colour scale is logarithmic. Values at or below 0 are blank; without a range, the colour bar starts at the 1st
    /// percentile of the positive values.
    pub log: bool,
    /// Ends `[low, high]` of the colour bar, in the unit of the values; values beyond them take the colours of the ends. `None` for the
    /// extent of the values.
    pub range: Option<[f64; 2]>,
    /// True if the values are counts, so that ticks of the colour bar are at whole numbers only.
    pub whole: bool,
}

/// The reason why a colour scale is impossible; the message says what is allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScaleError {
    /// The ends of the colour bar are not finite, or not in increasing order.
    #[error("range {}: must be two finite numbers, the smaller one first", ends(.0))]
    Range([f64; 2]),
    /// The range of a logarithmic colour scale begins at or below 0.
    #[error("range {}: must begin above 0 on a logarithmic scale", ends(.0))]
    LogarithmicRange([f64; 2]),
    /// The colour scale is logarithmic, and no value is above 0.
    #[error("no cell has a value above 0 for a logarithmic scale; choose a linear one")]
    NoPositiveValue,
}

/// Writes the ends of a range with the fewest digits that identify them.
fn ends(range: &[f64; 2]) -> String {
    let digits = |end: &f64| format!("{end:?}").trim_end_matches(".0").to_owned();
    range.each_ref().map(digits).join(",")
}

/// A colour scale, common to all panels of a heat map.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourScale {
    /// Ends `[low, high]` of the colour bar, in the unit of the values; `None` if no cell has a value.
    pub(super) range: Option<[f64; 2]>,
    /// Legend entries for cells whose colour is not on the colour bar, `[entry]`.
    pub(super) legend: Vec<LegendEntry>,
    options: ScaleOptions,
}

impl ColourScale {
    /// Chooses a colour scale for the summarised values.
    ///
    /// # Errors
    /// The range is not two finite numbers in increasing order. Or the scale is logarithmic, and its range begins at or below 0, or no
    /// value is above 0.
    pub fn new(summary: &ValueSummary, options: ScaleOptions) -> Result<Self, ScaleError> {
        let log = options.log;
        if let Some(range) = options.range {
            check(range, log)?;
        }
        let extent = if log {
            summary.positive
        } else {
            summary.extent
        };
        if log && extent.is_none() {
            return Err(ScaleError::NoPositiveValue);
        }
        let mut blank = Vec::new();
        if summary.has_blanks {
            blank.push(options.blank.clone());
        }
        if log && summary.not_positive > 0 {
            blank.push(format!("\u{2264} 0 (cells: {})", summary.not_positive));
        }
        let mut legend = Vec::new();
        if !blank.is_empty() {
            legend.push(LegendEntry::swatch(Fill::BLANK, blank.join(", or ")));
        }
        let mut range = extent;
        if log && options.range.is_none() {
            let (start, below) = summary.positive_start();
            range = range.map(|[low, high]| [start.max(low), high]);
            if below > 0 {
                let lowest = Fill::plain(palette::sequential(0.0));
                let name = format!("> 0, below the scale (cells: {below})");
                legend.push(LegendEntry::swatch(lowest, name));
            }
        }
        Ok(Self {
            range: options.range.or(range.map(|range| widened(range, log))),
            legend,
            options,
        })
    }

    pub(super) fn fill(&self, value: f64) -> Fill {
        match self.range {
            Some(range) if value.is_finite() && !(self.options.log && value <= 0.0) => {
                colour(range, self.fraction(range, value))
            }
            _ => Fill::BLANK,
        }
    }

    /// The fraction of the colour bar below a value.
    fn fraction(&self, range: [f64; 2], value: f64) -> f64 {
        if self.options.log {
            ticks::fraction(range.map(f64::ln), value.ln())
        } else {
            ticks::fraction(range, value)
        }
    }

    /// Ticks of a bar of this height, in a unit that is `unit` units of the values.
    fn ticks(&self, range: [f64; 2], unit: f64, height: f64) -> Vec<Tick> {
        let wanted = (height / 60.0).clamp(4.0, 8.0);
        let shown = range.map(|end| end / unit);
        if self.options.log {
            let values = ticks::logarithmic(shown, wanted);
            // The smallest end may be 0 in a larger unit.
            let at = |value: f64| self.fraction(range, value * unit);
            let tick = |value: &f64| Tick::of_power(at(*value), *value);
            return values.iter().map(tick).collect();
        }
        let mut values = ticks::round(shown, wanted);
        values.retain(|value| !self.options.whole || value.fract() == 0.0);
        ticks::at(&values, shown)
    }

    /// Draws the colour bar of the scale to the right of `body`.
    pub(super) fn draw_bar(&self, picture: &mut Picture, body: Area) {
        let Some(range) = self.range else {
            return;
        };
        let height = body.height.min(900.0);
        let top = body.top + 0.5 * (body.height - height);
        let bar = Area::new([body.right() + 36.0, top], [30.0, height]);
        picture.raster(bar, |_, up| colour(range, up));
        picture.frame(bar, FRAME);
        let largest = range[0].abs().max(range[1].abs());
        let (label, unit) = units::readable(&self.options.label, largest);
        for tick in self.ticks(range, unit, height) {
            let [x, y] = bar.point(1.0, tick.at);
            picture.polyline(&[[x, y], [x + 7.0, y]], Pen::solid(FRAME, INK));
            picture.text(&tick.label, [x + 13.0, y], TICK, Anchor::Left);
        }
        let middle = [body.right() + BAR_ROOM - 24.0, bar.top + 0.5 * bar.height];
        picture.text(&label, middle, LABEL, Anchor::Upwards);
    }
}

/// The colour at a fraction of the bar, clamped to its ends. White is 0 where both signs occur.
fn colour([low, high]: [f64; 2], at: f64) -> Fill {
    let at = at.clamp(0.0, 1.0);
    Fill::plain(if low < 0.0 && high > 0.0 {
        let value = low + at * (high - low);
        palette::diverging(0.5 + 0.5 * value / high.max(-low))
    } else {
        palette::sequential(at)
    })
}

fn check(range: [f64; 2], log: bool) -> Result<(), ScaleError> {
    let [low, high] = range;
    // A difference that is finite and above 0 has two finite ends.
    if !(high - low).is_normal() || low > high {
        Err(ScaleError::Range(range))
    } else if log && low <= 0.0 {
        Err(ScaleError::LogarithmicRange(range))
    } else {
        Ok(())
    }
}

/// Makes the ends of a colour bar symmetric about 0 if both signs occur, and different from each other.
fn widened([low, high]: [f64; 2], log: bool) -> [f64; 2] {
    if low < 0.0 && high > 0.0 {
        let most = high.max(-low);
        [-most, most]
    } else if low < high {
        [low, high]
    } else if log {
        [low / 1.1, high * 1.1]
    } else {
        let room = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
        [low - room, high + room]
    }
}
