//! Refinement: Newton's method in `f64` from the lattice's guesses, and the verdict.
//!
//! "Newton converged" is not "still on the pole": a solution counts only on the stable sheet. Where Newton's
//! method fails, the fold at the same distance decides: either the wanted direction lies beyond it, or the
//! fold's normal form gives the start that Newton's method needs.

mod base_points;
mod near_fold;
mod newton;
mod row_states;

pub use base_points::{RowOfCells, base_points};

use crate::sheet::{Guess, Sheet};
use crate::shooting::FullState;
use crate::shooting::batch::{Method, chunk_size};
use glam::DVec2;
use near_fold::FoldVerdict;
use newton::newton;
use rayon::prelude::*;

/// Residual, in whisker lengths, at which a state is accepted without another step.
pub const GOAL: f64 = 1e-12;

/// Residual, in whisker lengths, up to which a state is accepted when steps no longer help.
pub const TOLERANCE: f64 = 1e-11;

/// Contacts closer to the tip than this, relative to `tau` there, or than the residual, count as at the tip.
const TIP_TIE: f64 = 1e-12;

/// Newton steps before the fold is asked.
const STEPS: u32 = 8;

/// Newton steps from the fold's normal form.
const STEPS_NEAR_FOLD: u32 = 30;

/// A shooting problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellTarget {
    /// Which of the rods of the call.
    pub rod: u32,
    /// Guess for `tau` of the contact.
    pub tau: f64,
    /// Guess for the signed load `f/rho^2`.
    pub load: f64,
    /// Wanted centre of the pole in the frame of the base, in whisker lengths.
    pub pole: DVec2,
}

impl CellTarget {
    /// Where Newton's method starts.
    #[must_use]
    pub const fn guess(&self) -> Guess {
        Guess {
            tau: self.tau,
            load: self.load,
        }
    }
}

/// What became of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// The last state computed.
    pub state: ContactState,
    /// Newton steps taken here.
    pub steps: u32,
    /// The verdict.
    pub outcome: RefineOutcome,
}

impl Default for Refined {
    /// Nothing computed yet.
    fn default() -> Self {
        Self {
            state: ContactState {
                tau: f64::NAN,
                load: f64::NAN,
                full: FullState::default(),
                residual: f64::INFINITY,
            },
            steps: 0,
            outcome: RefineOutcome::NotConverged,
        }
    }
}

/// A state of the whisker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactState {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Everything else.
    pub full: FullState,
    /// Distance of the pole from the wanted place, in whisker lengths; a bound on it where the last step was so short that no
    /// trajectory followed it.
    pub residual: f64,
}

impl ContactState {
    /// Whether the contact is at the tip of the rod of `sheet`, as far as residual and resolution tell.
    #[must_use]
    pub fn is_at_tip(&self, sheet: &Sheet) -> bool {
        let [tau, radius] = sheet.tip;
        (self.tau - tau).abs() <= TIP_TIE * tau + self.residual / radius + sheet.tip_blur()
    }
}

/// The verdict on a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefineOutcome {
    /// A stable state.
    Solved,
    /// A stable state of a longer whisker: the contact lies beyond the tip.
    BeyondTip,
    /// The wanted direction lies beyond the fold.
    BeyondFold,
    /// Neither a state nor a proof that there is none.
    NotConverged,
}

/// Refines `starts` by `method` toward `targets`, each on the sheet `sheets[target.rod]`.
#[must_use]
pub fn refine(
    method: Method,
    sheets: &[&Sheet],
    targets: &[CellTarget],
    starts: &[(f64, f64)],
) -> Vec<Refined> {
    let mut cells = vec![Refined::default(); targets.len()];
    let size = chunk_size(targets.len());
    cells
        .par_chunks_mut(size)
        .zip(targets.par_chunks(size).zip(starts.par_chunks(size)))
        .for_each(|(cells, (targets, starts))| {
            refine_chunk(method, sheets, targets, starts, cells);
        });
    cells
}

fn refine_chunk(
    method: Method,
    sheets: &[&Sheet],
    targets: &[CellTarget],
    starts: &[(f64, f64)],
    cells: &mut [Refined],
) {
    let starts = starts.iter().map(|(tau, load)| DVec2::new(*tau, *load));
    let all: Vec<(usize, DVec2)> = starts.enumerate().collect();
    newton(method, sheets, targets, &all, STEPS, cells);
    let failed = (0..cells.len()).filter(|&i| cells[i].outcome == RefineOutcome::NotConverged);
    let failed: Vec<usize> = failed.collect();
    let failed_targets: Vec<CellTarget> = failed.iter().map(|&i| targets[i]).collect();
    let verdicts = near_fold::decide(method, sheets, &failed_targets);
    let mut again = Vec::new();
    for (&i, verdict) in failed.iter().zip(verdicts) {
        match verdict {
            FoldVerdict::Beyond => cells[i].outcome = RefineOutcome::BeyondFold,
            FoldVerdict::Start(start) => again.push((i, start)),
            FoldVerdict::Unknown => {}
        }
    }
    let steps_before: Vec<u32> = again.iter().map(|(i, _)| cells[*i].steps).collect();
    newton(method, sheets, targets, &again, STEPS_NEAR_FOLD, cells);
    for ((i, _), steps) in again.iter().zip(steps_before) {
        cells[*i].steps += steps;
    }
}

/// Shots from the lattice's guesses at those of the signed push angles that are on the side of `sheet`, row by row, by growing
/// magnitude of the push angle; `rod` is the index of the sheet's.
#[must_use]
pub fn cell_targets(sheet: &Sheet, rod: u32, pushes_deg: &[f64]) -> Vec<CellTarget> {
    let sign = sheet.side.sign();
    let pushes = pushes_deg.iter().map(|push| push * sign);
    let mut pushes: Vec<f64> = pushes.filter(|p| *p >= 0.0).map(f64::to_radians).collect();
    pushes.sort_by(f64::total_cmp);
    let mut targets = Vec::new();
    for (row, place) in sheet.rows.iter().enumerate() {
        let guesses = sheet.guesses(row, pushes.iter().copied());
        for (guess, push) in guesses.iter().zip(&pushes) {
            targets.extend(guess.map(|guess| CellTarget {
                rod,
                tau: guess.tau,
                load: guess.load,
                pole: place.pole(sign * push),
            }));
        }
    }
    targets
}

/// The states of `sheet` at those of the signed push angles that are on its side, with what they were aimed at.
#[must_use]
pub fn states(
    method: Method,
    sheet: &Sheet,
    pushes_deg: &[f64],
) -> Vec<(CellTarget, ContactState)> {
    let targets = cell_targets(sheet, 0, pushes_deg);
    let starts: Vec<_> = targets
        .iter()
        .map(|target| (target.tau, target.load))
        .collect();
    let cells = refine(method, &[sheet], &targets, &starts);
    let solved = targets.into_iter().zip(cells);
    let solved = solved.filter(|(_, cell)| cell.outcome == RefineOutcome::Solved);
    solved.map(|(target, cell)| (target, cell.state)).collect()
}
