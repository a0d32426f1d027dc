//! Fits: known parameters come back, and what cannot be known says so.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use std::time::Instant;
use whiskmap::fit::fit;
use whiskmap::measured::{Angle, Point, Points};
use whiskmap::rod::Side;
use whiskmap::scene::{Parameter, Scene};
use whiskmap::trace::curve;

fn cone() -> Scene {
    Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml").unwrap()
}

pub fn points(scene: &Scene, distances: &[f64]) -> Points {
    let whisker = scene.first_whisker();
    let points = Side::BOTH.into_iter().flat_map(|side| {
        curve(&whisker, &scene.pole, side, distances)
    });
    let points = points.enumerate().map(|(i, end)| Point {
        line: i + 2,
        side: end.side,
        distance_mm: end.distance_mm,
        angle_deg: end.push_angle_deg.unwrap(),
        kind: Some(end.kind),
        sd_deg: 1.0,
    });
    Points { origin: "points.csv".to_owned(), angle: Angle::Push, have_deviations: false, points: points.collect() }
}

#[test]
fn probe() {
    let start = cone();
    use Parameter::*;
    let distances: Vec<f64> = (0..12).map(|i| 6.0 + i as f64).collect();
    for truth in [
        vec![(TipRadiusUm, 2.5)],
        vec![(TipRadiusUm, 2.5), (ParabolaPerMm, 0.018)],
        vec![(TipRadiusUm, 2.5), (ParabolaPerMm, 0.018), (LengthMm, 19.0)],
        vec![(TipRadiusUm, 2.5), (ParabolaPerMm, 0.018), (VertexMm, 2.0)],
        vec![(TipRadiusUm, 2.5), (PoleRadiusMm, 0.3)],
        vec![(BaseRadiusUm, 40.0)],
        vec![(BaseRadiusUm, 40.0), (TipRadiusUm, 3.0)],
        vec![(YoungsModulusGpa, 5.0), (TipRadiusUm, 3.0)],
    ] {
        let scene = start.with_parameters(&truth).unwrap();
        let points = points(&scene, &distances);
        let free: Vec<_> = truth.iter().map(|(own, _)| *own).collect();
        let t = Instant::now();
        let fit = fit(&start, &points, &free);
        eprintln!("{:.3} s", t.elapsed().as_secs_f64());
        match fit {
            Ok(fit) => for (e, (_, v)) in fit.estimates.iter().zip(&truth) { eprintln!("   {:?} {} {:e} {:?}", e.parameter, e.value, e.value / v - 1.0, e.standard_error); },
            Err(why) => eprintln!("{why}"),
        }
    }
}
