//! Comparisons of computed numbers with independently known ones.

use crate::rod::Side;
use crate::scene::{Pole, Whisker};
use crate::trace::{Detachment, curve};

/// An independently known number, and the same number computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Whisker, side and pole that the number belongs to.
    pub case: String,
    /// Name of the number, with its unit.
    pub quantity: &'static str,
    /// Source of the known number.
    pub source: &'static str,
    /// Known value or bound.
    pub expected: ExpectedNumber,
    /// Computed value; NaN if there is none.
    pub computed: f64,
    /// Whether an independent solver also contradicts the source.
    pub is_disputed: bool,
}

/// The result of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckVerdict {
    /// The number agrees with its source.
    Pass,
    /// The number differs from its source, and so does an independent solver.
    Differs,
    /// The number differs from its source.
    Fail,
}

/// The value or bound that a number is checked against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExpectedNumber {
    /// A value and the allowed difference: half of the last known digit, unless a check says otherwise.
    Near(f64, f64),
    /// A lower bound.
    Above(f64),
}

impl Check {
    /// Returns the distance of the number from its expected value, or from a bound that it violates; 0 if it meets the bound.
    #[must_use]
    pub fn difference(&self) -> f64 {
        match self.expected {
            ExpectedNumber::Near(value, _) => (self.computed - value).abs(),
            ExpectedNumber::Above(bound) if self.computed > bound => 0.0,
            ExpectedNumber::Above(bound) => bound - self.computed,
        }
    }

    /// Compares the number with its source; NaN never passes.
    #[must_use]
    pub fn verdict(&self) -> CheckVerdict {
        let passes = match self.expected {
            ExpectedNumber::Near(_, tolerance) => self.difference() <= tolerance,
            ExpectedNumber::Above(bound) => self.computed > bound,
        };
        match passes {
            true => CheckVerdict::Pass,
            false if self.is_disputed && self.computed.is_finite() => CheckVerdict::Differs,
            false => CheckVerdict::Fail,
        }
    }
}

/// Sources of known numbers.
pub const PAPER: &str = "paper";
pub const AUTO: &str = "AUTO-07p";
pub const FORWARD: &str = "forward BVP";
pub const CLOSED: &str = "closed form";
pub const EXACT: &str = "symmetry";

/// A check of a number against a value, up to a tolerance.
pub fn near(
    case: impl Into<String>,
    quantity: &'static str,
    source: &'static str,
    (expected, tolerance): (f64, f64),
    computed: Option<f64>,
) -> Check {
    Check {
        case: case.into(),
        quantity,
        source,
        expected: ExpectedNumber::Near(expected, tolerance),
        computed: computed.unwrap_or(f64::NAN),
        is_disputed: false,
    }
}

/// The detachment at one distance.
pub fn end(whisker: &Whisker, pole: &Pole, side: Side, distance_mm: f64) -> Detachment {
    curve(whisker, pole, side, &[distance_mm])[0]
}
