//! Refinement: Newton's method in `f64` from the guesses for cells, and the outcome of each cell.
//!
//! A converged solution counts only on the stable sheet. Where Newton's method fails, the fold at the same distance decides: either the
//! target direction lies beyond it, or the fold's normal form gives a better start.

mod near_fold;
mod newton;

use crate::classify::Outcome;
use crate::sheet::Sheet;
use glam::DVec2;
use newton::newton;
use rayon::prelude::*;
use whiskmap_mechanics::shooting::FullState;
use whiskmap_mechanics::shooting::batch::{Method, chunk_size};

/// Residual, in whisker lengths, at which a state is accepted without another step.
pub const GOAL: f64 = 1e-12;

/// Residual, in whisker lengths, up to which a state is accepted when steps no longer help.
pub const TOLERANCE: f64 = 1e-11;

/// Maximum number of Newton steps before the fold is computed.
const STEPS: u32 = 8;

/// Maximum number of Newton steps from the fold's normal form.
const STEPS_NEAR_FOLD: u32 = 30;

/// Target of Newton's method for one cell: a guess and the pole to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellTarget {
    /// Index of the target's rod and sheet among those of the call.
    pub rod: u32,
    /// Start of Newton's method for the cell: contact and signed load `(tau, load)`, dimensionless.
    pub guess: DVec2,
    /// Target centre of the pole for the cell in the frame of the base, in whisker lengths.
    pub pole: DVec2,
}

/// Refined cell: its last state and the outcome.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// Last iterate of Newton's method in the cell: its solution if the outcome is a solution.
    pub state: ContactState,
    /// Number of Newton steps taken for the cell.
    pub steps: u32,
    /// Outcome of the refinement of the cell.
    pub outcome: Outcome,
}

impl Default for Refined {
    /// Returns a cell for which nothing is computed yet: contact and load are NaN, and the residual is infinite.
    fn default() -> Self {
        Self {
            state: ContactState {
                point: DVec2::NAN,
                full: FullState::default(),
                residual: f64::INFINITY,
            },
            steps: 0,
            outcome: Outcome::NotConverged,
        }
    }
}

/// State of the whisker at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactState {
    /// Contact coordinate and signed load of the state, `(tau, load)`, dimensionless.
    pub point: DVec2,
    /// Pole of the state with first derivatives, pose of the base, force and energy.
    pub full: FullState,
    /// Residual of the state: distance of the pole from its target, in whisker lengths; an upper bound if the last step is extrapolated.
    pub residual: f64,
}

impl ContactState {
    /// Returns true if the contact is at the tip of the rod of `sheet`, to the accuracy of residual and resolution.
    #[must_use]
    pub fn is_at_tip(&self, sheet: &Sheet) -> bool {
        sheet.is_at_tip(self.point.x, self.residual)
    }
}

/// Refines the guesses of `targets` by `method`, each on the sheet `sheets[target.rod]`. Returns one refined cell for each target,
/// `[target]`.
#[must_use]
pub fn refine(method: Method, sheets: &[&Sheet], targets: &[CellTarget]) -> Vec<Refined> {
    let mut cells = Vec::new();
    refine_into(method, sheets, targets, &mut cells);
    cells
}

/// Refines the guesses of `targets` like [`refine`], and writes one cell for each target into `cells`, whose memory is reused.
pub fn refine_into(
    method: Method,
    sheets: &[&Sheet],
    targets: &[CellTarget],
    cells: &mut Vec<Refined>,
) {
    cells.clear();
    cells.resize(targets.len(), Refined::default());
    let size = chunk_size(targets.len());
    let chunks = cells.par_chunks_mut(size).zip(targets.par_chunks(size));
    chunks.for_each(|(cells, targets)| refine_chunk(method, sheets, targets, cells));
}

fn refine_chunk(method: Method, sheets: &[&Sheet], targets: &[CellTarget], cells: &mut [Refined]) {
    let starts = targets.iter().map(|target| target.guess);
    let all: Vec<(usize, DVec2)> = starts.enumerate().collect();
    newton(method, sheets, targets, &all, STEPS, cells);
    let failed = (0..cells.len()).filter(|&i| cells[i].outcome == Outcome::NotConverged);
    let failed: Vec<usize> = failed.collect();
    let failed_targets: Vec<CellTarget> = failed.iter().map(|&i| targets[i]).collect();
    let starts = near_fold::starts(method, sheets, &failed_targets);
    let mut again = Vec::new();
    for (&i, start) in failed.iter().zip(starts) {
        match start {
            Ok(start) => again.push((i, start)),
            Err(outcome) => cells[i].outcome = outcome,
        }
    }
    let steps_before: Vec<u32> = again.iter().map(|(i, _)| cells[*i].steps).collect();
    newton(method, sheets, targets, &again, STEPS_NEAR_FOLD, cells);
    for ((i, _), steps) in again.iter().zip(steps_before) {
        cells[*i].steps += steps;
    }
}

/// Returns the stable states of `sheet` with their targets, `[state]`, for those of the signed push angles, in degrees, that are on its side. They
/// are sorted by row, then by magnitude of the push angle.
#[must_use]
pub fn states(
    method: Method,
    sheet: &Sheet,
    signed_pushes_deg: &[f64],
) -> Vec<(CellTarget, ContactState)> {
    let sign = sheet.side.sign();
    let pushes = signed_pushes_deg.iter().map(|push| push * sign);
    let mut pushes: Vec<f64> = pushes.filter(|p| *p >= 0.0).map(f64::to_radians).collect();
    pushes.sort_by(f64::total_cmp);
    let mut targets = Vec::new();
    for (row, place) in sheet.rows.iter().enumerate() {
        let guesses = sheet.guesses(row, &pushes);
        for (guess, push) in guesses.into_iter().zip(&pushes) {
            targets.extend(guess.map(|guess| CellTarget {
                rod: 0,
                guess,
                pole: place.pole(sign * push),
            }));
        }
    }
    let cells = refine(method, &[sheet], &targets);
    let solved = targets.into_iter().zip(cells);
    let solved = solved.filter(|(_, cell)| cell.outcome.is_solved());
    solved.map(|(target, cell)| (target, cell.state)).collect()
}
