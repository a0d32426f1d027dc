//! The paper itself: its whiskers, its numbers, its figures.
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

pub use check::{Check, Expected, Verdict};
pub use figures::{Figure, Measurements, Rows, figures};
pub use whiskers::{FIG4_WHISKER, FIG5_LEFT, FIG5_RIGHT, POLE};

/// Every number that is known otherwise: published, in closed form, or from an independent solver.
#[must_use]
pub fn checks() -> Vec<Check> {
    [published::checks(), exact::checks(), reference::checks()].concat()
}
