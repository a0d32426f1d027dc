//! Limits of the values of a scene, and their texts in messages.

use std::fmt;

use super::error::SceneFault;

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
        Self { min: min.into(), max: max.into(), is_open: false, remarks: String::new() }
    }

    /// Creates limits of which the lower end is allowed, and the upper one is not.
    pub fn below(min: impl Into<LimitEnd>, max: impl Into<LimitEnd>) -> Self {
        Self { is_open: true, ..Self::between(min, max) }
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
        let Self { min, max, remarks, .. } = self;
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
        Self { value, meaning: None }
    }
}

impl From<(&'static str, f64)> for LimitEnd {
    fn from((meaning, value): (&'static str, f64)) -> Self {
        Self { value, meaning: Some(meaning) }
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
