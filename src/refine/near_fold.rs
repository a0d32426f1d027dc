//! Cells next to the fold, where Newton's method has a singular Jacobian.
//!
//! Along the level curve of `D` the direction of the pole has its maximum at the fold,
//! `phi = phi_fold - c eta^2/2`. So the fold at the wanted distance tells whether the wanted direction has a
//! solution at all, and `eta` where it is.

use super::Shot;
use crate::numerics::nearest_turn;
use crate::sheet::{Edge, EdgeProblem, EdgeStart, Sheet, edge_newton};
use crate::shooting::SecondVariation;
use crate::shooting::batch::Method;
use glam::DVec2;

/// What the fold says about a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// No solution: the wanted direction lies beyond the fold.
    Beyond,
    /// Newton's method should start at this `(tau, load)`.
    Start(DVec2),
    /// The fold was not found.
    Unknown,
}

/// Finds, for every shot, the fold at its distance, from its own guess, and compares.
pub fn decide(method: Method, sheets: &[&Sheet], shots: &[Shot]) -> Vec<Verdict> {
    let problems: Vec<EdgeProblem> = shots
        .iter()
        .map(|shot| EdgeProblem {
            rod: &sheets[shot.rod as usize].rod,
            edge: Edge::Fold,
            pole_distance: shot.pole.length(),
            start: DVec2::new(shot.tau, shot.load),
            second: None,
        })
        .collect();
    let folds = edge_newton(method, EdgeStart::Coarse, &problems);
    folds
        .into_iter()
        .zip(shots)
        .map(|(fold, shot)| {
            if fold.has_converged {
                compare(sheets[shot.rod as usize], shot, fold.point, &fold.here)
            } else {
                Verdict::Unknown
            }
        })
        .collect()
}

/// The fold `here`, at `point`, against the wanted direction.
fn compare(sheet: &Sheet, shot: &Shot, point: DVec2, here: &SecondVariation) -> Verdict {
    let phi = here.map.pole.to_angle();
    let left = sheet.side.sign() * (phi - nearest_turn(shot.pole.to_angle(), phi));
    if left < 0.0 {
        return Verdict::Beyond;
    }
    // Along the level curve of ln D, from the fold toward the stable side; `det` grows from 0 there.
    let along = DVec2::new(here.map.by_load.x, -here.map.by_tau.x);
    let det_slope = here.det_gradient().dot(along);
    // dphi/deta = -det, with eta counted in units of `along`.
    let eta = det_slope.signum() * (2.0 * left / det_slope.abs()).sqrt();
    Verdict::Start(point + eta * along)
}
