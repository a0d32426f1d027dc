//! Cells next to the fold, where the Jacobian of Newton's method is singular.
//!
//! Along the level curve of `D` the direction of the pole has its maximum at the fold, `phi = phi_fold - c eta^2/2`. So the fold at the
//! target distance decides whether the target direction has a solution, and gives its `eta`.

use super::CellTarget;
use crate::newton::LaneSharing;
use crate::sheet::{Edge, EdgeProblem, Sheet, edge_newton};
use glam::DVec2;
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::shooting::SecondVariation;
use whiskmap_mechanics::shooting::batch::Method;

/// Decision of the fold about a cell that Newton's method did not solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FoldVerdict {
    /// The cell has no solution: the target direction lies beyond the fold.
    Beyond,
    /// The cell may have a solution: Newton's method starts again at this `(tau, load)`.
    Start(DVec2),
    /// The fold was not found, so nothing follows for the cell.
    Unknown,
}

/// Finds the fold at the distance of each target, from the target's guess, and compares directions. Returns one verdict for each target,
/// `[target]`.
pub fn decide(method: Method, sheets: &[&Sheet], targets: &[CellTarget]) -> Vec<FoldVerdict> {
    let problems: Vec<EdgeProblem> = targets
        .iter()
        .map(|target| EdgeProblem {
            rod: &sheets[target.rod as usize].rod,
            edge: Edge::Fold,
            pole_distance: target.pole.length(),
            start: DVec2::new(target.tau, target.load),
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
            } else {
                FoldVerdict::Unknown
            }
        })
        .collect()
}

/// Compares the fold `here`, at `point`, with the target direction.
fn compare(
    sheet: &Sheet,
    target: &CellTarget,
    point: DVec2,
    here: &SecondVariation,
) -> FoldVerdict {
    let phi = here.map.pole.to_angle();
    let left = sheet.side.sign() * (phi - nearest_turn(target.pole.to_angle(), phi));
    if left < 0.0 {
        return FoldVerdict::Beyond;
    }
    // Along the level curve of ln D, from the fold toward the stable side; `det` grows from 0 there.
    let along = DVec2::new(here.map.by_load.x, -here.map.by_tau.x);
    let det_slope = here.det_gradient().dot(along);
    // dphi/deta = -det, with eta in units of `along`.
    let eta = det_slope.signum() * (2.0 * left / det_slope.abs()).sqrt();
    FoldVerdict::Start(point + eta * along)
}
