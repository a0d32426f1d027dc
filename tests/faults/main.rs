//! Faults put in on purpose: the map is completed by the CPU, is the same, and says how much of it the CPU did.
//!
//! Without an adapter all this is skipped, loudly; `WHISKMAP_REQUIRE_GPU=1` makes that a failure.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test fails by panicking, and says aloud what it skipped"
)]

#[path = "../cells/mod.rs"]
mod cells;
#[path = "../compute/mod.rs"]
mod compute;
#[cfg(target_os = "linux")]
mod driver;
mod kernel;
mod lost;
#[path = "../random_rods/mod.rs"]
mod random_rods;

use compute::{assert_close, difference};
use whiskmap::map::Panel;
use whiskmap::scene::Scene;

/// The paper's cone on a grid of `count` x `count`.
fn cone(count: usize) -> Scene {
    Scene::read("scenes/cone.toml").unwrap().thinned(count, 1)
}

/// Asserts that regimes, statuses and margins are equal, and states as far as an engine may be off.
fn assert_same(wanted: &[Panel], found: &[Panel]) {
    assert_close(wanted, found, "the cone");
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.status == b.status);
        assert_eq!(difference(&a.margin_deg, &b.margin_deg), 0.0);
    }
}
