//! Least squares inside the limits of the scene.

use super::FitError;
use super::least_squares::minimise;
use super::misfit::Misfit;
use super::svd::dot;

/// Relative change of the misfit, and of the parameters, below which the iteration ends.
const TOLERANCE: f64 = 1e-12;

/// Residual of each point where the scene refuses the parameters, so large that no step goes there.
const REFUSED: f64 = 1e100;

/// Returns the parameters with the smallest misfit, each over its unit: `[parameter]`. The search starts at the scene's values.
///
/// Beyond a limit the misfit is continued as it is at the limit. Limits depend on the other parameters, and one that was
/// met may be left again: while the misfit shrinks, the iteration starts again from where it has ended.
pub(super) fn best(misfit: &Misfit<'_>) -> Result<Vec<f64>, FitError> {
    let (mut best, mut least) = (misfit.start(), f64::INFINITY);
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
            let mut columns = misfit.jacobian(&inside(x))?;
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
            Some(columns)
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
            return Ok(best);
        }
    }
}
