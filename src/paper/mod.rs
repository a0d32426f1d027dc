//! The whiskers, numbers and figures of the paper.
//!
//! Hires, Pammer, Svoboda and Golomb (2013), "Tapered whiskers are required for active tactile sensation", eLife
//! 2:e01350.

mod check;
pub mod elastica;
mod exact;
mod figures;
mod published;
mod reference;
mod whiskers;

pub use check::{Check, CheckVerdict, ExpectedNumber};
pub use figures::{Figure, FigureError, Measurements, TableRows, figures};
pub use whiskers::{FIG4_WHISKER, FIG5_LEFT, FIG5_RIGHT, POLE};

/// Compares computed numbers with published ones, closed forms and independent solvers. Returns all checks, `[check]`.
#[must_use]
pub fn checks() -> Vec<Check> {
    [published::checks(), exact::checks(), reference::checks()].concat()
}
