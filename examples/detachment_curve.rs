//! Where a conical whisker detaches, and how: prints one line per distance.
//!
//! `cargo run --release --example detachment_curve`
#![allow(clippy::print_stdout, reason = "an example shows what it finds")]

use whiskmap::scene::Scene;
use whiskmap::{Options, curve};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cone = Scene::read("scenes/cone.toml")?.to_builder();
    let scene = cone.distance_mm([5.0, 10.0, 15.0, 19.0]).build()?;
    println!("side  distance  how         push angle");
    for (_, end) in curve(&scene, Options::default())? {
        let push = end.push_angle_deg.unwrap_or(f64::NAN);
        println!("{:?}    {:5.1} mm  {:10?}  {push:9.4} deg", end.side, end.distance_mm, end.kind);
    }
    Ok(())
}
