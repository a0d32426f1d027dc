//! Cells next to the fold, where the Jacobian of Newton's method is singular.
//!
//! Along the level curve of `D` the direction of the pole has its maximum at the fold, `phi = phi_fold - c eta^2/2`. So the fold at the
//! target distance decides whether the target direction has a solution, and gives its `eta`.

use super::CellTarget;
use crate::classify::Outcome;
use crate::newton::LaneSharing;
use crate::sheet::{Edge, EdgeProblem, Sheet, edge_newton};
use glam::DVec2;
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::shooting::SecondVariation;
use whiskmap_mechanics::shooting::batch::Method;

/// Finds the fold at the distance of each target, from the target's guess, and compares directions. Returns for each target, `[target]`, the
/// `(tau, load)` at which Newton's method starts again, or the outcome: [`Outcome::BeyondFold`] if the target direction lies beyond the fold,
/// [`Outcome::NotConverged`] if the fold was not found.
pub fn starts(
    method: Method,
    sheets: &[&Sheet],
    targets: &[CellTarget],
) -> Vec<Result<DVec2, Outcome>> {
    let problems: Vec<EdgeProblem> = targets
        .iter()
        .map(|target| EdgeProblem {
            rod: &sheets[target.rod as usize].rod,
            edge: Edge::Fold,
            pole_distance: target.pole.length(),
            start: target.guess,
            second: None,
        })
        .collect();
    let folds = edge_newton(method, LaneSharing::EqualSteps, &problems);
    folds
        .into_iter()
        .zip(targets)
        .map(|(fold, target)| {
            if fold.has_converged {
                compare(sheets[target.rod as usize], target, fold.point, &fold.here)
                    .ok_or(Outcome::BeyondFold)
            } else {
                Err(Outcome::NotConverged)
            }
        })
        .collect()
}

/// Compares the fold `here`, at `point`, with the target direction. Returns the start of Newton's method; `None` beyond the fold.
fn compare(
    sheet: &Sheet,
    target: &CellTarget,
    point: DVec2,
    here: &SecondVariation,
) -> Option<DVec2> {
    let phi = here.map.pole.to_angle();
    let left = sheet.side.sign() * (phi - nearest_turn(target.pole.to_angle(), phi));
    if left < 0.0 {
        return None;
    }
    // Along the level curve of ln D, from the fold toward the stable side; `det` grows from 0 there.
    let along = DVec2::new(here.map.by_load.x, -here.map.by_tau.x);
    let det_slope = here.det_gradient().dot(along);
    // dphi/deta = -det, with eta in units of `along`.
    let eta = det_slope.signum() * (2.0 * left / det_slope.abs()).sqrt();
    Some(point + eta * along)
}
