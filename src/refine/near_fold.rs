//! Cells next to the fold, where Newton's method has a singular Jacobian.
//!
//! Along the level curve of `D` the direction of the pole has its maximum at the fold,
//! `phi = phi_fold - c eta^2/2`. So the fold at the wanted distance tells whether the wanted direction has a
//! solution at all, and `eta` where it is.

use crate::integrate::Shot;
use crate::model::batch::{Launch, Method, land};
use crate::model::{Curved, Dopri8, Second, arclength, limited};
use crate::sheet::{Sheet, fold_step, nearest_turn};
use glam::DVec2;

/// What the fold says about a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// No solution: the wanted direction lies beyond the fold.
    Beyond,
    /// Newton's method should start here, at `(tau, load)`.
    Start((f64, f64)),
    /// The fold was not found.
    Unknown,
}

/// Rounds of Newton's method for the fold.
const ROUNDS: usize = 20;

/// Finds, for every shot, the fold at its distance, from its own guess, and compares.
pub fn decide(method: Method, sheets: &[&Sheet], shots: &[Shot]) -> Vec<Verdict> {
    let mut points: Vec<DVec2> = shots.iter().map(|s| DVec2::new(s.tau, s.load)).collect();
    let mut verdicts = vec![Verdict::Unknown; shots.len()];
    let mut open: Vec<usize> = (0..shots.len()).collect();
    for _ in 0..ROUNDS {
        let launches: Vec<Launch> = open
            .iter()
            .map(|&i| Launch {
                rod: sheets[shots[i].rod as usize].rod,
                tau: points[i].x,
                load: points[i].y,
            })
            .collect();
        let mut landings = land::<Dopri8, Second, 15>(method, &launches).into_iter();
        let mut launches = launches.iter();
        open.retain(|&i| {
            let (Some(here), Some(launch)) = (landings.next(), launches.next()) else {
                return false;
            };
            let miss = (shots[i].pole.length() / here.landing.pole.length()).ln();
            let s = arclength(&launch.rod, launch.tau);
            let (step, length) = limited(fold_step(&here, miss), s, launch.load);
            if length < 1e-9 {
                verdicts[i] = compare(sheets[shots[i].rod as usize], &shots[i], points[i], &here);
                return false;
            }
            points[i] += step;
            step.is_finite() && points[i].x > 0.0
        });
    }
    verdicts
}

/// The fold `here`, at `point`, against the wanted direction.
fn compare(sheet: &Sheet, shot: &Shot, point: DVec2, here: &Curved) -> Verdict {
    let phi = here.landing.pole.to_angle();
    let left = sheet.side.sign() * (phi - nearest_turn(shot.pole.to_angle(), phi));
    if left < 0.0 {
        return Verdict::Beyond;
    }
    // Along the level curve of ln D, from the fold toward the stable side; `det` grows from 0 there.
    let along = DVec2::new(here.landing.by_load.x, -here.landing.by_tau.x);
    let det_slope = here.det_gradient().dot(along);
    // dphi/deta = -det, with eta counted in units of `along`.
    let eta = det_slope.signum() * (2.0 * left / det_slope.abs()).sqrt();
    let start = point + eta * along;
    Verdict::Start((start.x, start.y))
}
