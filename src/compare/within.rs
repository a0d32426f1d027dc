//! Largest differences that two maps may have.

use super::{MapComparison, QuantityComparison};
use crate::input::{Quantity, did_you_mean};
use crate::plan::{Channels, STATE_CHANNELS, channel_names};
use std::str::FromStr;

/// Channels of codes: the number of cells that may differ is given.
const CODES: [&str; 2] = ["regime", "status"];

/// Largest allowed differences of two maps: relative for all states, absolute for named channels.
///
/// ```
/// use whiskmap::compare::Within;
///
/// let within: Within = "1e-6,force_un=0.1,regime=3".parse()?;
/// assert!("force=0.1".parse::<Within>().is_err());
/// assert!("-1".parse::<Within>().is_err());
/// assert!("regime=1.5".parse::<Within>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Within {
    /// Allowed difference of channels of states and of `margin_deg`, as a fraction of the channel's largest value.
    relative: Option<f64>,
    /// Allowed difference of single channels, in the channel's unit; of `regime` and `status`, the number of cells that may differ.
    absolute: Vec<(&'static str, f64)>,
}

impl Within {
    /// Returns the names of single channels with an allowed difference.
    pub fn channels(&self) -> impl Iterator<Item = &'static str> {
        self.absolute.iter().map(|(name, _)| *name)
    }

    /// Returns the names of the channels that differ by more than is allowed. Regimes may not differ unless `regime=N` allows N cells; as
    /// many cells may have a state in only one map.
    #[must_use]
    pub fn exceeded(&self, comparison: &MapComparison) -> Vec<&'static str> {
        let codes = comparison.codes.iter().filter(|code| {
            let allowed = self.cells(code.channel);
            allowed.is_some_and(|allowed| code.differing as f64 > allowed)
        });
        let quantities = comparison.quantities.iter().filter(|quantity| {
            let allowed = self.allowed(quantity);
            let one_sided = quantity.only_in.iter().sum::<u64>() as f64;
            allowed.is_some_and(|allowed| {
                quantity.beyond_rounding > allowed
                    || one_sided > self.cells("regime").unwrap_or(0.0)
            })
        });
        let codes = codes.map(|code| code.channel);
        codes.chain(quantities.map(|quantity| quantity.channel)).collect()
    }

    fn named(&self, channel: &str) -> Option<f64> {
        let mut named = self.absolute.iter();
        named.find_map(|(name, value)| (*name == channel).then_some(*value))
    }

    /// The number of cells that may differ in a channel of codes; `None` for any number.
    fn cells(&self, channel: &str) -> Option<f64> {
        let by_default = self.relative.filter(|_| channel == "regime").map(|_| 0.0);
        self.named(channel).or(by_default)
    }

    /// The allowed difference of a channel in its unit; `None` for any difference.
    fn allowed(&self, quantity: &QuantityComparison) -> Option<f64> {
        let is_exact =
            STATE_CHANNELS.contains(&quantity.channel) || quantity.channel == "margin_deg";
        let relative = self.relative.filter(|_| is_exact);
        let relative = relative.map(|relative| relative * quantity.largest_value);
        self.named(quantity.channel).or(relative)
    }
}

impl FromStr for Within {
    type Err = String;

    /// Parses `N` for all channels of states and `NAME=N` for single channels, with commas between them.
    fn from_str(list: &str) -> Result<Self, String> {
        let (mut relative, mut absolute) = (None, Vec::new());
        for entry in list.split(',').map(str::trim) {
            let refused = |why: String| format!("`{entry}`: {why}");
            let (name, number) = entry.split_once('=').unwrap_or(("", entry));
            let number = Quantity::of(name).parse(number).map_err(refused)?;
            if number < 0.0 {
                return Err(refused("must be at least 0".to_owned()));
            }
            if CODES.contains(&name.trim()) && number.fract() != 0.0 {
                return Err(refused("must be a whole number of cells".to_owned()));
            }
            let is_new = if entry.contains('=') {
                let found = channel_names().find(|channel| *channel == name.trim());
                let name = found.ok_or_else(|| {
                    let hint = did_you_mean(name, channel_names());
                    refused(format!("must be one of the channels, {}{hint}", Channels::STANDARD))
                })?;
                let is_new = absolute.iter().all(|(other, _)| *other != name);
                absolute.push((name, number));
                is_new
            } else {
                relative.replace(number).is_none()
            };
            if !is_new {
                return Err(refused("must be given once".to_owned()));
            }
        }
        Ok(Self { relative, absolute })
    }
}
