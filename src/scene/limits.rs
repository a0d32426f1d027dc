//! Limits of the values of a scene, and their texts in messages.

use std::fmt;

use super::error::SceneFault;
use super::parameter::Parameter;

/// Largest ratio of the moduli at tip and base, and of those at base and tip. Measured ratios lie between 0.7 and 1.4.
pub(super) const STIFFEST_TIP: f64 = 20.0;

/// Largest accepted arc stretch, a ratio.
pub(super) const MOST_STRETCH: f64 = 2.0;

/// Returns the limits of a parameter, whatever the other numbers are. Other numbers narrow some of them.
///
/// Coulomb's coefficient is about 0.5 for whiskers of rats on steel. Up to 1, every end of 25,000 random whiskers was found
/// (`benches/NOTES.md`).
pub(super) fn limits(parameter: Parameter) -> NumberLimits {
    match parameter {
        Parameter::LengthMm | Parameter::BaseRadiusUm => NumberLimits::between(1e-3, 1e5),
        Parameter::TipRadiusUm => NumberLimits::between(0.0, 1e5),
        Parameter::Taper => NumberLimits::between(0.0, 1.0),
        Parameter::YoungsModulusGpa => NumberLimits::between(1e-6, 1e4),
        Parameter::ModulusTipToBase => NumberLimits::between(1.0 / STIFFEST_TIP, STIFFEST_TIP),
        Parameter::ArcStretch => NumberLimits::between(1.0, MOST_STRETCH),
        Parameter::FollicleStiffness => NumberLimits::between(1e-6, 1e15),
        Parameter::Friction => NumberLimits::between(0.0, 1.0).remarks([
            "with more, whiskers coil around the pole for turns on end, and not all ends are known",
        ]),
        _ => NumberLimits::between(-1e6, 1e6),
    }
}

/// Limits of a number: a range, in the number's unit. NaN is in none, and no range here reaches infinity.
pub(super) struct NumberLimits {
    min: LimitEnd,
    max: LimitEnd,
    /// True if the upper end is not allowed.
    is_open: bool,
    /// End of the message about a number outside the limits.
    remarks: String,
}

impl NumberLimits {
    /// Creates limits of which both ends are allowed.
    pub fn between(min: impl Into<LimitEnd>, max: impl Into<LimitEnd>) -> Self {
        Self {
            min: min.into(),
            max: max.into(),
            is_open: false,
            remarks: String::new(),
        }
    }

    /// Creates limits of which the lower end is allowed, and the upper one is not.
    pub fn below(min: impl Into<LimitEnd>, max: impl Into<LimitEnd>) -> Self {
        Self {
            is_open: true,
            ..Self::between(min, max)
        }
    }

    /// Adds remarks to the end of the message about a number outside the limits.
    pub fn remarks(mut self, remarks: impl IntoIterator<Item = impl fmt::Display>) -> Self {
        for remark in remarks {
            self.remarks += &format!("; {remark}");
        }
        self
    }

    /// Returns the `value` of `key` if it lies within the limits, otherwise a fault.
    pub fn check(&self, key: &str, value: f64) -> Result<f64, SceneFault> {
        let Self {
            min, max, remarks, ..
        } = self;
        let is_below = match self.is_open {
            false => value <= max.value,
            true => value < max.value,
        };
        if value >= min.value && is_below {
            return Ok(value);
        }
        let must = match self.is_open {
            false => format!("must be between {min} and {max}{remarks}"),
            true => format!("must be at least {min} and less than {max}{remarks}"),
        };
        Err(SceneFault::of_value(key, digits(value), must))
    }
}

/// Formats a number with the fewest digits that identify it, with an exponent if it is very large or small.
#[must_use]
pub fn digits(value: f64) -> String {
    // `Debug` writes 5e-11 where `Display` writes eleven digits, but also 30.0 for 30.
    let digits = format!("{value:?}");
    digits.trim_end_matches(".0").to_owned()
}

/// Rounds a number to a number of significant digits, at least 1.
#[must_use]
pub fn rounded(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.parse().unwrap_or(value)
}

/// End of a range of allowed numbers: the number, and its meaning if it follows from other numbers.
pub(super) struct LimitEnd {
    value: f64,
    meaning: Option<&'static str>,
}

impl From<f64> for LimitEnd {
    fn from(value: f64) -> Self {
        Self {
            value,
            meaning: None,
        }
    }
}

impl From<(&'static str, f64)> for LimitEnd {
    fn from((meaning, value): (&'static str, f64)) -> Self {
        Self {
            value,
            meaning: Some(meaning),
        }
    }
}

impl fmt::Display for LimitEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = digits(self.value);
        match self.meaning {
            None => f.write_str(&digits),
            Some(meaning) => write!(f, "{meaning} ({digits})"),
        }
    }
}
