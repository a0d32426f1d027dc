//! Levenberg and Marquardt's method inside the limits of the scene.

use super::Error;
use super::misfit::Misfit;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};

/// Relative change of the misfit, and of the parameters, below which the iteration ends.
const TOLERANCE: f64 = 1e-12;

/// Why there is no Jacobian.
pub(super) const NO_DERIVATIVE: &str = "a parameter cannot be changed enough for a derivative: the scene refuses it, or a point is out of reach";

/// The residual of each point where there is none, so large that the step to there is taken back.
const REFUSED: f64 = 1e100;

/// The parameters of the least misfit, from those of the scene on.
///
/// Beyond a limit the misfit is continued as it is at the limit. Limits depend on the other parameters, and one that was
/// met may be left again: while the misfit shrinks, the iteration starts again from where it has ended.
pub(super) fn minimise(misfit: &Misfit<'_>) -> Result<DVector<f64>, Error> {
    let (mut best, mut least) = (misfit.start(), f64::INFINITY);
    loop {
        let scene = misfit.scene(&best)?;
        let problem = Problem {
            ranges: misfit.ranges(&scene),
            misfit,
            at: best.clone(),
        };
        let method = LevenbergMarquardt::new().with_tol(TOLERANCE);
        let (end, report) = method.minimize(problem);
        let has_ended = report.termination.was_successful()
            || matches!(
                report.termination,
                TerminationReason::NoImprovementPossible(_)
            );
        if !has_ended {
            return Err(Error::NotConverged(why(&report.termination)));
        }
        let is_better = report.objective_function < least * (1.0 - TOLERANCE);
        if is_better {
            (best, least) = (end.inside(), report.objective_function);
        }
        if !(is_better && end.is_at_limit()) {
            return Ok(best);
        }
    }
}

/// Why the iteration has ended early.
fn why(termination: &TerminationReason) -> &'static str {
    match termination {
        TerminationReason::User(_) => NO_DERIVATIVE,
        TerminationReason::LostPatience => "it takes too many steps",
        _ => "numbers overflow",
    }
}

/// The misfit, continued beyond its limits.
struct Problem<'a> {
    misfit: &'a Misfit<'a>,
    ranges: Vec<[f64; 2]>,
    at: DVector<f64>,
}

impl Problem<'_> {
    /// The parameters, those beyond a limit at the limit.
    fn inside(&self) -> DVector<f64> {
        let inside = self.at.iter().zip(&self.ranges);
        let inside = inside.map(|(x, [least, most])| x.clamp(*least, *most));
        DVector::from_iterator(self.at.len(), inside)
    }

    fn is_at_limit(&self) -> bool {
        let inside = self.inside();
        inside
            .iter()
            .zip(&self.ranges)
            .any(|(x, range)| range.contains(x))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        self.at.copy_from(x);
    }

    fn params(&self) -> DVector<f64> {
        self.at.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let refused = || DVector::repeat(self.misfit.points.points.len(), REFUSED);
        Some(
            self.misfit
                .residuals(&self.inside())
                .unwrap_or_else(refused),
        )
    }

    /// Without the columns of parameters that are beyond a limit, or would go there.
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let inside = self.inside();
        let residuals = self.misfit.residuals(&inside)?;
        let mut jacobian = self.misfit.jacobian(&inside, &residuals)?;
        for (i, [least, most]) in self.ranges.iter().enumerate() {
            let growth = jacobian.column(i).dot(&residuals);
            let x = self.at[i];
            let stays = x < *least
                || x > *most
                || x == *least && growth > 0.0
                || x == *most && growth < 0.0;
            if stays {
                jacobian.column_mut(i).fill(0.0);
            }
        }
        Some(jacobian)
    }
}
