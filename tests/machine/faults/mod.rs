//! Injected faults: the CPU completes the map, which stays the same, and the counts give the CPU's share.

#[cfg(target_os = "linux")]
pub mod driver;
pub mod kernel;
pub mod lost;

use crate::compute::{assert_close, difference};
use crate::shipped;
use whiskmap::map::Panel;
use whiskmap::scene::Scene;

/// The paper's cone on a grid of `count` x `count`.
fn cone(count: usize) -> Scene {
    shipped::scene("cone").thinned(count, 1)
}

/// Asserts that regimes, statuses and margins are equal, and states as far as an engine may be off.
fn assert_same(wanted: &[Panel], found: &[Panel]) {
    assert_close(wanted, found, "the cone");
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.status == b.status);
        assert_eq!(difference(&a.margin_deg, &b.margin_deg), 0.0);
    }
}
