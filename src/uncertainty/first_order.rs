//! The spread of push angles to first order: `sd^2 = sum (d push/d value x sd of the value)^2`.

use super::pushes_deg;
use super::varying::{Varying, moved};
use crate::rod::Side;
use crate::scene::Scene;
use crate::shooting::Resolution;
use rayon::prelude::*;

/// Step of the difference quotient, in standard deviations and relative to the value: far above the rounding of exact ends
/// (1e-12), and so small that its truncation error (its square) is negligible.
const STEP: [f64; 2] = [1e-3, 1e-6];

/// Returns the standard deviation of the push angle in degrees, to first order, `[distance]`; `None` where a derivative lacks an end.
pub(super) fn deviations_deg(
    scene: &Scene,
    varying: &[Varying],
    resolution: Resolution,
    side: Side,
) -> Vec<Option<f64>> {
    let pushes = |scene: &Scene| pushes_deg(scene, resolution, side);
    let here = pushes(scene);
    let parts: Vec<Vec<Option<f64>>> = varying
        .par_iter()
        .map(|one| {
            let step = STEP[0] * one.deviation + STEP[1] * one.value.abs();
            let moved = |step| {
                moved(scene, &[(*one, step)])
                    .ok()
                    .map(|scene| pushes(&scene))
            };
            // At a limit of the scene there is one side only.
            let (before, after, width) = match (moved(-step), moved(step)) {
                (Some(before), Some(after)) => (before, after, 2.0 * step),
                (Some(before), None) => (before, here.clone(), step),
                (None, Some(after)) => (here.clone(), after, step),
                (None, None) => return vec![None; here.len()],
            };
            let part = |(before, after): (Option<f64>, Option<f64>)| {
                Some((after? - before?) / width * one.deviation)
            };
            before.into_iter().zip(after).map(part).collect()
        })
        .collect();
    let sum = |row: usize| {
        here[row]?;
        let squares = parts.iter().map(|part| Some(part[row]?.powi(2)));
        Some(squares.sum::<Option<f64>>()?.sqrt())
    };
    (0..here.len()).map(sum).collect()
}
