//! Nonlinear least squares by Levenberg and Marquardt's method in a scaled trust region.
//!
//! After Moré, "The Levenberg-Marquardt algorithm: implementation and theory" (1978), as in MINPACK's `lmder`. A step minimises
//! `|r + J p|` subject to `|D p| <= radius`. `D` has the largest lengths so far of the columns of `J`. The singular values of
//! `J D^-1` give the step for every damping, and so the damping at which the step reaches the radius.

mod bounded;
mod degree;
mod svd;

pub use bounded::{BoundedProblem, FAINT, search};
pub use degree::smallest_degree;
pub use svd::{Svd, dot, norm};

use rayon::prelude::*;

/// Most evaluations of the residuals, per parameter.
const MOST_STEPS: usize = 100;

/// First radius of the trust region over the length of the scaled parameters.
const FIRST_RADIUS: f64 = 100.0;

/// Largest relative difference of the length of a step from the radius.
const RADIUS_SLACK: f64 = 0.1;

/// Least ratio of actual and predicted reduction with which a step is taken.
const LEAST_RATIO: f64 = 1e-4;

/// Returns the columns of the Jacobian of `residuals_at` by differences of `step`, `[parameter][residual]`: central ones, or on one side where
/// the other has no residuals. `None` without residuals at `x`, or on both sides.
pub fn differences(
    residuals_at: impl Fn(&[f64]) -> Option<Vec<f64>> + Sync,
    x: &[f64],
    step: f64,
) -> Option<Vec<Vec<f64>>> {
    let here = residuals_at(x)?;
    let columns = (0..x.len()).into_par_iter().map(|i| {
        let beside = |step: f64| {
            let mut beside = x.to_vec();
            beside[i] += step;
            residuals_at(&beside)
        };
        let slopes = |from: &[f64], to: &[f64], step: f64| {
            let pairs = from.iter().zip(to);
            pairs.map(|(from, to)| (to - from) / step).collect()
        };
        match (beside(-step), beside(step)) {
            (Some(before), Some(after)) => Some(slopes(&before, &after, 2.0 * step)),
            (None, Some(after)) => Some(slopes(&here, &after, step)),
            (Some(before), None) => Some(slopes(&before, &here, step)),
            (None, None) => None,
        }
    });
    columns.collect()
}

/// Minimises the sum of squares of residuals from the parameters `x` on. Returns the parameters and the sum.
///
/// `residuals_at` returns the residuals at a place, alone or with what else the Jacobian there needs. `jacobian_at` returns the columns of the
/// Jacobian at a place with these residuals, or the reason why there are none. The iteration ends where the relative change of the sum, or of the scaled
/// parameters, is at most `tolerance`.
///
/// # Errors
/// The reason why the iteration ends before it converges.
pub fn minimise<R: AsRef<[f64]>>(
    residuals_at: impl Fn(&[f64]) -> R,
    jacobian_at: impl Fn(&[f64], &R) -> Result<Vec<Vec<f64>>, &'static str>,
    mut x: Vec<f64>,
    tolerance: f64,
) -> Result<(Vec<f64>, f64), &'static str> {
    let mut residuals = residuals_at(&x);
    let mut length = norm(residuals.as_ref());
    let mut scales = vec![0.0; x.len()];
    let mut radius = f64::INFINITY;
    let mut steps = 0;
    if !length.is_finite() {
        return Err("numbers overflow");
    }
    loop {
        let mut columns = jacobian_at(&x, &residuals)?;
        for (column, scale) in columns.iter_mut().zip(&mut scales) {
            *scale = norm(column).max(*scale);
            // A parameter on which nothing depends stays.
            if *scale > 0.0 {
                column.iter_mut().for_each(|entry| *entry /= *scale);
            }
        }
        let scaled =
            |x: &[f64]| norm(&x.iter().zip(&scales).map(|(x, d)| x * d).collect::<Vec<_>>());
        if radius.is_infinite() {
            let start = scaled(&x);
            radius = FIRST_RADIUS * if start > 0.0 { start } else { 1.0 };
        }
        let svd = Svd::new(columns);
        let tiny = svd.largest() * f64::EPSILON;
        // Singular value, direction, and scalar product of the residuals and the image.
        let parts: Vec<_> = svd
            .values()
            .filter(|(value, ..)| *value > tiny)
            .map(|(value, direction, image)| (value, direction, dot(image, residuals.as_ref())))
            .collect();
        if length == 0.0 || parts.is_empty() {
            return Ok((x, length * length));
        }
        loop {
            steps += 1;
            let damping = damping(&parts, radius);
            let mut step = vec![0.0; x.len()];
            let mut predicted = 0.0;
            for (value, direction, slope) in &parts {
                let size = slope / (value * value + damping);
                step.iter_mut()
                    .zip(*direction)
                    .for_each(|(step, component)| *step -= size * component);
                predicted += size * size * (value * value + 2.0 * damping);
            }
            let step_length = norm(&step);
            if steps == 1 {
                radius = radius.min(step_length);
            }
            let moved = x.iter().zip(&step).zip(&scales);
            let moved: Vec<f64> = moved
                .map(|((x, step), scale)| if *scale > 0.0 { x + step / scale } else { *x })
                .collect();
            let there = residuals_at(&moved);
            let there_length = norm(there.as_ref());
            predicted /= length * length;
            let actual = 1.0 - (there_length / length) * (there_length / length);
            let ratio = if predicted > 0.0 { actual / predicted } else { 0.0 };
            if ratio <= 0.25 || ratio.is_nan() {
                // The minimum of a parabola through both sums with the slope here, within a tenth and a half.
                let slope =
                    parts.iter().map(|(value, _, slope)| slope * slope / (value * value + damping));
                let slope = -slope.sum::<f64>() / (length * length);
                let shrink = 0.5 * slope / (slope + 0.5 * actual);
                let shrink = if actual >= 0.0 { 0.5 } else { shrink.clamp(0.1, 0.5) };
                radius = shrink * radius.min(10.0 * step_length);
            } else if damping == 0.0 || ratio >= 0.75 {
                radius = 2.0 * step_length;
            }
            let is_better = ratio >= LEAST_RATIO;
            if is_better {
                (x, residuals, length) = (moved, there, there_length);
            }
            let is_flat = actual.abs() <= tolerance && predicted <= tolerance && ratio <= 2.0;
            if is_flat || radius <= tolerance * scaled(&x) {
                return Ok((x, length * length));
            }
            if steps >= MOST_STEPS * (scales.len() + 1) {
                return Err("it takes too many steps");
            }
            if is_better {
                break;
            }
        }
    }
}

/// The damping with which the step reaches the radius of the trust region, or 0 if the whole step is inside.
///
/// Newton's method for `1/|p(damping)| = 1/radius`, which is almost linear in the damping and converges from below (Nocedal
/// and Wright, Numerical Optimization, 2006, algorithm 4.3).
fn damping(parts: &[(f64, &[f64], f64)], radius: f64) -> f64 {
    let mut damping = 0.0;
    loop {
        let [mut square, mut cube] = [0.0; 2];
        for (value, _, slope) in parts {
            let damped = value * value + damping;
            square += (slope / damped) * (slope / damped);
            cube += (slope / damped) * (slope / damped) / damped;
        }
        let length = f64::sqrt(square);
        if length > (1.0 + RADIUS_SLACK) * radius {
            damping += square / cube * (length - radius) / radius;
        } else {
            return damping;
        }
    }
}
