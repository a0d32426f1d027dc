//! A number that is known otherwise, and how far ours is from it.

use crate::rod::Side;
use crate::scene::{Pole, Whisker};
use crate::trace::{Detachment, curve};

/// A number that is known, and the same number computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Of what.
    pub case: String,
    /// Which quantity, with its unit.
    pub quantity: &'static str,
    /// Where it is known from.
    pub source: &'static str,
    /// What it should be.
    pub expected: Expected,
    /// What it is.
    pub computed: f64,
    /// An independent solver contradicts the source, too.
    pub is_disputed: bool,
}

/// What a comparison says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The number is what it should be.
    Pass,
    /// It is not, but neither is an independent solver's.
    Differs,
    /// It is not.
    Fail,
}

/// What a number should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// A value, up to a tolerance: half of the last digit known, unless a check says otherwise.
    Near(f64, f64),
    /// More than a value.
    Above(f64),
}

impl Check {
    /// How far the number is from where it should be; 0 inside of an open range.
    #[must_use]
    pub fn difference(&self) -> f64 {
        match self.expected {
            Expected::Near(value, _) => (self.computed - value).abs(),
            Expected::Above(bound) if self.computed > bound => 0.0,
            Expected::Above(bound) => bound - self.computed,
        }
    }

    /// Whether the number is what it should be; NaN never is.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let passes = match self.expected {
            Expected::Near(_, tolerance) => self.difference() <= tolerance,
            Expected::Above(bound) => self.computed > bound,
        };
        match passes {
            true => Verdict::Pass,
            false if self.is_disputed && self.computed.is_finite() => Verdict::Differs,
            false => Verdict::Fail,
        }
    }
}

/// Where numbers are known from.
pub(super) const PAPER: &str = "paper";
pub(super) const AUTO: &str = "AUTO-07p";
pub(super) const FORWARD: &str = "forward BVP";
pub(super) const CLOSED: &str = "closed form";
pub(super) const EXACT: &str = "symmetry";

/// A check on a number that should be `expected`, up to a tolerance.
pub(super) fn near(
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
        expected: Expected::Near(expected, tolerance),
        computed: computed.unwrap_or(f64::NAN),
        is_disputed: false,
    }
}

/// The end of the push at one distance.
pub(super) fn end(whisker: &Whisker, pole: &Pole, side: Side, distance_mm: f64) -> Detachment {
    curve(whisker, pole, side, &[distance_mm])[0]
}
