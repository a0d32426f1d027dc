//! Newton's method for many cells at once, and its stopping criteria.

use super::{CellTarget, ContactState, GOAL, Refined, TOLERANCE};
use crate::classify::Outcome;
use crate::newton::{BatchNewton, NewtonOutcome, NewtonProblem, NewtonStep};
use crate::sheet::Sheet;
use glam::DVec2;
use whiskmap_mechanics::rod::{Rod, arclength};
use whiskmap_mechanics::shooting::batch::Method;
use whiskmap_mechanics::shooting::{FirstVariation, limited};

/// Longest Newton step, as [`limited`] measures it, at whose end the state is extrapolated instead of integrated.
const EXTRAPOLATED_STEP: f64 = 1.5e-7;

/// Bound on the residual after an extrapolated last step of a given length, in units of `length^2 (s + D)`. Here, `s` is the contact's
/// arclength and `D` the pole's distance. Measured on 400,000 random states: at most 16.3, for 99 % of them at most 4.6. Their ranges:
/// taper up to 0.995, `A*` up to 1.5, poles up to a tenth of the length, friction up to 1, moduli from a tenth to ten times, loads up to
/// [`LARGEST_Q`].
const LEFT_BY_STEP: f64 = 20.0;

/// Largest `|load| s^2` for which [`LEFT_BY_STEP`] is measured, with measured radii times their softness. Beyond it, a whisker coils up.
const LARGEST_Q: f64 = 12.0;

/// Bound on the rounding error of the residual, in whisker lengths; on the shipped scenes it is at most 3.1e-14 (`tests/variations.rs`).
const ROUNDING: f64 = 6e-14;

/// Jacobian determinant, relative to the lengths of its columns, above which an extrapolated step cannot cross the fold.
const CLEAR_OF_FOLD: f64 = 1e-5;

/// Minimum [`Resolution::least`](whiskmap_mechanics::shooting::Resolution::least) at which derivatives are accurate enough for extrapolation.
const LEAST_STEPS: u32 = 5;

/// Newton problem of a cell: the state whose pole is at the target.
struct CellProblem<'a> {
    sheet: &'a Sheet,
    pole: DVec2,
    /// True if derivatives are accurate enough for extrapolation.
    may_extrapolate: bool,
    /// Distance of the last iterate's pole from the target, in whisker lengths; an upper bound if it is extrapolated.
    residual: f64,
}

impl<'a> NewtonProblem<'a> for CellProblem<'a> {
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
        if is_stuck { NewtonStep::Accept } else { NewtonStep::Shoot(at + step) }
    }
}

/// Applies Newton's method with at most `most` steps to each of the `open` cells, given by index and start `(tau, load)`. Writes the
/// results into `cells`.
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
        let state =
            ContactState { point: iterate.point, full: iterate.state, residual: problem.residual };
        cells[*i] = Refined {
            state,
            steps: iterate.steps,
            outcome: match iterate.outcome {
                NewtonOutcome::Converged => verdict(problem.sheet, targets[*i].guess, &state),
                _ => Outcome::NotConverged,
            },
        };
    }
}

/// Difference of a rod with measured radii from the cone.
struct ConeDeviation {
    /// Ratio of the rod's rotation under a small load to the cone's, at least 1.
    softness: f64,
    /// Ratio of the residual that a step leaves to the cone's. Second derivatives grow with the square of the softness, and with the
    /// compliance at the contact. Measured on 137,000 random states of rods of up to 200 rows: without the margin, one state left 1.02
    /// times as much. Radii were a thousandth to one and a half times the cone's, moduli, friction and loads as for [`LEFT_BY_STEP`].
    left: f64,
}

impl ConeDeviation {
    const CONE: Self = Self { softness: 1.0, left: 1.0 };

    /// Computes the difference of `rod` with its contact at `tau`, which is the arclength `s`.
    fn new(rod: &Rod, tau: f64, s: f64) -> Self {
        const MARGIN: f64 = 1.5;
        if rod.profile.is_none() {
            return Self::CONE;
        }
        let softness = rod.softness(tau).max(1.0);
        let at_contact = rod.radius(tau).powi(4) / rod.stiffness(s);
        Self { softness, left: MARGIN * at_contact.max(softness * softness) }
    }
}

/// Largest distance of a state from its guess where a sheet has no samples that distinguish branches, relative to the scale of contact
/// and load. It is a tenth of the distance between nodes of a continuation.
const NEAR_GUESS: f64 = 0.005;

fn is_near(guess: DVec2, state: &ContactState, s: f64) -> bool {
    let scale = DVec2::new(s, guess.y.abs() + 1.0 / (s * s));
    let apart = (state.point - guess).abs();
    apart.cmple(NEAR_GUESS * scale).all()
}

/// Returns the outcome of a converged state of a cell. The state counts only on the sheet, and only near its guess where the sheet is
/// followed by continuation.
pub fn verdict(sheet: &Sheet, guess: DVec2, state: &ContactState) -> Outcome {
    let DVec2 { x: tau, y: load } = state.point;
    let s = arclength(&sheet.rod, tau);
    let is_elsewhere = sheet.is_continued() && !is_near(guess, state, s);
    if is_elsewhere || !sheet.is_stable(tau, load, &state.full.map) {
        Outcome::NotConverged
    } else if state.is_at_tip(sheet) {
        Outcome::AtTip
    } else if tau > sheet.tip[0] {
        Outcome::BeyondTip
    } else {
        Outcome::Solved
    }
}
