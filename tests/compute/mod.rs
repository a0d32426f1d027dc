//! Whole maps in memory, and how far two of them are apart.
#![allow(dead_code, reason = "each test program uses its own share")]

use whiskmap::integrate::Engine;
use whiskmap::map::{self, Observer, Summary};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;
use whiskmap::store::{self, Panel};

#[derive(Default)]
struct Panels(Vec<Panel>);

impl Observer for Panels {
    fn panels(&mut self, first: usize, panels: &[Panel]) -> Result<(), store::Error> {
        assert_eq!(first, self.0.len());
        self.0.extend_from_slice(panels);
        Ok(())
    }
    fn settled(&mut self, _: usize) {}
}

pub fn compute(scene: &Scene, engine: &mut dyn Engine) -> (Summary, Vec<Panel>) {
    compute_as(scene, &Plan::new(scene).unwrap(), engine)
}

pub fn compute_as(scene: &Scene, plan: &Plan, engine: &mut dyn Engine) -> (Summary, Vec<Panel>) {
    let mut panels = Panels::default();
    let summary = map::run(scene, plan, engine, &mut panels).unwrap();
    (summary, panels.0)
}

/// Largest difference of two stored channels, relative to the largest value; infinite where only one is NaN.
/// Two roundings to f32 are 1.2e-7.
pub fn difference(a: &[f32], b: &[f32]) -> f32 {
    let largest = a
        .iter()
        .filter(|x| x.is_finite())
        .fold(0.0_f32, |m, x| m.max(x.abs()));
    let misses = a
        .iter()
        .zip(b)
        .map(|(x, y)| match (x.is_nan(), y.is_nan()) {
            (true, true) => 0.0,
            (false, false) => (x - y).abs() / largest,
            _ => f32::INFINITY,
        });
    misses.fold(0.0, f32::max)
}
