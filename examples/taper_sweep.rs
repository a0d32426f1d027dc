//! How the share of pushes that end in slip-off depends on the taper: one regime map per whisker, in memory.
//!
//! `cargo run --release --example taper_sweep`
#![allow(clippy::print_stdout, reason = "an example shows what it finds")]

use whiskmap::Regime;
use whiskmap::scene::Scene;
use whiskmap::{Options, map};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::read("scenes/morphology.toml")?.thinned(64, 8);
    let map = map(&scene, Options::default())?;
    for (swept, panel) in scene.whiskers().flatten().zip(&map.panels) {
        let slipped = panel.regime.iter().filter(|code| **code == Regime::SlipOff.code());
        let share = slipped.count() as f64 / panel.regime.len() as f64;
        println!(
            "taper {:.2}, curvature {:.3}/mm: {:4.1} % slip off",
            swept.whisker.taper(),
            swept.whisker.curvature.map_or(0.0, |curvature| curvature.parabola_per_mm),
            100.0 * share
        );
    }
    Ok(())
}
