//! Measurements of detachment curves, from coarse to fine steps.

use super::task::{EXACT, Spread, whisker_sides};
use super::timing::{Timing, timed};
use crate::scene::Scene;
use crate::trace::{Detachment, curve_at};
use rayon::prelude::*;
use serde::Serialize;
use std::convert::Infallible;
use whiskmap_mechanics::shooting::Resolution;

/// Measurement of the detachments of a scene at one resolution, on all threads.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Detachments {
    /// Number of steps of a trajectory at the fold of a cylinder.
    pub steps: u32,
    /// Number of points of the detachment curves.
    pub points: usize,
    /// Times for all points of the curves, in seconds.
    pub seconds: Timing,
    /// Time for one point of the curves, in microseconds.
    pub us_per_point: f64,
    /// Error of the push angle at detachment, in degrees.
    pub angle_deg: Spread,
}

/// Measures the detachments of a scene at every resolution of the ladder, `[rung]`.
pub fn measure(scene: &Scene, runs: usize) -> Vec<Detachments> {
    let sides = whisker_sides(scene);
    let curves = |resolution: Resolution| -> Vec<Detachment> {
        sides
            .par_iter()
            .flat_map_iter(|(swept, side)| {
                let distances = &scene.grid.distance_mm;
                curve_at(resolution, &swept.whisker, &swept.pole, *side, distances)
            })
            .collect()
    };
    let exact = curves(EXACT);
    Resolution::LADDER
        .iter()
        .map(|resolution| {
            let Ok((seconds, found)) = timed(runs, || Ok::<_, Infallible>(curves(*resolution)));
            let pairs = found.iter().zip(&exact);
            let apart = pairs.filter_map(|(found, exact)| {
                let exact = exact.push_angle_deg?;
                Some((found.push_angle_deg.unwrap_or(f64::NAN) - exact).abs())
            });
            Detachments {
                steps: resolution.least,
                points: found.len(),
                seconds,
                us_per_point: 1e6 * seconds.median / found.len() as f64,
                angle_deg: Spread::of(apart.collect()),
            }
        })
        .collect()
}
