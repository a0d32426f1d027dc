//! Significant decimal digits of the stored quantities.

use super::{Channel, Channels, channel_names};
use crate::input::did_you_mean;
use std::fmt;
use std::str::FromStr;

/// Bits of the mantissa of an `f32`.
const MANTISSA_BITS: u32 = 23;

/// Minimum and maximum number of digits; the maximum stores all bits of an `f32`.
const LIMITS: [u8; 2] = [2, 7];

/// Significant decimal digits of each channel of quantities in a file.
///
/// ```
/// use whiskmap::plan::Digits;
///
/// let digits: Digits = "5,force_un=3".parse()?;
/// assert_eq!(digits.mantissa_bits("force_un"), Some(10));
/// assert_eq!(digits.mantissa_bits("energy_nj"), Some(17));
/// assert_eq!(digits.mantissa_bits("regime"), None);
/// assert!("9".parse::<Digits>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digits {
    /// Digits of single channels: `[channel]`, in the order of [`Channel::ALL`].
    named: [Option<u8>; Channel::ALL.len()],
    /// Digits of the other channels.
    others: u8,
}

impl Digits {
    /// All bits of every channel.
    pub const ALL: Self = Self { named: [None; Channel::ALL.len()], others: LIMITS[1] };

    /// Names each of `channels` that is rounded; all bits of other channels are kept.
    #[must_use]
    pub fn of(self, channels: Channels) -> Self {
        let is_rounded = |name| channels.contains(name) && self.mantissa_bits(name).is_some();
        let mut named = self.named;
        for (digits, channel) in named.iter_mut().zip(Channel::ALL) {
            *digits = is_rounded(channel.name()).then_some(digits.unwrap_or(self.others));
        }
        Self { named, ..Self::ALL }
    }

    /// Returns the number of mantissa bits to which the channel `name` is rounded; `None` if it is stored with all bits.
    ///
    /// `n` bits have a relative error of at most `2^-(n + 1)`. Half a unit of digit `N` is at least `10^-N / 2` of the value, so
    /// `n` is `N log2(10)`, rounded up.
    #[must_use]
    pub fn mantissa_bits(&self, name: &str) -> Option<u32> {
        let place = Channel::of(name)? as usize;
        let digits = u32::from(self.named[place].unwrap_or(self.others));
        let bits = 10_u32.pow(digits).next_power_of_two().ilog2();
        (bits < MANTISSA_BITS).then_some(bits)
    }

    /// Returns the first channel that has digits of its own, but is not one of `channels`; `None` without one.
    #[must_use]
    pub fn not_in(&self, channels: Channels) -> Option<&'static str> {
        let mut named = self.named();
        named.find_map(|(name, _)| (!channels.contains(name)).then_some(name))
    }

    /// Names and digits of single channels.
    fn named(&self) -> impl Iterator<Item = (&'static str, u8)> {
        let all = Channel::ALL.into_iter().zip(self.named);
        all.filter_map(|(channel, digits)| Some((channel.name(), digits?)))
    }
}

/// Rounds `value` to the nearest number with `bits` bits of mantissa, half to even. Zeros, subnormal numbers, infinities and NaN
/// remain as they are, and so does a value that would round to infinity.
#[must_use]
#[inline]
pub fn rounded(value: f32, bits: u32) -> f32 {
    let dropped = MANTISSA_BITS - bits;
    let all = value.to_bits();
    let half = (1 << dropped >> 1) - u32::from(dropped > 0);
    let is_odd = all >> dropped & u32::from(dropped > 0);
    let nearest = f32::from_bits(all.wrapping_add(half + is_odd) >> dropped << dropped);
    if value.is_normal() && nearest.is_finite() { nearest } else { value }
}

impl fmt::Display for Digits {
    /// Writes the list that [`Digits::from_str`] parses.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let others = (self.others != LIMITS[1]).then(|| self.others.to_string());
        let named = self.named().map(|(name, digits)| format!("{name}={digits}"));
        f.write_str(&others.into_iter().chain(named).collect::<Vec<_>>().join(", "))
    }
}

impl FromStr for Digits {
    type Err = String;

    /// Parses `N` for all channels and `NAME=N` for single ones, with commas between them.
    fn from_str(list: &str) -> Result<Self, String> {
        let [least, most] = LIMITS;
        let mut named = [None; Channel::ALL.len()];
        let mut others = None;
        for entry in list.split(',').map(str::trim) {
            let (name, number) = entry.split_once('=').unwrap_or(("", entry));
            let number = number.parse().ok().filter(|number| (least..=most).contains(number));
            let number = number.ok_or_else(|| {
                format!(
                    "`{entry}`: must be N or NAME=N, N a whole number between {least} and {most}"
                )
            })?;
            let given = match Channel::of(name) {
                Some(channel) => &mut named[channel as usize],
                None if name.is_empty() && !entry.contains('=') => &mut others,
                None => return Err(refused(name)),
            };
            if given.replace(number).is_some() {
                return Err(format!("`{entry}`: must be given once"));
            }
        }
        Ok(Self { named, others: others.unwrap_or(most) })
    }
}

/// The message for a `name` that is not a channel of quantities.
fn refused(name: &str) -> String {
    let names = Channel::ALL.map(Channel::name);
    let kind = if channel_names().any(|known| known == name) {
        "is a channel that is not rounded"
    } else {
        "is no channel"
    };
    let (known, hint) = (names.join(", "), did_you_mean(name, names));
    format!("`{name}` {kind}; must be one of {known}{hint}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Half a unit of the last of `digits` decimal digits of `value`.
    fn half_unit(value: f32, digits: i32) -> f64 {
        // Rust prints the shortest digits, with the exact exponent.
        let text = format!("{:e}", f64::from(value.abs()));
        let exponent = text.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
        0.5 * 10_f64.powi(exponent.unwrap_or_default() - digits + 1)
    }

    fn check(value: f32) {
        for digits in 2..=6_u8 {
            let all = Digits { others: digits, ..Digits::ALL };
            let bits = all.mantissa_bits("force_un").unwrap_or_default();
            let found = rounded(value, bits);
            assert_eq!(rounded(found, bits).to_bits(), found.to_bits(), "{value}");
            assert_eq!(value.is_nan(), found.is_nan());
            assert_eq!(value.is_finite(), found.is_finite());
            if value.is_finite() {
                let error = (f64::from(found) - f64::from(value)).abs();
                let allowed = half_unit(value, digits.into());
                assert!(error <= allowed, "{value} to {digits} digits: {found}");
            }
        }
    }

    proptest! {
        #[test]
        fn random_values_are_within_half_a_unit(bits: u32) {
            check(f32::from_bits(bits));
        }
    }

    #[test]
    fn edge_values_are_within_half_a_unit() {
        let numbers = [0.0, f32::MIN_POSITIVE, 1e-45, f32::MAX, f32::INFINITY, f32::NAN];
        let powers = (-37..38).map(|exponent| 10_f32.powi(exponent));
        for value in numbers.into_iter().chain(powers) {
            for near in [value, value.next_up(), value.next_down()] {
                check(near);
                check(-near);
            }
        }
    }

    #[test]
    fn halves_round_to_even() {
        let [one, other] = [1.0 + 0.125, 1.0 + 0.375].map(|value| rounded(value, 2));
        assert_eq!([one, other], [1.0, 1.5]);
        assert_eq!(rounded(1.234_567, 23), 1.234_567);
    }
}
