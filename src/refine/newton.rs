//! Newton's method on many cells at once, and when it may stop.

use super::{CellTarget, ContactState, GOAL, RefineOutcome, Refined, TOLERANCE};
use crate::newton::{BatchNewton, NewtonOutcome, NewtonStep, Problem};
use crate::rod::{Rod, arclength};
use crate::sheet::{Guess, Sheet};
use crate::shooting::batch::Method;
use crate::shooting::{FirstVariation, limited};
use glam::DVec2;

/// The longest Newton step, as [`limited`] measures it, at whose end the state is extrapolated instead of integrated.
const EXTRAPOLATED_STEP: f64 = 1.5e-7;

/// The residual after such a step is at most this times `length^2 (s + D)`, with the contact's arclength `s` and the pole's
/// distance `D`. Measured on 400,000 random states: at most 16.3, for 99 % of them at most 4.6. Their ranges: taper up to
/// 0.995, `A*` up to 1.5, poles up to a tenth of the length, friction up to 1, moduli from a tenth to ten times, loads up
/// to [`LARGEST_Q`].
const LEFT_BY_STEP: f64 = 20.0;

/// The largest `|load| s^2` of that measurement, with measured radii times their softness; beyond, a whisker coils up.
const LARGEST_Q: f64 = 12.0;

/// What rounding may add; on the shipped scenes at most 3.1e-14 (`tests/variations.rs`).
const ROUNDING: f64 = 6e-14;

/// Where the Jacobian's determinant, over the lengths of its columns, is larger than this, such a step cannot cross the fold.
const CLEAR_OF_FOLD: f64 = 1e-5;

/// Derivatives are good enough to extrapolate from this [`Resolution::least`](crate::shooting::Resolution::least) on.
const LEAST_STEPS: u32 = 5;

/// The state of a whisker whose pole is where a target wants it.
struct CellProblem<'a> {
    sheet: &'a Sheet,
    pole: DVec2,
    /// Whether derivatives are good enough to extrapolate from them.
    may_extrapolate: bool,
    /// How far the last iterate misses the pole, in whisker lengths; a bound where it is extrapolated.
    residual: f64,
}

impl<'a> Problem<'a> for CellProblem<'a> {
    type Output = FirstVariation;

    fn rod(&self) -> &'a Rod {
        &self.sheet.rod
    }

    fn step(&mut self, at: DVec2, here: &FirstVariation) -> NewtonStep {
        let map = &here.full.map;
        let before = std::mem::replace(&mut self.residual, map.pole.distance(self.pole));
        if self.residual <= GOAL {
            return NewtonStep::Accept;
        }
        let rod = &self.sheet.rod;
        let s = arclength(rod, at.x);
        let (step, length) = limited(map.solve(map.residual(self.pole)), s, at.y);
        let columns = map.by_tau.length() * map.by_load.length();
        let is_short = length <= EXTRAPOLATED_STEP && map.det() > CLEAR_OF_FOLD * columns;
        if is_short && self.may_extrapolate {
            let deviation = ConeDeviation::new(rod, at.x, s);
            if at.y.abs() * s * s * deviation.softness <= LARGEST_Q
                && length * length * deviation.left <= EXTRAPOLATED_STEP * EXTRAPOLATED_STEP
            {
                let left = LEFT_BY_STEP * deviation.left * length * length;
                self.residual = left * (s + map.pole.length()) + ROUNDING;
                return NewtonStep::Extrapolate(step);
            }
        }
        let is_stuck = self.residual <= TOLERANCE && self.residual > 0.5 * before;
        if is_stuck {
            NewtonStep::Accept
        } else {
            NewtonStep::Shoot(at + step)
        }
    }
}

/// Newton's method with at most `most` steps for each of the `open` cells: its index, and where it starts.
pub fn newton(
    method: Method,
    sheets: &[&Sheet],
    targets: &[CellTarget],
    open: &[(usize, DVec2)],
    most: u32,
    cells: &mut [Refined],
) {
    let problem = |&(i, _): &(usize, DVec2)| CellProblem {
        sheet: sheets[targets[i].rod as usize],
        pole: targets[i].pole,
        may_extrapolate: method.resolution.least >= LEAST_STEPS,
        residual: f64::INFINITY,
    };
    let mut problems: Vec<CellProblem> = open.iter().map(problem).collect();
    let starts = open.iter().map(|(_, start)| *start);
    let iterates = BatchNewton::new(method, most + 1).solve(&mut problems, starts);
    for ((problem, iterate), (i, _)) in problems.iter().zip(iterates).zip(open) {
        let state = ContactState {
            tau: iterate.point.x,
            load: iterate.point.y,
            full: iterate.state,
            residual: problem.residual,
        };
        cells[*i] = Refined {
            state,
            steps: iterate.steps,
            outcome: match iterate.outcome {
                NewtonOutcome::Converged => verdict(problem.sheet, targets[*i].guess(), &state),
                _ => RefineOutcome::NotConverged,
            },
        };
    }
}

/// What is different from the cone with measured radii.
struct ConeDeviation {
    /// How many times as far the rod turns under a small load, but at least once.
    softness: f64,
    /// How many times as much a step leaves: the second derivatives go with the square of the softness, and with the compliance at the
    /// contact. Measured on 137,000 random states of rods of up to 200 rows, with radii of a thousandth to one and a half times the
    /// cone's, moduli, friction and loads as for [`LEFT_BY_STEP`]: without the margin, one left 1.02 times as much.
    left: f64,
}

impl ConeDeviation {
    const CONE: Self = Self {
        softness: 1.0,
        left: 1.0,
    };

    /// Of `rod` with its contact at `tau`, which is the arclength `s`.
    fn new(rod: &Rod, tau: f64, s: f64) -> Self {
        const MARGIN: f64 = 1.5;
        if rod.profile.is_none() {
            return Self::CONE;
        }
        let softness = rod.softness(tau).max(1.0);
        let at_contact = rod.radius(tau).powi(4) / rod.stiffness(s);
        Self {
            softness,
            left: MARGIN * at_contact.max(softness * softness),
        }
    }
}

/// How far a state may be from its guess where a sheet has no samples that tell one branch from another, in parts of what changes
/// everything: a tenth of the way from node to node of a continuation.
const NEAR_GUESS: f64 = 0.005;

fn is_near(guess: Guess, state: &ContactState, s: f64) -> bool {
    let per_load = guess.load.abs() + 1.0 / (s * s);
    (state.tau - guess.tau).abs() <= NEAR_GUESS * s
        && (state.load - guess.load).abs() <= NEAR_GUESS * per_load
}

/// Whether a converged state counts.
pub fn verdict(sheet: &Sheet, guess: Guess, state: &ContactState) -> RefineOutcome {
    let s = arclength(&sheet.rod, state.tau);
    let is_elsewhere = sheet.is_continued() && !is_near(guess, state, s);
    if is_elsewhere || !sheet.is_stable(state.tau, state.load, &state.full.map) {
        RefineOutcome::NotConverged
    } else if state.tau > sheet.tip[0] && !state.is_at_tip(sheet) {
        RefineOutcome::BeyondTip
    } else {
        RefineOutcome::Solved
    }
}
