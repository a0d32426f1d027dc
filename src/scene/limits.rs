//! The values a key may have, and how a message says so.

use std::fmt;
use std::ops::{Bound, RangeBounds};

use toml::Spanned;

use super::error::Fault;

/// A number and where the file has it. Integers are numbers too.
pub(super) type Number = Spanned<f64>;

/// Of Coulomb's coefficient: the whiskers of rats on steel have about 0.5. Up to here no end of 25,000 random whiskers was
/// unknown (`benches/NOTES.md`).
pub(super) fn friction_limits() -> Limits {
    Limits::between(0.0, 1.0).remarks([
        "with more, whiskers coil around the pole for turns on end, and not all ends are known",
    ])
}

/// Measured ratios lie between 0.7 and 1.4.
pub(super) const STIFFEST_TIP: f64 = 20.0;

/// A whisker that is twice as long as it looks.
pub(super) const MOST_STRETCH: f64 = 2.0;

/// A range of numbers. NaN is in none, and no range here reaches infinity.
pub(super) struct Limits {
    range: (Bound<f64>, Bound<f64>),
    must: String,
}

impl Limits {
    /// Both ends are allowed.
    pub fn between(min: impl Into<End>, max: impl Into<End>) -> Self {
        let (min, max) = (min.into(), max.into());
        Self {
            range: (Bound::Included(min.value), Bound::Included(max.value)),
            must: format!("must be between {min} and {max}"),
        }
    }

    /// The lower end is allowed, the upper one is not.
    pub fn below(min: impl Into<End>, max: impl Into<End>) -> Self {
        let (min, max) = (min.into(), max.into());
        Self {
            range: (Bound::Included(min.value), Bound::Excluded(max.value)),
            must: format!("must be at least {min} and less than {max}"),
        }
    }

    /// Adds remarks to the end of the message.
    pub fn remarks(mut self, remarks: impl IntoIterator<Item = impl fmt::Display>) -> Self {
        for remark in remarks {
            self.must = format!("{}; {remark}", self.must);
        }
        self
    }

    /// The number itself if it lies within.
    pub fn check(&self, key: &str, number: &Number) -> Result<f64, Fault> {
        if self.range.contains(number.get_ref()) {
            Ok(*number.get_ref())
        } else {
            Err(Fault::new(key, number.span(), &*self.must))
        }
    }

    /// The number if there is one, and it lies within; `absent` otherwise.
    pub fn check_or(&self, absent: f64, key: &str, number: Option<&Number>) -> Result<f64, Fault> {
        number.map_or(Ok(absent), |number| self.check(key, number))
    }
}

/// The fewest digits that tell a number from all others, with an exponent where it is very large or small.
#[must_use]
pub fn digits(value: f64) -> String {
    // `Debug` writes 5e-11 where `Display` writes eleven digits, but also 30.0 for 30.
    let digits = format!("{value:?}");
    digits.trim_end_matches(".0").to_owned()
}

/// One end of a range: a number, and what it stands for if that is not plain.
pub(super) struct End {
    value: f64,
    meaning: Option<&'static str>,
}

impl From<f64> for End {
    fn from(value: f64) -> Self {
        Self {
            value,
            meaning: None,
        }
    }
}

impl From<(&'static str, f64)> for End {
    fn from((meaning, value): (&'static str, f64)) -> Self {
        Self {
            value,
            meaning: Some(meaning),
        }
    }
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = digits(self.value);
        match self.meaning {
            None => f.write_str(&digits),
            Some(meaning) => write!(f, "{meaning} ({digits})"),
        }
    }
}
