//! Least squares inside the limits of the scene.

use super::FitError;
use super::least_squares::{LeastSquares, LeastSquaresFailure, minimise};
use super::misfit::Misfit;
use super::svd::dot;

/// Relative change of the misfit, and of the parameters, below which the iteration ends.
const TOLERANCE: f64 = 1e-12;

/// Why there is no Jacobian.
pub(super) const NO_DERIVATIVE: &str = "a parameter cannot be changed enough for a derivative: the scene refuses it, or a point is out of reach";

/// Residual of each point where the scene refuses the parameters, so large that no step goes there.
const REFUSED: f64 = 1e100;

/// The parameters of the least misfit, from those of the scene on.
///
/// Beyond a limit the misfit is continued as it is at the limit. Limits depend on the other parameters, and one that was
/// met may be left again: while the misfit shrinks, the iteration starts again from where it has ended.
pub(super) fn best(misfit: &Misfit<'_>) -> Result<Vec<f64>, FitError> {
    let (mut best, mut least) = (misfit.start(), f64::INFINITY);
    loop {
        let ranges = misfit.ranges(&misfit.scene(&best)?);
        let bounded = Bounded { misfit, ranges };
        let (end, sum) = minimise(&bounded, best.clone(), TOLERANCE).map_err(|why| {
            FitError::NotConverged(match why {
                LeastSquaresFailure::NoJacobian => NO_DERIVATIVE,
                LeastSquaresFailure::TooManySteps => "it takes too many steps",
                LeastSquaresFailure::NotFinite => "numbers overflow",
            })
        })?;
        let inside = bounded.inside(&end);
        let mut limits = inside.iter().zip(&bounded.ranges);
        let is_at_limit = limits.any(|(x, range)| range.contains(x));
        let is_better = sum < least * (1.0 - TOLERANCE);
        if is_better {
            (best, least) = (inside, sum);
        }
        if !(is_better && is_at_limit) {
            return Ok(best);
        }
    }
}

/// The misfit, continued beyond its limits.
struct Bounded<'a> {
    misfit: &'a Misfit<'a>,
    ranges: Vec<[f64; 2]>,
}

impl Bounded<'_> {
    /// The parameters, each moved to its limit if it is beyond.
    fn inside(&self, x: &[f64]) -> Vec<f64> {
        let pairs = x.iter().zip(&self.ranges);
        pairs
            .map(|(x, [least, most])| x.clamp(*least, *most))
            .collect()
    }
}

impl LeastSquares for Bounded<'_> {
    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let refused = || vec![REFUSED; self.misfit.points.points.len()];
        self.misfit
            .residuals(&self.inside(x))
            .unwrap_or_else(refused)
    }

    /// The columns of parameters that are beyond a limit, or would go there, are 0.
    fn jacobian(&self, x: &[f64], residuals: &[f64]) -> Option<Vec<Vec<f64>>> {
        let mut columns = self.misfit.jacobian(&self.inside(x), residuals)?;
        for ((column, [least, most]), x) in columns.iter_mut().zip(&self.ranges).zip(x) {
            let growth = dot(column, residuals);
            let stays =
                x < least || x > most || x == least && growth > 0.0 || x == most && growth < 0.0;
            if stays {
                column.fill(0.0);
            }
        }
        Some(columns)
    }
}
