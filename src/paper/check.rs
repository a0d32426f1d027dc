//! Checks: comparisons of computed numbers with independently verified values.

use crate::scene::{Pole, Whisker};
use crate::trace::{Detachment, curve};
use whiskmap_mechanics::rod::Side;

/// Check of a computed number against an independently verified value.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Whisker, side and pole of the checked number.
    pub case: String,
    /// Name of the checked number, with its unit.
    pub quantity: &'static str,
    /// Source of the independently verified value.
    pub source: &'static str,
    /// Independently verified value or bound, in the unit of the checked number.
    pub expected: ExpectedNumber,
    /// Computed value of the checked number, in its unit; NaN if there is none.
    pub computed: f64,
    /// True if an independent solver also contradicts the source of the value.
    pub is_disputed: bool,
}

/// Verdict of a check: whether the number agrees with its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckVerdict {
    /// The computed number agrees with its source.
    Pass,
    /// The computed number differs from its source, and so does an independent solver.
    Differs,
    /// The computed number differs from its source.
    Fail,
}

/// Value or bound that a number is checked against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExpectedNumber {
    /// Expected value and the allowed difference: half of the last known digit, unless a check says otherwise.
    Near(f64, f64),
    /// Lower bound of the checked number.
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

    /// Returns the verdict on the checked number, compared with its source; NaN never passes.
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

/// Name of the paper as a source of checked numbers.
pub const PAPER: &str = "paper";
pub const AUTO: &str = "AUTO-07p";
pub const FORWARD: &str = "forward BVP";
pub const CLOSED: &str = "closed form";
pub const EXACT: &str = "symmetry";

/// Creates a check of a number against a value, up to a tolerance.
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

/// Computes the detachment of a whisker at one distance, in millimetres.
pub fn end(whisker: &Whisker, pole: &Pole, side: Side, distance_mm: f64) -> Detachment {
    curve(whisker, pole, side, &[distance_mm])[0]
}
