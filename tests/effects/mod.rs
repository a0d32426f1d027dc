//! Euler spirals and measured radii against plain equations, differences, and the shapes that they contain.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod equations;
mod measured_radii;
mod neutral;

use crate::random_rods::{Random, condition, rod};
use whiskmap::mechanics::rod::{Effects, Rod};
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::mechanics::shooting::batch::{InitialCondition, Method};

fn with(effects: Effects, resolution: Resolution) -> Method {
    Method::new(resolution).with_effects(effects)
}

/// A test ends soon: its rods may stay until then.
fn kept(rod: Rod) -> &'static Rod {
    Box::leak(Box::new(rod))
}

fn conditions(effects: Effects, count: usize) -> Vec<InitialCondition<'static>> {
    let mut random = Random::new(21);
    (0..count).map(|_| condition(kept(rod(effects, &mut random)), 6.5, &mut random)).collect()
}
