//! Measured points and fits: known parameters come back, and parameters that cannot be known have no standard error.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod known;
mod limits;
mod noisy;
mod points;
mod refused;
mod robust;
mod start;
mod verdict;
mod whiskers;

use whiskmap::Side;
use whiskmap::measured::{MeasuredAngle, MeasuredPoint, MeasuredPoints};
use whiskmap::scene::{Parameter, Scene};
use whiskmap::trace::curve;

/// The cone with every key that may be fitted to a parabola and two radii.
fn cone() -> Scene {
    let text = include_str!("../../scenes/cone.toml");
    let tables = "[whisker.modulus_gradient]\ntip_to_base = 1\n[whisker.projection]\narc_stretch = 1\n[contact]\nfriction = 0\n";
    Scene::parse(&format!("{text}{tables}"), "cone.toml").unwrap()
}

/// Slip-offs on both sides, and on CB two pull-offs.
const DISTANCES_MM: [f64; 12] =
    [6.0, 7.5, 9.0, 10.0, 11.0, 12.5, 14.0, 15.0, 16.0, 17.5, 19.2, 19.5];

/// The detachments of a scene, without any error.
fn detachments(scene: &Scene, angle: MeasuredAngle, distances_mm: &[f64]) -> MeasuredPoints {
    let whisker = scene.first_whisker().whisker;
    let side = |side| curve(&whisker, &scene.pole, side, distances_mm);
    let ends = Side::BOTH.into_iter().flat_map(side);
    let points = ends.enumerate().map(|(i, end)| MeasuredPoint {
        line: i + 2,
        whisker: 0,
        side: end.side,
        distance_mm: end.distance_mm,
        angle_deg: match angle {
            MeasuredAngle::Push => end.push_angle_deg.unwrap(),
            MeasuredAngle::Chord => end.push_chord_deg.unwrap(),
        },
        kind: Some(end.kind),
        sd_deg: 1.0,
    });
    MeasuredPoints {
        origin: "points.csv".to_owned(),
        note: None,
        angle,
        have_deviations: false,
        whiskers: Vec::new(),
        points: points.collect(),
        incomplete: Vec::new(),
    }
}

/// The names of what is free.
fn free(truth: &[(Parameter, f64)]) -> Vec<Parameter> {
    truth.iter().map(|(parameter, _)| *parameter).collect()
}
