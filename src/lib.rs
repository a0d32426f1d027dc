//! `whiskmap`: where does a tapered, curved whisker pushed against a pole stay in contact, where does it
//! slip off, and where is it pulled off?
//!
//! The mechanics are those of Hires, Pammer, Svoboda and Golomb (2013), "Tapered whiskers are required for
//! active tactile sensation", eLife 2:e01350. `ARCHITECTURE.md` names the rooms and the way data takes
//! through them.

pub mod accuracy;
pub mod bench;
pub mod classify;
pub mod cli;
pub mod integrate;
pub mod map;
pub mod paper;
pub mod plan;
pub mod refine;
pub mod render;
pub mod scene;
pub mod sheet;
pub mod store;
pub mod trace;

pub use whiskmap_mechanics::{numerics, rod, shooting};
