//! Least squares inside the limits of the scene.

use super::FitError;
use super::covariance::FAINT;
use super::misfit::Misfit;
use crate::least_squares::{dot, minimise, norm};

/// Message of a fit for which no Jacobian can be computed.
pub(super) const NO_JACOBIAN: &str = "a point has no derivative by a parameter: it is out of reach, at the reach, or where slip-off turns into pull-off";

/// Relative change of the misfit, and of the parameters, below which the iteration ends.
const TOLERANCE: f64 = 1e-12;

/// Residual of each point where the scene refuses the parameters, so large that no step goes there.
const REFUSED: f64 = 1e100;

/// Factors of a start value for further searches.
const FACTORS: [f64; 6] = [0.25, 0.5, 0.75, 1.5, 2.0, 4.0];

/// Relative difference of the misfits of two different minima.
const LESS: f64 = 1e-6;

/// Returns the parameters with the smallest misfit that is found, each over its unit: `[parameter]`. The search starts at the scene's
/// values. It may end in a minimum that is only local: if a parameter is at a limit there, or a point detaches in another way than was
/// measured, further searches start at multiples of each start value.
pub(super) fn best(misfit: &Misfit<'_>) -> Result<Vec<f64>, FitError> {
    let start = misfit.start();
    let (mut best, mut least) = search(misfit, &start)?;
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
            if let Ok((end, sum)) = search(misfit, &from)
                && sum < least * (1.0 - LESS)
            {
                (best, least) = (end, sum);
            }
        }
    }
    Ok(best)
}

/// Returns the parameters at the minimum to which a search from `start` leads, and the misfit there.
///
/// Beyond a limit the misfit is continued as it is at the limit. Limits depend on the other parameters, and one that was
/// met may be left again: while the misfit shrinks, the iteration starts again from where it has ended. Parameters on which no residual
/// depends stay.
fn search(misfit: &Misfit<'_>, start: &[f64]) -> Result<(Vec<f64>, f64), FitError> {
    let (mut best, mut least) = (start.to_vec(), f64::INFINITY);
    loop {
        let ranges = misfit.ranges(&misfit.scene(&best)?);
        let inside = |x: &[f64]| -> Vec<f64> {
            let pairs = x.iter().zip(&ranges);
            pairs
                .map(|(x, [least, most])| x.clamp(*least, *most))
                .collect()
        };
        let residuals = |x: &[f64]| {
            let refused = || vec![REFUSED; misfit.points.points.len()];
            misfit.residuals(&inside(x)).unwrap_or_else(refused)
        };
        // The columns of parameters that are beyond a limit, or would go there, are 0.
        let jacobian = |x: &[f64], residuals: &[f64]| {
            let mut columns = misfit.jacobian(&inside(x)).ok_or(NO_JACOBIAN)?;
            clear_faint(&mut columns);
            for ((column, [least, most]), x) in columns.iter_mut().zip(&ranges).zip(x) {
                let growth = dot(column, residuals);
                let is_held = x < least
                    || x > most
                    || x == least && growth > 0.0
                    || x == most && growth < 0.0;
                if is_held {
                    column.fill(0.0);
                }
            }
            Ok(columns)
        };
        let (end, sum) = minimise(residuals, jacobian, best.clone(), TOLERANCE)
            .map_err(FitError::NotConverged)?;
        let end = inside(&end);
        let is_at_limit = end.iter().zip(&ranges).any(|(x, range)| range.contains(x));
        let is_better = sum < least * (1.0 - TOLERANCE);
        if is_better {
            (best, least) = (end, sum);
        }
        if !(is_better && is_at_limit) {
            return Ok((best, least));
        }
    }
}

/// Clears the columns that are so short that rounding may have made them.
fn clear_faint(columns: &mut [Vec<f64>]) {
    let longest = columns
        .iter()
        .map(|column| norm(column))
        .fold(0.0, f64::max);
    for column in columns {
        if norm(column) <= FAINT * longest {
            column.fill(0.0);
        }
    }
}
