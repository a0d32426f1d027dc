//! States that many cells are told from: exact but for rounding, mostly by one trajectory each.

use super::newton::verdict;
use super::{ContactState, End, Shot};
use crate::newton::{BatchNewton, NewtonOutcome, NewtonStep, Problem};
use crate::rod::{Rod, arclength};
use crate::sheet::Sheet;
use crate::shooting::batch::{Method, chunk_size};
use crate::shooting::{FirstVariation, limited};
use glam::DVec2;
use rayon::prelude::*;

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

/// Most trajectories of a state.
const TRAJECTORIES: u32 = 8;

/// The state of a whisker whose pole is where a shot wants it, to rounding.
struct NodeProblem<'a> {
    sheet: &'a Sheet,
    pole: DVec2,
    derivatives: FirstVariation,
}

impl<'a> Problem<'a> for NodeProblem<'a> {
    type Output = FirstVariation;

    fn rod(&self) -> &'a Rod {
        &self.sheet.rod
    }

    fn step(&mut self, at: DVec2, here: &FirstVariation) -> NewtonStep {
        self.derivatives = *here;
        let map = &here.full.map;
        let s = arclength(&self.sheet.rod, at.x);
        let (step, length) = limited(map.solve(map.residual(self.pole)), s, at.y);
        if length <= EXTRAPOLATED_STEP {
            NewtonStep::Extrapolate(step)
        } else {
            NewtonStep::Shoot(at + step)
        }
    }
}

/// The states of `shots`, each on the sheet `sheets[shot.rod]`; `None` where Newton's method fails, or leads off the sheet.
pub fn exact(method: Method, sheets: &[&Sheet], shots: &[Shot]) -> Vec<Option<Exact>> {
    let problem = |shot: &Shot| NodeProblem {
        sheet: sheets[shot.rod as usize],
        pole: shot.pole,
        derivatives: FirstVariation::default(),
    };
    let solve = |shots: &[Shot]| {
        let mut problems: Vec<NodeProblem> = shots.iter().map(problem).collect();
        let starts = shots.iter().map(|shot| DVec2::new(shot.tau, shot.load));
        let iterates = BatchNewton::new(method, TRAJECTORIES).solve(&mut problems, starts);
        let solved = problems.into_iter().zip(iterates).zip(shots);
        let solved = solved.map(|((problem, iterate), shot)| {
            let reached = ContactState {
                tau: iterate.point.x,
                load: iterate.point.y,
                full: iterate.state,
                residual: 0.0,
            };
            let has_converged = iterate.outcome == NewtonOutcome::Converged;
            let is_solved = has_converged && verdict(problem.sheet, shot, &reached) == End::Solved;
            is_solved.then_some(Exact {
                tau: reached.tau,
                load: reached.load,
                state: FirstVariation {
                    full: reached.full,
                    ..problem.derivatives
                },
            })
        });
        solved.collect::<Vec<_>>()
    };
    let chunks = shots.par_chunks(chunk_size(shots.len()));
    chunks.flat_map_iter(solve).collect()
}
