//! The force on a whisker that is pushed against a pole, from first touch to the fold and back along the unstable states.
//!
//! `cargo run --release --example force_near_slip`
#![allow(clippy::print_stdout, reason = "an example shows what it finds")]

use whiskmap::Side;
use whiskmap::branch;
use whiskmap::scene::Scene;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::read("scenes/cone.toml")?;
    for side in Side::BOTH {
        for point in branch(&scene, 15.66, side)?.points(21)? {
            let kind = if point.stable { "stable" } else { "unstable" };
            println!(
                "{side:?}  {:8.3} deg  {:7.4} uN  {kind}",
                point.push_angle_deg, point.force_un
            );
        }
    }
    Ok(())
}
