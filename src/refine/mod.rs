//! Refinement: Newton's method in `f64` from whatever an engine or a lattice offers, and the verdict.
//!
//! "Newton converged" is not "still on the pole": a solution counts only on the stable sheet. Where Newton's
//! method fails, the fold at the same distance decides: either the wanted direction lies beyond it, or the
//! fold's normal form gives the start that Newton's method needs.

mod near_fold;

use crate::integrate::{Shot, TOGETHER};
use crate::model::batch::{Launch, Method, land};
use crate::model::{FirstAndEnergy, Full, Nystrom8, arclength, limited};
use crate::sheet::Sheet;
use near_fold::Verdict;
use rayon::prelude::*;

/// Residual, in whisker lengths, at which a state is accepted without another step.
pub const GOAL: f64 = 1e-12;

/// Residual, in whisker lengths, up to which a state is accepted when steps no longer help.
pub const TOLERANCE: f64 = 1e-11;

/// The length of a Newton step, as [`limited`] measures it, that needs no trajectory at its end.
const LAST_STEP: f64 = 1.5e-7;

/// The residual after such a step at most, in squares of its length and in sums of the contact's arclength and the pole's
/// distance: of 400,000 random states (taper up to 0.995, `A*` up to 1.5, poles up to a tenth of the length, friction up to
/// 1, moduli from a tenth to ten times, loads up to [`LARGEST_Q`]) none left more than 16.3, 99 % at most 4.6.
const LEFT_BY_STEP: f64 = 20.0;

/// The largest `|load| s^2` that this was measured for; beyond, a whisker coils up.
const LARGEST_Q: f64 = 12.0;

/// What rounding may leave of it.
const ROUNDING: f64 = 3e-14;

/// The determinant of the Jacobian, over the lengths of its columns, from which on such a step cannot cross the fold.
const CLEAR_OF_FOLD: f64 = 1e-5;

/// Fewest steps, as in [`Resolution::least`](crate::model::Resolution::least), whose derivatives are good enough for it.
const LEAST_STEPS: u32 = 5;

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

/// A state of the whisker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Everything else.
    pub full: Full,
    /// Distance of the pole from the wanted place, in whisker lengths; a bound on it where the last step was so short that no
    /// trajectory followed it.
    pub residual: f64,
}

impl State {
    /// Whether the contact is at the tip of the rod of `sheet`, as far as the residual tells.
    #[must_use]
    pub fn is_at_tip(&self, sheet: &Sheet) -> bool {
        let [tau, radius] = sheet.tip;
        (self.tau - tau).abs() <= TIP_TIE * tau + self.residual / radius
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
    shots
        .par_chunks(TOGETHER)
        .zip(starts.par_chunks(TOGETHER))
        .flat_map_iter(|(shots, starts)| refine_together(method, sheets, shots, starts))
        .collect()
}

fn refine_together(
    method: Method,
    sheets: &[&Sheet],
    shots: &[Shot],
    starts: &[(f64, f64)],
) -> Vec<Refined> {
    let mut cells = newton(method, sheets, shots, starts, STEPS);
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
    let second = newton(method, sheets, &again_shots, &restarts, STEPS_NEAR_FOLD);
    for (&i, cell) in again.iter().zip(second) {
        cells[i] = Refined {
            steps: cells[i].steps + cell.steps,
            ..cell
        };
    }
    cells
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

/// Newton's method with at most `most` steps per cell.
fn newton(
    method: Method,
    sheets: &[&Sheet],
    shots: &[Shot],
    starts: &[(f64, f64)],
    most: u32,
) -> Vec<Refined> {
    let mut cells: Vec<Option<Refined>> = vec![None; shots.len()];
    let mut points = starts.to_vec();
    let mut open: Vec<usize> = (0..shots.len()).collect();
    for steps in 0..=most {
        if open.is_empty() {
            break;
        }
        let launches: Vec<Launch> = open
            .iter()
            .map(|&i| Launch {
                rod: sheets[shots[i].rod as usize].rod,
                tau: points[i].0,
                load: points[i].1,
            })
            .collect();
        let mut answers = land::<Nystrom8, FirstAndEnergy>(method, &launches).into_iter();
        let mut launches = launches.iter();
        open.retain(|&i| {
            let (Some(moving), Some(launch)) = (answers.next(), launches.next()) else {
                return false;
            };
            let full = moving.full;
            let residual = full.landing.pole.distance(shots[i].pole);
            let state = State {
                tau: launch.tau,
                load: launch.load,
                full,
                residual,
            };
            let s = arclength(&launch.rod, launch.tau);
            let step = full.landing.solve(full.landing.residual(shots[i].pole));
            let (step, length) = limited(step, s, launch.load);
            let sheet = sheets[shots[i].rod as usize];
            let columns = full.landing.by_tau.length() * full.landing.by_load.length();
            let may_be_last = method.resolution.least >= LEAST_STEPS
                && launch.rod.profile.is_none()
                && launch.load.abs() * s * s <= LARGEST_Q
                && full.landing.det() > CLEAR_OF_FOLD * columns;
            if residual > GOAL && length <= LAST_STEP && may_be_last {
                let state = State {
                    tau: launch.tau + step.x,
                    load: launch.load + step.y,
                    full: moving.moved(step),
                    residual: LEFT_BY_STEP * length * length * (s + full.landing.pole.length())
                        + ROUNDING,
                };
                let (end, steps) = (verdict(sheet, &state), steps + 1);
                cells[i] = Some(Refined { state, steps, end });
                return false;
            }
            let before = cells[i].map_or(f64::INFINITY, |cell| cell.state.residual);
            let stuck = residual <= TOLERANCE && residual > 0.5 * before;
            if residual <= GOAL || stuck {
                let end = verdict(sheet, &state);
                cells[i] = Some(Refined { state, steps, end });
                return false;
            }
            cells[i] = Some(Refined {
                state,
                steps,
                end: End::NotConverged,
            });
            points[i] = (launch.tau + step.x, launch.load + step.y);
            step.is_finite() && points[i].0 > 0.0
        });
    }
    cells.into_iter().flatten().collect()
}

/// Whether a converged state counts.
fn verdict(sheet: &Sheet, state: &State) -> End {
    if !sheet.is_stable(state.tau, state.load, &state.full.landing) {
        End::NotConverged
    } else if state.tau > sheet.tip[0] && !state.is_at_tip(sheet) {
        End::BeyondTip
    } else {
        End::Solved
    }
}
