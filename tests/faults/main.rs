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

use compute::difference;
use whiskmap::integrate::EngineError;
use whiskmap::integrate::gpu::{Gpu, Precision, shaders};
use whiskmap::rod::Effects;
use whiskmap::scene::Scene;
use whiskmap::store::{Panel, STATE_CHANNELS};

/// The GPU engine with this shader, or `None` (said aloud) where there is none.
fn open(precision: Precision, shader: String) -> Option<Gpu> {
    match Gpu::with_shader(precision, shader) {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            let required = std::env::var_os("WHISKMAP_REQUIRE_GPU").is_some_and(|x| x == "1");
            let optional = matches!(error, EngineError::Unsupported { .. });
            assert!(optional || !required, "WHISKMAP_REQUIRE_GPU=1, but {error}");
            eprintln!("SKIPPED, NOT TESTED: gpu {precision}: {error}");
            None
        }
    }
}

fn sound() -> Option<Gpu> {
    open(
        Precision::F32,
        shaders::shoot(Precision::F32, Effects::default()),
    )
}

/// The paper's cone on a grid of `count` x `count`.
fn cone(count: usize) -> Scene {
    Scene::read("scenes/cone.toml").unwrap().thinned(count, 1)
}

/// Asserts that regimes, statuses and margins are equal, and states as far as their last digit in the file goes: where
/// a GPU prepared the refinement, that ends on the same state from another start.
fn assert_same(wanted: &[Panel], found: &[Panel]) {
    assert_eq!(wanted.len(), found.len());
    for (a, b) in wanted.iter().zip(found) {
        assert!(a.regime == b.regime);
        assert!(a.status == b.status);
        assert_eq!(difference(&a.margin_deg, &b.margin_deg), 0.0);
        for (channel, (x, y)) in STATE_CHANNELS.iter().zip(a.state.iter().zip(&b.state)) {
            let miss = difference(x, y);
            assert!(miss <= 2e-7, "{channel}: {miss:.1e}");
        }
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
