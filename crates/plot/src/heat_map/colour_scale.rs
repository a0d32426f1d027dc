//! Colour scales of heat maps, and the colour bar.

use super::summary::ValueSummary;
use crate::frame::axes::FRAME;
use crate::frame::heading::{LABEL, LegendEntry, TICK};
use crate::frame::ticks::{self, Tick};
use crate::frame::units;
use crate::picture::palette::{self, Fill, INK};
use crate::picture::text::TextBlock;
use crate::picture::{Anchor, Area, Pen, Picture};

/// Distance of the colour bar from the body, and its width, in pixels.
const BAR: [f64; 2] = [32.0, 28.0];
/// Largest height of the colour bar, in pixels.
const BAR_HEIGHT: f64 = 900.0;
/// Distance of tick labels from the colour bar, in pixels.
const BESIDE: f64 = 13.0;
/// Ratio of the largest to the smallest value above which a scale becomes logarithmic by itself.
const DECADES: f64 = 100.0;

/// Options of a colour scale: label, range, and linear or logarithmic.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScaleOptions {
    /// Label of the colour bar. A label that ends in a known unit changes to the unit in which the values read best.
    pub label: String,
    /// Name in the legend of cells whose value is not finite.
    pub blank: String,
    /// True if the colour scale is logarithmic: values at or below 0 are blank; without a range, the colour bar starts at the 1st
    /// percentile of the positive values. `None` for a logarithmic scale if no value is negative and the colour bar would span more than
    /// two decades, and a linear one otherwise.
    pub log: Option<bool>,
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
    #[error("range {}: must be two finite numbers with a finite difference, the smaller one first", ends(.0))]
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
    /// True if the scale is logarithmic.
    log: bool,
    options: ScaleOptions,
}

impl ColourScale {
    /// Returns true if the scale is logarithmic.
    #[must_use]
    pub const fn is_log(&self) -> bool {
        self.log
    }

    /// Chooses a colour scale for the summarised values.
    ///
    /// # Errors
    /// The range is not two finite numbers in increasing order. Or the scale is logarithmic, and its range begins at or below 0, or no
    /// value is above 0.
    pub fn new(summary: &ValueSummary, options: ScaleOptions) -> Result<Self, ScaleError> {
        let log = options.log.unwrap_or_else(|| spans_decades(summary, options.range));
        if let Some(range) = options.range {
            check(range, log)?;
        }
        let extent = if log { summary.positive } else { summary.extent };
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
            log,
            options,
        })
    }

    pub(super) fn fill(&self, value: f64) -> Fill {
        match self.range {
            Some(range) if value.is_finite() && !(self.log && value <= 0.0) => {
                colour(range, self.fraction(range, value))
            }
            _ => Fill::BLANK,
        }
    }

    /// The fraction of the colour bar below a value.
    fn fraction(&self, range: [f64; 2], value: f64) -> f64 {
        if self.log {
            ticks::fraction(range.map(f64::ln), value.ln())
        } else {
            ticks::fraction(range, value)
        }
    }

    /// Ticks of a bar of this height, in a unit that is `unit` units of the values.
    fn ticks(&self, range: [f64; 2], unit: f64, height: f64) -> Vec<Tick> {
        let wanted = (height / 60.0).clamp(4.0, 8.0);
        let shown = range.map(|end| end / unit);
        if self.log {
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

    /// The ticks and the label of a bar beside a body of this height, and the distance of the label's middle from the body; `None`
    /// without a bar.
    fn bar(&self, height: f64) -> Option<(Vec<Tick>, TextBlock, f64)> {
        let range = self.range?;
        let height = height.min(BAR_HEIGHT);
        let largest = range[0].abs().max(range[1].abs());
        let (label, unit) = units::readable(&self.options.label, largest);
        let ticks = self.ticks(range, unit, height);
        let widest = ticks.iter().map(|tick| tick.width).fold(0.0, f64::max);
        let beside = BAR[0] + BAR[1] + BESIDE + widest + 0.6 * LABEL + 12.0;
        Some((ticks, TextBlock::new(&label, LABEL, height), beside))
    }

    /// Returns the width of the space for the colour bar beside a body of this height, in pixels; `None` without a bar.
    pub(super) fn bar_room(&self, height: f64) -> Option<f64> {
        let (_, label, beside) = self.bar(height)?;
        Some(beside + label.below_first() + 0.6 * LABEL + 8.0)
    }

    /// Draws the colour bar of the scale to the right of `body`.
    pub(super) fn draw_bar(&self, picture: &mut Picture, body: Area) {
        let (Some(range), Some((ticks, label, beside))) = (self.range, self.bar(body.height))
        else {
            return;
        };
        let height = body.height.min(BAR_HEIGHT);
        let top = body.top + 0.5 * (body.height - height);
        let bar = Area::new([body.right() + BAR[0], top], [BAR[1], height]);
        picture.raster(bar, |_, up| colour(range, up));
        picture.frame(bar, FRAME);
        for tick in ticks {
            let [x, y] = bar.point(1.0, tick.at);
            picture.polyline(&[[x, y], [x + 7.0, y]], Pen::solid(FRAME, INK));
            picture.text(&tick.label, [x + BESIDE, y], TICK, Anchor::Left);
        }
        let middle = [body.right() + beside, bar.top + 0.5 * bar.height];
        picture.block(&label, middle, Anchor::Upwards);
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

/// Returns true if no value is negative, and the colour bar of a logarithmic scale would span more than two decades.
fn spans_decades(summary: &ValueSummary, range: Option<[f64; 2]>) -> bool {
    let ends = range.or_else(|| Some([summary.positive_start().0, summary.positive?[1]]));
    let is_negative = summary.extent.is_some_and(|[low, _]| low < 0.0);
    !is_negative && ends.is_some_and(|[low, high]| low > 0.0 && high > DECADES * low)
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
