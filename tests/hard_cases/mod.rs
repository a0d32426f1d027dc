//! Whiskers and grids at the ends of every range: no NaN, no doubtful cell, results independent of resolution and
//! units, and correct limits.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test fails by panicking, and prints what it measured"
)]

mod case;
mod cases;
use crate::compute;
mod ends;
mod limits;
mod missed;
mod named;
mod random;
mod scanned;
mod states;
mod units;
