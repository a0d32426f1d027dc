//! Fits of parameters of a scene to measured detachments, by nonlinear least squares.
//!
//! The misfit is the sum of the losses of measured less predicted angles, each over its standard deviation: squares, or a loss that outliers
//! hardly change ([`FitLoss`]). Levenberg and Marquardt's method
//! minimises it inside the limits of the scene (`bounded`), with exact derivatives. Angles are continuous where slip-off turns into
//! pull-off, but their derivatives are not: the trust region limits steps there.

mod bounded;
mod covariance;
mod loss;
mod misfit;
mod pull;
mod start;
mod verdict;

pub use loss::FitLoss;
pub use pull::PointPull;
pub use start::MovedStart;
pub use verdict::{LikelyCause, NotAFit};

use crate::input::{CsvError, each_once};
use crate::measured::{Comparison, MeasuredPoints};
use crate::scene::{Parameter, Scene, SceneError, digits, rounded};
use bounded::{NO_JACOBIAN, best};
use covariance::Covariance;
use misfit::Misfit;
use pull::pulls;
use start::within_reach;
use std::sync::atomic::AtomicBool;

/// Result of a fit: the fitted scene, parameters, correlations and chi-square.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Scene with the fitted values.
    pub scene: Scene,
    /// Fitted parameters, `[parameter]`, in the order of the free parameters.
    pub estimates: Vec<Estimate>,
    /// Correlations of fitted parameters, `[parameter][parameter]`; `None` for a pair with a parameter that is not determined.
    pub correlation: Vec<Vec<Option<f64>>>,
    /// Loss of residuals that the fit minimises.
    pub loss: FitLoss,
    /// Sum of the losses of residuals over standard deviations, which are 1 degree if the points have none: chi-square for squares.
    pub chi_square: f64,
    /// Degrees of freedom of the fit: points used less the number of parameters that they determine.
    pub degrees_of_freedom: usize,
    /// Measured points with the predictions of the fitted scene.
    pub comparison: Comparison,
    /// Points with their pull on the estimates, the strongest pull first: `[point]`. Empty without standard errors.
    pub pulls: Vec<PointPull>,
    /// Parameter that does not start at the scene's value, because the scene's whisker does not reach a point; `None` without one.
    pub moved: Option<MovedStart>,
    /// Reason why the best values are not a fit; `None` for a fit. Without a fit there are no standard errors and no correlations.
    pub not_a_fit: Option<NotAFit>,
}

impl Fit {
    /// Returns one line for each point that is left out, each parameter at a limit, and each parameter that the points do not determine.
    /// Residuals that are larger than their standard deviations have one line. With another loss than squares, each outlier has a line. `points` are
    /// the points of the fit.
    #[must_use]
    pub fn warnings(&self, points: &MeasuredPoints) -> Vec<String> {
        let is_fit = self.not_a_fit.is_none();
        let of_parameter = |estimate: &Estimate| {
            let name = estimate.parameter.name();
            if estimate.is_at_limit {
                let value = digits(estimate.value);
                return Some(format!(
                    "{name}: {value} is the last value that the scene accepts, so there is no standard error"
                ));
            }
            let is_free = is_fit && estimate.standard_error.is_none();
            is_free.then(|| format!("{name}: not determined by these points"))
        };
        // With another loss, the residuals give the standard errors.
        let has_squares = self.loss == FitLoss::Squares;
        let is_large = is_fit && has_squares && points.have_deviations && !self.is_explained();
        let large = is_large.then(|| {
            let ratio = (self.chi_square / self.degrees_of_freedom.max(1) as f64).sqrt();
            format!(
                "residuals are {ratio:.1} times as large as sd_deg: standard errors are too small by about that factor"
            )
        });
        let parameters = self.estimates.iter().filter_map(of_parameter);
        let left_out = points.left_out(&self.comparison).into_iter();
        let outliers = (is_fit && !has_squares).then(|| pull::outliers(self, points));
        let outliers = outliers.into_iter().flatten();
        left_out.chain(parameters).chain(large).chain(outliers).collect()
    }

    /// Returns one line for the parameter that does not start at its value in `scene`; `None` without one. `scene` and `points` are those
    /// of the fit.
    #[must_use]
    pub fn moved_start(&self, scene: &Scene, points: &MeasuredPoints) -> Option<String> {
        let MovedStart { parameter, value, line, distance_mm } = self.moved?;
        let scene_value = parameter.value(scene).unwrap_or(f64::NAN);
        let [distance, start, scene_value] =
            [distance_mm, value, scene_value].map(|number| digits(rounded(number, 6)));
        Some(format!(
            "{}:{line}: {distance} mm is out of reach of the scene's whisker: {} starts at {start} instead of {scene_value}",
            points.origin,
            parameter.name()
        ))
    }

    /// Returns true if the standard deviations of the points explain `chi_square`. If not, the deviations are too small, and so
    /// are the standard errors.
    #[must_use]
    pub fn is_explained(&self) -> bool {
        verdict::is_explained(self.chi_square, self.degrees_of_freedom)
    }
}

/// Fitted parameter: its value and standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Parameter of the scene that was fitted.
    pub parameter: Parameter,
    /// Best value of the fitted parameter, in its unit; if it is not determined, one of many that fit as well.
    pub value: f64,
    /// Standard error of the fitted parameter, in its unit; `None` if it is not determined, at a limit, and without a fit.
    pub standard_error: Option<f64>,
    /// True if the fitted value is the least or the greatest one that the scene accepts.
    pub is_at_limit: bool,
}

/// Error of a fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// No parameter of the fit is free.
    #[error("no parameter is free")]
    NothingFree,
    /// The scene does not give a free parameter of the fit.
    #[error("{}: the scene has no {}; give it a value to start from, or free some of {has}", .parameter.name(), .parameter.key())]
    Lacking {
        /// Free parameter that the scene does not give.
        parameter: Parameter,
        /// Names of the parameters that the scene gives.
        has: String,
    },
    /// Two free parameters of the fit are one number of the scene.
    #[error("{} and {}: both are {}; one of them may be free", .0.name(), .1.name(), .0.key())]
    Twice(Parameter, Parameter),
    /// A free parameter is a column of the table of whiskers, so that they do not share its value.
    #[error("{}: whiskers.table has the column {}; only a number that all whiskers share may be free", .0.name(), .1)]
    Column(Parameter, &'static str),
    /// The rest of the scene leaves a free parameter no range.
    #[error("{}: the rest of the scene allows no values but {} to {}", .parameter.name(), digits(.range[0]), digits(.range[1]))]
    Held {
        /// Free parameter without a range.
        parameter: Parameter,
        /// Values `[least, greatest]` of the parameter that the scene allows, in its unit.
        range: [f64; 2],
    },
    /// The scene refuses values of the fit.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene's whisker does not touch a pole at some measured point.
    #[error(transparent)]
    Points(#[from] CsvError),
    /// The fit has fewer points than free parameters.
    #[error("{free} free parameters need as many points: {origin} has {used} that detach")]
    TooFew {
        /// Name of the file of the measured points.
        origin: String,
        /// Number of free parameters of the fit.
        free: usize,
        /// Number of points that detach.
        used: usize,
    },
    /// The iteration of the fit has not reached a minimum.
    #[error("the fit has not converged: {0}")]
    NotConverged(&'static str),
    /// The fit was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Width of a range, relative to the value, below which there is nothing to fit.
const NARROWEST: f64 = 1e-6;

/// Fits the `free` parameters of the scene's first whisker and of its pole to `points`, starting at the scene's values. If the scene's
/// whisker does not reach a point, one free parameter starts at a value with which it does: [`Fit::moved`].
///
/// If the points name their whiskers, each is compared with the whisker of its name in the scene's table, and the whiskers share the free
/// parameters.
///
/// Points whose side never detaches at these values are left out; in [`Fit::comparison`] they have no residual.
///
/// ```
/// use whiskmap::measured::MeasuredPoints;
/// use whiskmap::scene::{Parameter, Scene};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let points = MeasuredPoints::parse("side,distance_mm,push_angle_deg\ncb,15.6604597633658,15.60793\n", "points.csv")?;
/// let start = cone.with(Parameter::TipRadiusUm, 3.0)?;
/// let fit = whiskmap::fit(&start, &points, &[Parameter::TipRadiusUm])?;
/// assert!((fit.estimates[0].value - 1.5).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If a parameter cannot be free, a name is not in the table, a point is beyond the whisker for every tried start, points are too few, or the
/// iteration does not converge.
pub fn fit(scene: &Scene, points: &MeasuredPoints, free: &[Parameter]) -> Result<Fit, FitError> {
    fit_until(scene, points, free, FitLoss::Squares, &AtomicBool::new(false))
}

/// Fits parameters as [`fit`] does, with a loss of residuals. The scale of the loss is the standard deviation of each point, which is 1 degree if
/// the points have none. With another loss than squares, the standard errors come from the scatter of the residuals: Huber's estimate for
/// M-estimators (Huber, Robust Statistics, 1981, section 7.6; `H1` of statsmodels). If `cancel` is true, the function soon returns an error.
///
/// # Errors
/// Fails as [`fit`] does, and if it is cancelled.
pub fn fit_until(
    scene: &Scene,
    points: &MeasuredPoints,
    free: &[Parameter],
    loss: FitLoss,
    cancel: &AtomicBool,
) -> Result<Fit, FitError> {
    let free = &each_once(free)[..];
    check(scene, free)?;
    let (start, moved) = within_reach(scene, points, free)?;
    let scene = &start;
    let used = points.detaching(&points.whiskers_in(scene)?);
    if used.points.len() < free.len() {
        return Err(FitError::TooFew {
            origin: points.origin.clone(),
            free: free.len(),
            used: used.points.len(),
        });
    }
    let misfit = Misfit::new(scene, &used, free, loss, cancel);
    let best = best(&misfit)?;
    let fitted = misfit.scene(&best)?;
    let place = misfit.place(&best).and_then(|place| {
        let jacobian = misfit.jacobian(&best, &place)?;
        Some((place.residuals, jacobian))
    });
    let (here, mut jacobian) = place.ok_or(FitError::NotConverged(NO_JACOBIAN))?;
    let ranges = misfit.ranges(&fitted);
    let is_at_limit = |i: usize| ranges[i].contains(&best[i]);
    // The limit determines such a parameter, not the points.
    for i in (0..free.len()).filter(|i| is_at_limit(*i)) {
        jacobian[i].fill(0.0);
    }
    let covariance = Covariance::new(&jacobian);
    let chi_square: f64 = here.iter().map(|r| loss.of(*r)).sum();
    let degrees_of_freedom = used.points.len() - covariance.rank;
    // Without standard deviations, the residuals give the variance of the points.
    let variance = match (used.have_deviations, degrees_of_freedom) {
        (true, _) if loss == FitLoss::Squares => Some(1.0),
        (_, 0) => None,
        (_, freedom) => variance(loss, &here, freedom),
    };
    let comparison = points.beside_all(&points.whiskers_in(&fitted)?);
    let not_a_fit =
        NotAFit::new(&used, scene, rms_deg(loss, &here, &used), chi_square, degrees_of_freedom);
    let estimate = |(i, [least, most]): (usize, &[f64; 2])| {
        let (value, unit) = (best[i], misfit.units[i]);
        let error = covariance.deviation(i).zip(variance);
        let error = error.map(|(deviation, variance)| deviation * variance.sqrt());
        Estimate {
            parameter: free[i],
            value: unit * value,
            standard_error: error
                .filter(|error| *error < most - least && not_a_fit.is_none())
                .map(|error| unit * error),
            is_at_limit: is_at_limit(i),
        }
    };
    let estimates: Vec<Estimate> = ranges.iter().enumerate().map(estimate).collect();
    let is_known = |i: usize| estimates[i].standard_error.is_some();
    let correlation = |i, j| covariance.correlation(i, j).filter(|_| is_known(i) && is_known(j));
    let all = || 0..free.len();
    let pulls = pulls((loss, &used), (&here, &jacobian), (&covariance, variance), &estimates);
    Ok(Fit {
        loss,
        pulls,
        correlation: all().map(|i| all().map(|j| correlation(i, j)).collect()).collect(),
        chi_square,
        degrees_of_freedom,
        comparison,
        moved,
        not_a_fit,
        scene: fitted,
        estimates,
    })
}

/// Checks that the parameters can be free.
fn check(scene: &Scene, free: &[Parameter]) -> Result<(), FitError> {
    if free.is_empty() {
        return Err(FitError::NothingFree);
    }
    for (i, &parameter) in free.iter().enumerate() {
        let same = free[..i].iter().find(|other| other.key() == parameter.key());
        if let Some(same) = same {
            return Err(FitError::Twice(*same, parameter));
        }
        let value = parameter
            .value(scene)
            .ok_or_else(|| FitError::Lacking { parameter, has: Parameter::given(scene) })?;
        if let Some(column) = scene.column_of(parameter) {
            return Err(FitError::Column(parameter, column));
        }
        let range @ [least, most] = parameter.range(scene);
        if most - least < NARROWEST * value.abs() {
            return Err(FitError::Held { parameter, range });
        }
    }
    Ok(())
}

/// Returns the variance of residuals of variance 1 that gives standard errors: the mean of the squared pulls over the square of the mean
/// curvature of the loss, with Huber's correction for few points. For squares it is chi-square over the degrees of freedom. `None` if all
/// residuals are on the linear part of the loss.
fn variance(loss: FitLoss, residuals: &[f64], freedom: usize) -> Option<f64> {
    let count = residuals.len() as f64;
    let pulls: f64 = residuals.iter().map(|r| (loss.weight(*r) * r).powi(2)).sum();
    let curvatures = || residuals.iter().map(|r| loss.curvature(*r));
    let mean = curvatures().sum::<f64>() / count;
    let spread = curvatures().map(|curvature| (curvature - mean).powi(2)).sum::<f64>() / count;
    let parameters = count - freedom as f64;
    let few = 1.0 + parameters / count * spread / (mean * mean);
    let variance = few * few * pulls / freedom as f64 / (mean * mean);
    Some(variance).filter(|variance| variance.is_finite())
}

/// Returns the root mean square of the residuals in degrees, with the weights of the loss; `None` without residuals.
fn rms_deg(loss: FitLoss, residuals: &[f64], used: &MeasuredPoints) -> Option<f64> {
    let weighted = residuals.iter().zip(&used.points);
    let [squares, weights] = weighted.fold([0.0; 2], |[squares, weights], (r, point)| {
        let weight = loss.weight(*r);
        [squares + weight * (r * point.sd_deg).powi(2), weights + weight]
    });
    (weights > 0.0).then(|| (squares / weights).sqrt())
}
