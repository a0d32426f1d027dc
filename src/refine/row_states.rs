//! Exact states at given row parameters: the points at which a row of constant distance `D` meets `load tau^2 = w`.
//!
//! Contact and load are the unknowns of `ln D(tau, load) = ln D_row` and `load tau^2 = w`. Along a stable row, `w` grows through the
//! fold, so the Jacobian is regular there, too.

use super::newton::verdict;
use super::{ContactState, RefineOutcome};
use crate::newton::{BatchNewton, NewtonOutcome, NewtonProblem, NewtonStep};
use crate::rod::{Rod, arclength};
use crate::sheet::{Guess, Sheet};
use crate::shooting::batch::{Method, chunk_size};
use crate::shooting::{FirstVariation, limited};
use glam::DVec2;
use rayon::prelude::*;

/// Target of a search for a state of a row at a row parameter.
#[derive(Clone, Copy, Debug)]
pub struct RowState<'a> {
    /// Stable sheet on which the state lies.
    pub sheet: &'a Sheet,
    /// Index of the state's row in the sheet.
    pub row: usize,
    /// Signed row parameter `load tau^2` of the state, dimensionless.
    pub w: f64,
    /// Contact coordinate `tau` near the state, dimensionless; the load follows from `w`.
    pub tau: f64,
}

/// State of a row that is exact to rounding.
#[derive(Clone, Copy, Debug)]
pub struct ExactState {
    /// Contact coordinate `tau` of the exact state, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` of the exact state, dimensionless.
    pub load: f64,
    /// Exact state, with the derivatives of the last trajectory.
    pub variation: FirstVariation,
}

/// Longest Newton step whose end is extrapolated where states are exact to rounding, as base points are: all cells of a base point inherit
/// its error.
const EXACT_STEP: f64 = 3e-8;

/// Maximum number of trajectories for each state.
const ROW_STATE_TRAJECTORIES: u32 = 8;

struct RowProblem<'a> {
    state: RowState<'a>,
    ln_distance: f64,
    derivatives: FirstVariation,
}

impl<'a> NewtonProblem<'a> for RowProblem<'a> {
    type Output = FirstVariation;

    fn rod(&self) -> &'a Rod {
        &self.state.sheet.rod
    }

    fn step(&mut self, at: DVec2, here: &FirstVariation) -> NewtonStep {
        self.derivatives = *here;
        let map = &here.full.map;
        let [by_tau, by_load] = [
            DVec2::new(map.by_tau.x, 2.0 * at.y * at.x),
            DVec2::new(map.by_load.x, at.x * at.x),
        ];
        let miss = DVec2::new(
            self.ln_distance - libm::log(map.pole.length()),
            self.state.w - at.y * at.x * at.x,
        );
        let step = DVec2::new(miss.perp_dot(by_load), by_tau.perp_dot(miss));
        let step = step / by_tau.perp_dot(by_load);
        let (step, length) = limited(step, arclength(self.rod(), at.x), at.y);
        if length <= EXACT_STEP {
            NewtonStep::Extrapolate(step)
        } else {
            NewtonStep::Shoot(at + step)
        }
    }
}

/// Finds the `states`, one result for each: `[state]`. A result is `None` where Newton's method fails, or leads off the stable sheet.
pub fn row_states(method: Method, states: &[RowState]) -> Vec<Option<ExactState>> {
    let chunks = states.par_chunks(chunk_size(states.len()));
    chunks
        .flat_map_iter(|states| solve(method, states))
        .collect()
}

fn solve<'a>(method: Method, states: &[RowState<'a>]) -> Vec<Option<ExactState>> {
    let problem = |state: &RowState<'a>| RowProblem {
        ln_distance: libm::log(state.sheet.rows[state.row].pole_distance),
        state: *state,
        derivatives: FirstVariation::default(),
    };
    let mut problems: Vec<RowProblem> = states.iter().map(problem).collect();
    let start = |state: &RowState| DVec2::new(state.tau, state.w / (state.tau * state.tau));
    let newton = BatchNewton::new(method, ROW_STATE_TRAJECTORIES);
    let iterates = newton.solve(&mut problems, states.iter().map(start));
    let exact = problems.iter().zip(iterates).map(|(problem, iterate)| {
        let reached = ContactState {
            tau: iterate.point.x,
            load: iterate.point.y,
            full: iterate.state,
            residual: 0.0,
        };
        let state = &problem.state;
        let (tau, load) = start(state).into();
        let guess = Guess { tau, load };
        let is_solved = iterate.outcome == NewtonOutcome::Converged
            && verdict(state.sheet, guess, &reached) == RefineOutcome::Solved;
        is_solved.then_some(ExactState {
            tau: reached.tau,
            load: reached.load,
            variation: FirstVariation {
                full: reached.full,
                ..problem.derivatives
            },
        })
    });
    exact.collect()
}
