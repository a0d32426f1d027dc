//! What colour a value gets, and what the reader of the picture is told about it.

use super::palette::{self, Fill};
use super::{Error, axis, boundary};
use crate::store::{Samples, StoredMap};
use std::collections::BTreeMap;

/// How the values of a channel are shown.
#[derive(Debug)]
pub(super) enum Shading {
    /// Codes that have names.
    Names(Names),
    /// Quantities.
    Scale(Scale),
}

/// Named codes.
#[derive(Debug)]
pub(super) struct Names {
    fills: BTreeMap<u32, Fill>,
    /// Name and fill of what occurs in the map.
    pub(super) present: Vec<(String, Fill)>,
    /// The detachment boundary is drawn over them, and there is one.
    pub(super) boundary: bool,
}

/// A range of quantities.
#[derive(Debug)]
pub(super) struct Scale {
    /// The ends of the colour bar; `None` where no cell has a value.
    pub(super) range: Option<[f64; 2]>,
    /// Some cells have no value.
    pub(super) blanks: bool,
    diverging: bool,
    /// Only whole numbers occur.
    whole: bool,
    /// What is shown, with its unit.
    pub(super) label: String,
}

impl Shading {
    /// Decides from the whole map, so that the panels of an atlas can be compared.
    pub(super) fn of(map: &StoredMap, channel: &str) -> Result<Self, Error> {
        let (names, cells) = match channel {
            "regime" => (map.regime_names(), &map.counts().regimes),
            "status" => (map.status_names(), &map.counts().statuses),
            _ => return Ok(Self::Scale(Scale::of(map, channel)?)),
        };
        let fills: BTreeMap<u32, Fill> = names
            .keys()
            .enumerate()
            .map(|(place, &code)| match channel {
                "regime" => (code, palette::regime(code)),
                _ => (code, palette::qualitative(place)),
            })
            .collect();
        let present = names
            .iter()
            .filter(|(_, name)| cells.get(*name).is_some_and(|cells| *cells > 0))
            .map(|(code, name)| (name.clone(), fills[code]))
            .collect();
        let boundary = channel == "regime" && has_boundary(map)?;
        Ok(Self::Names(Names {
            fills,
            present,
            boundary,
        }))
    }

    /// The fill of a cell.
    pub(super) fn fill(&self, value: f64) -> Fill {
        match self {
            // Codes are stored as u32, so the conversion is exact.
            Self::Names(names) => {
                let fill = names.fills.get(&(value as u32));
                fill.copied().unwrap_or(palette::regime(u32::MAX))
            }
            Self::Scale(scale) => scale.fill(value),
        }
    }
}

impl Scale {
    fn of(map: &StoredMap, channel: &str) -> Result<Self, Error> {
        let (mut blanks, mut whole) = (false, false);
        let mut range: Option<[f64; 2]> = None;
        for index in 0..map.layout().panels() {
            let samples = map.read_panel(channel, index)?;
            whole = matches!(samples, Samples::U32(_));
            for value in samples.values() {
                if value.is_finite() {
                    let [low, high] = range.unwrap_or([value, value]);
                    range = Some([low.min(value), high.max(value)]);
                } else {
                    blanks = true;
                }
            }
        }
        let diverging = range.is_some_and(|[low, high]| low < 0.0 && high > 0.0);
        Ok(Self {
            range: range.map(|range| widened(range, diverging)),
            blanks,
            diverging,
            whole,
            label: label(channel),
        })
    }

    /// The fill of a value; `fill(range[0])` is one end of the colour bar.
    pub(super) fn fill(&self, value: f64) -> Fill {
        match self.range {
            Some([low, high]) if value.is_finite() => {
                let at = (value - low) / (high - low);
                Fill::plain(if self.diverging {
                    palette::diverging(at)
                } else {
                    palette::sequential(at)
                })
            }
            _ => Fill::BLANK,
        }
    }

    /// About `wanted` values to label on the colour bar.
    pub(super) fn ticks(&self, wanted: f64) -> Vec<f64> {
        let ticks = |range| axis::round_ticks(range, wanted);
        let mut ticks = self.range.map_or_else(Vec::new, ticks);
        ticks.retain(|tick| !self.whole || tick.fract() == 0.0);
        ticks
    }
}

/// Whether any panel shows a stretch of the detachment boundary.
fn has_boundary(map: &StoredMap) -> Result<bool, Error> {
    for index in 0..map.layout().panels() {
        let margin_deg = map.read_panel("margin_deg", index)?;
        if !boundary::segments(map.grid(), &margin_deg).is_empty() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The ends of a colour bar: symmetric about 0 for both signs, never equal.
fn widened([low, high]: [f64; 2], diverging: bool) -> [f64; 2] {
    if diverging {
        let most = high.max(-low);
        [-most, most]
    } else if low < high {
        [low, high]
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
