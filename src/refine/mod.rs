//! Refinement: Newton's method in `f64` from whatever an engine or a lattice offers, and the verdict.
//!
//! "Newton converged" is not "still on the pole": a solution counts only on the stable sheet. Where Newton's
//! method fails, the fold at the same distance decides: either the wanted direction lies beyond it, or the
//! fold's normal form gives the start that Newton's method needs.

mod near_fold;
mod newton;

use crate::integrate::Shot;
use crate::sheet::Sheet;
use crate::shooting::FullState;
use crate::shooting::batch::{Method, together};
use near_fold::Verdict;
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

/// What became of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// The last state computed.
    pub state: State,
    /// Newton steps taken here.
    pub steps: u32,
    /// The verdict.
    pub end: End,
}

impl Default for Refined {
    /// Nothing computed yet.
    fn default() -> Self {
        Self {
            state: State {
                tau: f64::NAN,
                load: f64::NAN,
                full: FullState::default(),
                residual: f64::INFINITY,
            },
            steps: 0,
            end: End::NotConverged,
        }
    }
}

/// A state of the whisker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
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

impl State {
    /// Whether the contact is at the tip of the rod of `sheet`, as far as residual and resolution tell.
    #[must_use]
    pub fn is_at_tip(&self, sheet: &Sheet) -> bool {
        let [tau, radius] = sheet.tip;
        (self.tau - tau).abs() <= TIP_TIE * tau + self.residual / radius + sheet.tip_blur()
    }
}

/// The verdict on a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// A stable state.
    Solved,
    /// A stable state of a longer whisker: the contact lies beyond the tip.
    BeyondTip,
    /// The wanted direction lies beyond the fold.
    BeyondFold,
    /// Neither a state nor a proof that there is none.
    NotConverged,
}

/// Refines `starts` by `method` toward `shots`, each on the sheet `sheets[shot.rod]`.
#[must_use]
pub fn refine(
    method: Method,
    sheets: &[&Sheet],
    shots: &[Shot],
    starts: &[(f64, f64)],
) -> Vec<Refined> {
    let mut cells = vec![Refined::default(); shots.len()];
    let together = together(shots.len());
    cells
        .par_chunks_mut(together)
        .zip(shots.par_chunks(together).zip(starts.par_chunks(together)))
        .for_each(|(cells, (shots, starts))| refine_together(method, sheets, shots, starts, cells));
    cells
}

fn refine_together(
    method: Method,
    sheets: &[&Sheet],
    shots: &[Shot],
    starts: &[(f64, f64)],
    cells: &mut [Refined],
) {
    newton(method, sheets, shots, starts, STEPS, cells);
    let lost: Vec<usize> = (0..cells.len())
        .filter(|&i| cells[i].end == End::NotConverged)
        .collect();
    let lost_shots: Vec<Shot> = lost.iter().map(|&i| shots[i]).collect();
    let verdicts = near_fold::decide(method, sheets, &lost_shots);
    let mut again = Vec::new();
    let mut restarts = Vec::new();
    for (&i, verdict) in lost.iter().zip(&verdicts) {
        match verdict {
            Verdict::Beyond => cells[i].end = End::BeyondFold,
            Verdict::Start(start) => {
                again.push(i);
                restarts.push(*start);
            }
            Verdict::Unknown => {}
        }
    }
    let again_shots: Vec<Shot> = again.iter().map(|&i| shots[i]).collect();
    let mut second = vec![Refined::default(); again.len()];
    newton(
        method,
        sheets,
        &again_shots,
        &restarts,
        STEPS_NEAR_FOLD,
        &mut second,
    );
    for (&i, cell) in again.iter().zip(second) {
        cells[i] = Refined {
            steps: cells[i].steps + cell.steps,
            ..cell
        };
    }
}

/// The states of `sheet` at those of the signed push angles that are on its side, from the lattice's guesses, with what
/// they were aimed at.
#[must_use]
pub fn states(method: Method, sheet: &Sheet, pushes_deg: &[f64]) -> Vec<(Shot, State)> {
    let sign = sheet.side.sign();
    let pushes = pushes_deg.iter().map(|push| push * sign);
    let mut pushes: Vec<f64> = pushes.filter(|p| *p >= 0.0).map(f64::to_radians).collect();
    pushes.sort_by(f64::total_cmp);
    let mut shots = Vec::new();
    for (row, place) in sheet.rows.iter().enumerate() {
        let guesses = sheet.guesses(row, pushes.iter().copied());
        for (guess, push) in guesses.iter().zip(&pushes) {
            shots.extend(guess.map(|guess| Shot {
                rod: 0,
                tau: guess.tau,
                load: guess.load,
                pole: place.pole(sign * push),
            }));
        }
    }
    let starts: Vec<_> = shots.iter().map(|shot| (shot.tau, shot.load)).collect();
    let cells = refine(method, &[sheet], &shots, &starts);
    let solved = shots.into_iter().zip(cells);
    let solved = solved.filter(|(_, cell)| cell.end == End::Solved);
    solved.map(|(shot, cell)| (shot, cell.state)).collect()
}
