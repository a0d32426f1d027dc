//! Least squares inside limits.

use super::{dot, minimise, norm};

/// Residual where a problem has none, so large that no step goes there.
const REFUSED: f64 = 1e100;

/// Least singular value over the largest, and least column over the longest, that counts: the steps of least squares and measured
/// values are not more exact.
pub const FAINT: f64 = 1e-6;

/// Residuals as a function of parameters with limits.
pub trait BoundedProblem {
    /// Number of residuals.
    fn count(&self) -> usize;

    /// Returns the residuals at the parameters `x`, `[residual]`; `None` where there are none.
    fn residuals(&self, x: &[f64]) -> Option<Vec<f64>>;

    /// Returns the columns of the Jacobian at `x`, where the residuals are `residuals`: `[parameter][residual]`.
    fn jacobian(&self, x: &[f64], residuals: &[f64]) -> Option<Vec<Vec<f64>>>;

    /// Returns the range `[least, greatest]` of each parameter with the others as in `x`: `[parameter]`.
    fn ranges(&self, x: &[f64]) -> Vec<[f64; 2]>;
}

/// Returns the parameters at the minimum of the sum of squares to which a search from `start` leads, and the sum there.
///
/// Beyond a limit the residuals are continued as they are at the limit. Limits depend on the other parameters, and one that was
/// met may be left again: while the sum shrinks, the iteration starts again from where it has ended. Parameters on which no residual
/// depends stay.
///
/// # Errors
/// The reason why the iteration ends before it converges; `no_jacobian` if a Jacobian is missing.
pub fn search(
    problem: &impl BoundedProblem,
    start: &[f64],
    tolerance: f64,
    no_jacobian: &'static str,
) -> Result<(Vec<f64>, f64), &'static str> {
    let (mut best, mut least) = (start.to_vec(), f64::INFINITY);
    loop {
        let ranges = problem.ranges(&best);
        let inside = |x: &[f64]| -> Vec<f64> {
            let pairs = x.iter().zip(&ranges);
            pairs
                .map(|(x, [least, most])| x.clamp(*least, *most))
                .collect()
        };
        let residuals = |x: &[f64]| {
            let refused = || vec![REFUSED; problem.count()];
            problem.residuals(&inside(x)).unwrap_or_else(refused)
        };
        // The columns of parameters that are beyond a limit, or would go there, are 0.
        let jacobian = |x: &[f64], residuals: &[f64]| {
            let mut columns = problem.jacobian(&inside(x), residuals).ok_or(no_jacobian)?;
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
        let (end, sum) = minimise(residuals, jacobian, best.clone(), tolerance)?;
        let end = inside(&end);
        let is_at_limit = end.iter().zip(&ranges).any(|(x, range)| range.contains(x));
        let is_better = sum < least * (1.0 - tolerance);
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
