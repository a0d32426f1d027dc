//! Courses behind rough surfaces against single poles, closed forms and the balance of energy.

mod energy;
mod history;
mod poles;
mod tables;
mod undecided;

use crate::shipped;
use whiskmap::Side;
use whiskmap::scene::{Scene, Surface};
use whiskmap::texture::Texture;
use whiskmap::whisk::{AngleCourse, WhiskEventKind};

const SHIPPED: [&str; 2] = ["texture_cone", "texture_hair"];

fn scene(name: &str) -> Scene {
    shipped::scene(name)
}

fn course(angles: &[f64]) -> AngleCourse {
    let times = (0..angles.len()).map(|i| i as f64).collect();
    AngleCourse::new(times, angles.to_vec()).unwrap()
}

/// One asperity of the radius 50 um right in front of the base.
const SINGLE: Surface = Surface {
    distance_mm: 14.0,
    spacing_um: 1000.0,
    asperity_radius_um: 50.0,
    length_mm: 0.0,
    jitter: 0.0,
    seed: 0,
};

fn kinds(texture: &Texture) -> Vec<(WhiskEventKind, Side)> {
    let events = texture.events.iter();
    events.map(|event| (event.event, event.side)).collect()
}
