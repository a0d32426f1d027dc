//! The paper itself: its whiskers, its numbers, its figures.
//!
//! Hires, Pammer, Svoboda and Golomb (2013), "Tapered whiskers are required for active tactile sensation", eLife
//! 2:e01350.

mod checks;
pub mod elastica;
mod figures;
mod reference;
mod whiskers;

pub use checks::{Check, Expected, checks};
pub use figures::{Figure, Rows, figures};
