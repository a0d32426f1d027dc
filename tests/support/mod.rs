//! Helpers of several modules and programs of tests.
#![allow(dead_code, reason = "each test program uses a part of the helpers")]

pub mod cells;
pub mod compute;
pub mod effect_sets;
pub mod map;
pub mod program;
pub mod random_rods;
pub mod sealed;
pub mod shipped;
