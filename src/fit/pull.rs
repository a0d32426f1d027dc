//! Pulls of points on the estimates of a fit, and outliers.

use super::covariance::Covariance;
use super::{Estimate, Fit, FitLoss};
use crate::least_squares::dot;
use crate::measured::MeasuredPoints;
use crate::quantile::median;
use crate::scene::{Parameter, digits, rounded};

/// Residual of an outlier, in standard deviations.
const FAR: f64 = 3.0;

/// Standard deviation of normal numbers over the median of their sizes.
const OF_MEDIAN: f64 = 1.482_602_218_505_602;

/// Pull of a point on a fit: how far an estimate would move without the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointPull {
    /// Line of the point in its file, from 1.
    pub line: usize,
    /// Measured less predicted angle, in degrees.
    pub residual_deg: f64,
    /// Weight of the point by the loss of its residual, between 0 and 1.
    pub weight: f64,
    /// Parameter whose estimate would move most without the point, in standard errors.
    pub parameter: Parameter,
    /// Change of that estimate without the point, to first order, in its standard errors.
    pub standard_errors: f64,
}

/// Returns the pulls of the `used` points on the estimates, the strongest first: `[point]`. `residuals` are predicted less measured angles in standard
/// deviations, with their `jacobian` by each parameter: `[parameter][point]`.
///
/// Without point `i` the estimates move by `C J_i psi_i / (1 - h_i)`. `C` is the covariance for residuals of variance 1, over the mean curvature
/// of the loss. `psi_i` is the weighted residual, and `h_i` the leverage of the point (Cook, Technometrics 19, 15, 1977).
pub(super) fn pulls(
    (loss, used): (FitLoss, &MeasuredPoints),
    (residuals, jacobian): (&[f64], &[Vec<f64>]),
    (covariance, variance): (&Covariance, Option<f64>),
    estimates: &[Estimate],
) -> Vec<PointPull> {
    let Some(variance) = variance.filter(|variance| *variance > 0.0) else {
        return Vec::new();
    };
    let curvatures = residuals.iter().map(|r| loss.curvature(*r));
    let mean = curvatures.sum::<f64>() / residuals.len() as f64;
    let pull = |(i, (point, &residual)): (usize, (&crate::measured::MeasuredPoint, &f64))| {
        let gradient: Vec<f64> = jacobian.iter().map(|column| column[i]).collect();
        let step = covariance.step(&gradient);
        let leverage = loss.curvature(residual) * dot(&gradient, &step) / mean;
        let weight = loss.weight(residual);
        let size = weight * residual / mean / (1.0 - leverage);
        let known = estimates.iter().enumerate();
        let known = known.filter(|(_, estimate)| estimate.standard_error.is_some());
        let moves = known.filter_map(|(k, estimate)| {
            let error = covariance.deviation(k)? * variance.sqrt();
            Some((estimate.parameter, size * step[k] / error))
        });
        // A point that alone determines a parameter has a leverage of 1.
        let moves = moves.filter(|(_, moved)| moved.is_finite());
        let (parameter, standard_errors) = moves.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        Some(PointPull {
            line: point.line,
            residual_deg: -residual * point.sd_deg,
            weight,
            parameter,
            standard_errors,
        })
    };
    let points = used.points.iter().zip(residuals).enumerate();
    let mut pulls: Vec<PointPull> = points.filter_map(pull).collect();
    pulls.sort_by(|a, b| b.standard_errors.abs().total_cmp(&a.standard_errors.abs()));
    pulls
}

/// Returns one line for each outlier of a fit to `points`: a residual of more than 3 standard deviations. Without deviations in the file, the median
/// of the residuals gives the standard deviation of all points.
pub(super) fn outliers(fit: &Fit, points: &MeasuredPoints) -> Vec<String> {
    let rows = fit.comparison.rows.iter();
    let residuals: Vec<(usize, f64, Option<f64>)> =
        rows.filter_map(|row| Some((row.line, row.residual_deg?, row.sd_deg))).collect();
    let median = median(residuals.iter().map(|(_, residual, _)| residual.abs()));
    let outlier = |&(line, residual, sd): &(usize, f64, Option<f64>)| {
        let deviations = (residual / sd.unwrap_or(OF_MEDIAN * median)).abs();
        let weight = fit.loss.weight(residual / sd.unwrap_or(1.0));
        (deviations > FAR).then(|| {
            let [residual, deviations, weight] = [residual, deviations, weight].map(|number| digits(rounded(number, 3)));
            format!("{}:{line}: outlier: residual {residual} deg, {deviations} standard deviations, weight {weight}", points.origin)
        })
    };
    residuals.iter().filter_map(outlier).collect()
}
