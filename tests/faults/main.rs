//! Faults put in on purpose: the map is completed by the CPU, is the same, and says how much of it the CPU did.
//!
//! Without an adapter all this is skipped, loudly; `WHISKMAP_REQUIRE_GPU=1` makes that a failure.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test fails by panicking, and says aloud what it skipped"
)]

#[path = "../compute/mod.rs"]
mod compute;
#[cfg(target_os = "linux")]
mod driver;
mod kernel;
mod lost;

use compute::{assert_close, difference, open_with};
use whiskmap::integrate::gpu::{Gpu, Precision, shaders};
use whiskmap::map::Panel;
use whiskmap::rod::Effects;
use whiskmap::scene::Scene;

/// The GPU engine with the shader for [`cone`].
fn sound(precision: Precision) -> Option<Gpu> {
    open_with(precision, shaders::shoot(precision, Effects::default()))
}

/// The paper's cone on a grid of `count` x `count`.
fn cone(count: usize) -> Scene {
    Scene::read("scenes/cone.toml").unwrap().thinned(count, 1)
}

/// Asserts that regimes, statuses and margins are equal, and states as far as their last digit in the file goes.
fn assert_same(wanted: &[Panel], found: &[Panel]) {
    assert_close(wanted, found, "the cone");
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.status == b.status);
        assert_eq!(difference(&a.margin_deg, &b.margin_deg), 0.0);
    }
}

/// Asserts that two maps are equal bit by bit, Newton steps included.
fn assert_identical(wanted: &[Panel], found: &[Panel]) {
    let bits = |channel: &Vec<f32>| -> Vec<u32> { channel.iter().map(|x| x.to_bits()).collect() };
    assert_same(wanted, found);
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.state.each_ref().map(bits) == b.state.each_ref().map(bits));
        assert!(bits(&a.residual) == bits(&b.residual));
        assert!(a.newton_steps == b.newton_steps);
    }
}
