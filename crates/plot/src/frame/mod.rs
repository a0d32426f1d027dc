//! The frame of a plot or a heat map: heading, axes, ticks and units.

pub mod axes;
pub mod heading;
pub mod regions;
pub mod spacing;
pub mod ticks;
pub mod units;
