//! Colours of quantities, and the bar that explains them.

use super::histogram::Histogram;
use super::options::MapOptions;
use crate::classify::Status;
use crate::render::error::Error;
use crate::render::heading::{LABEL, TICK};
use crate::render::palette::{self, Fill, INK};
use crate::render::picture::{Anchor, Area, Pen, Picture};
use crate::render::ticks::{self, Tick};
use crate::render::{axes, units};
use crate::scene::digits;
use crate::store::{STATE_CHANNELS, Samples, Slice};

/// Room that the colour bar takes to the right of the picture's body.
pub(super) const BAR_ROOM: f64 = 190.0;

/// How quantities are shown.
#[derive(Debug)]
pub(super) struct Scale {
    /// The ends of the colour bar; `None` where no cell has a value.
    pub(super) range: Option<[f64; 2]>,
    /// What the cells are whose colour the bar does not explain.
    pub(super) legend: Vec<(Fill, String)>,
    /// Whether there are states that are off, which are hatched.
    pub(super) has_marks: bool,
    log: bool,
    /// Only whole numbers occur.
    whole: bool,
    channel: String,
}

impl Scale {
    /// Decides from the whole map, so that the panels of an atlas can be compared.
    pub(super) fn of(map: &Slice, channel: &str, options: &MapOptions<'_>) -> Result<Self, Error> {
        let log = options.log;
        if let Some(range) = options.range {
            check(range, log)?;
        }
        let (mut none, mut below, mut whole) = (false, 0_u64, false);
        let mut extent: Option<[f64; 2]> = None;
        let mut positive = Histogram::default();
        for index in 0..map.layout().panels() {
            let samples = map.read_panel(channel, index)?;
            whole = matches!(samples, Samples::U32(_));
            for value in samples.values() {
                if !value.is_finite() {
                    none = true;
                } else if log && value <= 0.0 {
                    below += 1;
                } else {
                    let [low, high] = extent.unwrap_or([value, value]);
                    extent = Some([low.min(value), high.max(value)]);
                    if log {
                        positive.add(value);
                    }
                }
            }
        }
        if log && extent.is_none() {
            return Err(Error::Scale(format!(
                "a logarithmic scale of `{channel}`: no cell has a value above 0; draw it on a linear one"
            )));
        }
        let below = (below > 0).then(|| format!("\u{2264} 0 (cells: {below})"));
        let none = none.then(|| "no contact".to_owned());
        let blank: Vec<String> = none.into_iter().chain(below).collect();
        let blank = (!blank.is_empty()).then(|| (Fill::BLANK, blank.join(", or ")));
        let cut = extent.filter(|_| log && options.range.is_none());
        let cut = cut.map(|[low, high]| {
            let (start, cells) = positive.start();
            ([start.max(low), high], cells)
        });
        let few = cut.filter(|(_, cells)| *cells > 0).map(|(_, cells)| {
            let lowest = Fill::plain(palette::sequential(0.0));
            (lowest, format!("> 0, below the scale (cells: {cells})"))
        });
        let has_marks = has_marks(map, channel)?;
        let marks = has_marks.then(|| {
            let off = "off: friction is not as assumed";
            (Fill::BLANK.hatched(), off.to_owned())
        });
        let extent = cut.map(|(extent, _)| extent).or(extent);
        Ok(Self {
            range: options.range.or(extent.map(|extent| widened(extent, log))),
            legend: blank.into_iter().chain(few).chain(marks).collect(),
            has_marks,
            log,
            whole,
            channel: channel.to_owned(),
        })
    }

    /// The fill of a value.
    pub(super) fn fill(&self, value: f64) -> Fill {
        match self.range {
            Some(range) if value.is_finite() && !(self.log && value <= 0.0) => {
                self.colour(range, self.fraction(range, value))
            }
            _ => Fill::BLANK,
        }
    }

    /// Where a value lies along the colour bar.
    fn fraction(&self, range: [f64; 2], value: f64) -> f64 {
        if self.log {
            ticks::fraction(range.map(f64::ln), value.ln())
        } else {
            ticks::fraction(range, value)
        }
    }

    /// The colour at a fraction of the bar, which has an end on either side. White is 0 where both signs occur.
    fn colour(&self, [low, high]: [f64; 2], at: f64) -> Fill {
        let at = at.clamp(0.0, 1.0);
        Fill::plain(if low < 0.0 && high > 0.0 {
            let value = low + at * (high - low);
            palette::diverging(0.5 + 0.5 * value / high.max(-low))
        } else {
            palette::sequential(at)
        })
    }

    /// Ticks of a bar of this height, for a unit that is `unit` of the channel's own.
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
        values.retain(|value| !self.whole || value.fract() == 0.0);
        ticks::at(&values, shown)
    }

    /// Draws the colour bar to the right of `body`.
    pub(super) fn bar(&self, picture: &mut Picture, body: Area) {
        let Some(range) = self.range else {
            return;
        };
        let height = body.height.min(900.0);
        let top = body.top + 0.5 * (body.height - height);
        let bar = Area::new([body.right() + 36.0, top], [30.0, height]);
        picture.raster(bar, |_, up| self.colour(range, up));
        picture.frame(bar, axes::FRAME);
        let largest = range[0].abs().max(range[1].abs());
        let (label, unit) = units::readable(&label(&self.channel), largest);
        for tick in self.ticks(range, unit, height) {
            let [x, y] = bar.point(1.0, tick.at);
            picture.polyline(&[[x, y], [x + 7.0, y]], Pen::solid(axes::FRAME, INK));
            picture.text(&tick.label, [x + 13.0, y], TICK, Anchor::Left);
        }
        let middle = [body.right() + BAR_ROOM - 24.0, bar.top + 0.5 * bar.height];
        picture.text(&label, middle, LABEL, Anchor::Upwards);
    }
}

/// Whether `channel` is of states, some of which `status` marks as off.
fn has_marks(map: &Slice, channel: &str) -> Result<bool, Error> {
    if !STATE_CHANNELS.contains(&channel) || !map.channels().contains(&"status") {
        return Ok(false);
    }
    Ok(map.codes("status")?.into_iter().any(is_mark))
}

/// Whether this is the code of a status that marks a state as off.
pub(super) fn is_mark(code: u32) -> bool {
    Status::MARKS.iter().any(|status| status.code() == code)
}

/// Whether the ends of a colour bar can be what they are.
fn check([low, high]: [f64; 2], log: bool) -> Result<(), Error> {
    let refuse = |what: &str| {
        let [low, high] = [low, high].map(digits);
        Err(Error::Scale(format!("range {low},{high}: {what}")))
    };
    // A difference that is finite and above 0 has two finite ends.
    if !(high - low).is_normal() || low > high {
        refuse("must be two finite numbers, the smaller one first")
    } else if log && low <= 0.0 {
        refuse("must begin above 0 on a logarithmic scale")
    } else {
        Ok(())
    }
}

/// The ends of a colour bar: symmetric about 0 for both signs, never equal.
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

/// A channel's name as words, with the unit that its last word stands for.
fn label(channel: &str) -> String {
    const UNITS: [(&str, &str); 5] = [
        ("_mm", "mm"),
        ("_deg", "deg"),
        ("_un", "\u{b5}N"),
        ("_nnm", "nN m"),
        ("_nj", "nJ"),
    ];
    let unit = UNITS.iter().find_map(|(suffix, unit)| {
        let name = channel.strip_suffix(suffix)?;
        Some(format!("{} ({unit})", name.replace('_', " ")))
    });
    unit.unwrap_or_else(|| channel.replace('_', " "))
}
