//! Least squares inside the limits of the scene.

use super::FitError;
use super::misfit::Misfit;
use crate::least_squares::search;

/// Message of a fit for which no Jacobian can be computed.
pub(super) const NO_JACOBIAN: &str = "a point has no derivative by a parameter: it is out of reach, at the reach, or where slip-off turns into pull-off";

/// Relative change of the misfit, and of the parameters, below which the iteration ends.
const TOLERANCE: f64 = 1e-12;

/// Factors of a start value for further searches.
const FACTORS: [f64; 6] = [0.25, 0.5, 0.75, 1.5, 2.0, 4.0];

/// Relative difference of the misfits of two different minima.
const LESS: f64 = 1e-6;

/// Returns the parameters with the smallest misfit that is found, each over its unit: `[parameter]`. The search starts at the scene's
/// values. It may end in a minimum that is only local: if a parameter is at a limit there, or a point detaches in another way than was
/// measured, further searches start at multiples of each start value.
pub(super) fn best(misfit: &Misfit<'_>) -> Result<Vec<f64>, FitError> {
    let start = misfit.start();
    let found = search(misfit, &start, TOLERANCE, NO_JACOBIAN);
    let (mut best, mut least) = found.map_err(FitError::NotConverged)?;
    let ranges = misfit.ranges(&misfit.scene(&best)?);
    let mut pairs = best.iter().zip(&ranges);
    if !pairs.any(|(x, range)| range.contains(x)) && !misfit.has_other_kinds(&best) {
        return Ok(best);
    }
    for (i, [lowest, highest]) in ranges.into_iter().enumerate() {
        for factor in FACTORS {
            if misfit.is_cancelled() {
                return Err(FitError::Cancelled);
            }
            let mut from = start.clone();
            from[i] = (factor * start[i]).clamp(lowest, highest);
            // The scene may refuse a start.
            if let Ok((end, sum)) = search(misfit, &from, TOLERANCE, NO_JACOBIAN)
                && sum < least * (1.0 - LESS)
            {
                (best, least) = (end, sum);
            }
        }
    }
    Ok(best)
}
