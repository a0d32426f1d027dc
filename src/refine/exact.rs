//! States that many cells are told from: exact but for rounding, mostly by one trajectory each.

use super::newton::verdict;
use super::{ContactState, End, Shot};
use crate::rod::arclength;
use crate::sheet::Sheet;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{FirstVariation, limited};

/// A state, exact but for rounding.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Everything else, with the derivatives of the last trajectory.
    pub state: FirstVariation,
}

/// The longest Newton step without a trajectory at its end. All cells of a reference inherit its miss, which is then
/// below rounding.
const EXTRAPOLATED_STEP: f64 = 3e-8;

/// Newton steps at most.
const ROUNDS: u32 = 8;

/// The states of `shots` by Newton's method; `None` where there is none on the sheet.
pub fn exact(method: Method, sheets: &[&Sheet], shots: &[Shot]) -> Vec<Option<Exact>> {
    let mut found = vec![None; shots.len()];
    let mut open: Vec<(usize, f64, f64)> = shots
        .iter()
        .enumerate()
        .map(|(i, shot)| (i, shot.tau, shot.load))
        .collect();
    for _ in 0..ROUNDS {
        let condition = |&(i, tau, load): &(usize, f64, f64)| InitialCondition {
            rod: &sheets[shots[i].rod as usize].rod,
            tau,
            load,
        };
        let conditions: Vec<InitialCondition> = open.iter().map(condition).collect();
        let states = Batch::new(method).shoot::<FirstVariation>(&conditions);
        let mut left = Vec::new();
        for ((i, tau, load), mut state) in open.into_iter().zip(states) {
            let (shot, map) = (&shots[i], state.full.map);
            let sheet = sheets[shot.rod as usize];
            let s = arclength(&sheet.rod, tau);
            let (step, length) = limited(map.solve(map.residual(shot.pole)), s, load);
            let (tau, load) = (tau + step.x, load + step.y);
            if length <= EXTRAPOLATED_STEP {
                state.full = state.extrapolated(step);
                let reached = ContactState {
                    tau,
                    load,
                    full: state.full,
                    residual: 0.0,
                };
                let is_solved = verdict(sheet, shot, &reached) == End::Solved;
                found[i] = is_solved.then_some(Exact { tau, load, state });
            } else if step.is_finite() && tau > 0.0 {
                left.push((i, tau, load));
            }
        }
        open = left;
    }
    found
}
