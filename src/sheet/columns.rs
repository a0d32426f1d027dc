//! Where along the whisker the sheet is sampled.
//!
//! Columns are evenly spaced in `u = ln tau + tau`, but for a modulus that falls toward the tip: toward the base the sheet depends on the contact through
//! its logarithm (everything scales), toward a slender tip through `tau`. One column lies exactly at the tip;
//! one lies beyond it, because a trajectory does not know where the whisker ends, so that interpolation is
//! nearly as good at the tip as elsewhere. Lines along the columns go through values and slopes.

use super::fold::{FoldPoint, first_folds};
use super::polynomial::{Polynomial, places, stencil, through_slopes};
use super::rows::Row;
use crate::model::batch::Method;
use crate::model::{Landing, Rod, Side, arclength};
use glam::DVec2;

/// Distance of the columns in `u`.
const SPACING: f64 = 0.68;

/// Columns beyond the tip.
pub const BEYOND_TIP: usize = 1;

/// Columns between the row nearest to the base and the end of the lattice.
const BEYOND_NEAREST: usize = 1;

/// Columns of a further batch.
const FURTHER: usize = 4;

/// Columns that a [`Line`] goes through.
pub const AROUND: usize = 6;

/// Terms of a [`Line`]: every column knows how it changes to the next one.
pub const TERMS: usize = 2 * AROUND;

/// Along the columns, from 0 at the first one that it goes through.
pub type Line = Polynomial<TERMS>;

/// The line with these divided differences.
pub const fn line(differences: [f64; TERMS]) -> Line {
    Line {
        places: places(2),
        differences,
    }
}

/// Most columns: the smallest `tau` is then below 1e-12 of the tip's.
const MOST: usize = 100;

/// The sampled contacts with their folds, from the base outward.
#[derive(Clone, Debug)]
pub struct Columns {
    /// The fold at each contact.
    pub folds: Vec<FoldPoint>,
    /// Index of the column at the tip.
    pub tip: usize,
    first_u: f64,
    rod: Rod,
    /// The smallest `|load| tau^2` of the folds.
    least_q: f64,
    /// How `ln tau` and `ln(|load| tau^2)` of each fold change to the next column.
    slopes: Vec<[f64; 2]>,
    /// `ln tau` of the folds, by the first column of the stencil.
    pub ln_tau: Vec<Line>,
    /// `ln(|load| tau^2)` of them.
    pub ln_q: Vec<Line>,
}

/// `ln tau + tau`, and minus the logarithm of the modulus where that falls toward the tip: continued beyond the tip, it
/// would become 0.
fn u_of(rod: &Rod, tau: f64) -> f64 {
    let softening = if rod.gradient < 0.0 {
        rod.modulus(arclength(rod, tau)).ln()
    } else {
        0.0
    };
    tau.ln() + tau - softening
}

/// `du/dln tau`.
fn slope_of_u(rod: &Rod, tau: f64) -> f64 {
    let mut slope = 1.0 + tau;
    if rod.gradient < 0.0 {
        let s = arclength(rod, tau);
        slope -= rod.gradient * rod.radius(tau) * tau / rod.modulus(s);
    }
    slope
}

/// Inverse of [`u_of`] by Newton's method for `ln tau` from `near`, bisecting where a step would leave the bracket.
fn tau_of(rod: &Rod, u: f64, near: f64) -> f64 {
    let softening = (-rod.gradient).max(0.0);
    let end = if softening > rod.taper {
        rod.tau(1.0 / softening)
    } else {
        f64::INFINITY
    };
    let most = if u < 1.0 { u.exp() } else { u };
    let (mut low, mut high) = (0.0, most.min(end));
    let mut tau = if near < high { near } else { 0.5 * high };
    for _ in 0..100 {
        let miss = u_of(rod, tau) - u;
        if miss > 0.0 {
            high = tau;
        } else {
            low = tau;
        }
        let newton = tau * (-miss / slope_of_u(rod, tau)).exp();
        let next = if low < newton && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        // The square of the step is left.
        if (next - tau).abs() <= 1e-9 * tau {
            return next;
        }
        tau = next;
    }
    tau
}

/// How much more, or less, `ln q` of the fold changes from column to column at the least where it jumps; with friction, from 29 to 15.
const JUMP: f64 = 0.25;

/// The most that `d ln q/d ln tau` of a fold counts for.
const STEEPEST: f64 = 8.0;

/// What is this part of the smallest `|load| tau^2` of the columns is below the folds between them, too: from column to column
/// that changes by less than [`JUMP`].
const BELOW: f64 = 0.75;

fn q(fold: &FoldPoint) -> f64 {
    fold.load.abs() * fold.tau * fold.tau
}

/// How `ln tau` and `ln(|load| tau^2)` of `fold` change to the next column.
fn slopes(rod: &Rod, fold: &FoldPoint) -> [f64; 2] {
    let ln_tau = SPACING / slope_of_u(rod, fold.tau);
    let by_det = fold.landing.det_gradient();
    let ln_load = -by_det.x / by_det.y * fold.tau / fold.load;
    // Where the first fold jumps from contact to contact it may stand still there, and no line is of any use.
    let ln_q = (2.0 + ln_load).clamp(-STEEPEST, STEEPEST);
    [ln_tau, ln_q * ln_tau]
}

impl Columns {
    /// Columns from the tip of `rod` down to some beyond `nearest`, the row nearest to the base: at the last
    /// ones the pole is nearer than that at first touch and at the fold. `None` where a fold is missing.
    pub fn new(method: Method, rod: &Rod, side: Side, nearest: &Row) -> Option<Self> {
        let u_tip = u_of(rod, rod.tau_tip());
        let tip = rod.tau_tip();
        let mut near = tip;
        let mut tau = |column: usize| {
            near = match column.checked_sub(BEYOND_TIP) {
                Some(0) => tip,
                Some(below) => tau_of(rod, u_tip - SPACING * below as f64, near),
                None => tau_of(rod, u_tip + SPACING * (BEYOND_TIP - column) as f64, near),
            };
            near
        };
        let touch = rod.tau(nearest.contact.min(1.0));
        // As many as there are at least, with the one at the tip.
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates, and a batch is bounded"
        )]
        let mut batch = ((u_tip - u_of(rod, touch)) / SPACING) as usize;
        batch = batch.min(MOST) + BEYOND_TIP + BEYOND_NEAREST + 2;
        let mut folds = Vec::new();
        loop {
            let from = folds.len();
            let taus: Vec<f64> = (from..from + batch).map(&mut tau).collect();
            let found: Option<Vec<FoldPoint>> =
                first_folds(method, rod, side, &taus).into_iter().collect();
            folds.extend(found?);
            let reached = folds.iter().rev().nth(BEYOND_NEAREST).is_some_and(|fold| {
                let distance = fold.landing.landing.pole.length();
                distance < nearest.pole_distance && fold.tau < touch
            });
            if reached || folds.len() > MOST {
                break;
            }
            batch = FURTHER;
        }
        folds.reverse();
        let values: Vec<[f64; 2]> = folds.iter().map(|f| [f.tau.ln(), q(f).ln()]).collect();
        let slopes: Vec<[f64; 2]> = folds.iter().map(|fold| slopes(rod, fold)).collect();
        let lines = through_slopes(&values, &slopes);
        let lines = |which: usize| lines.iter().map(move |of| line(of.map(|term| term[which])));
        let tip = folds.len() - 1 - BEYOND_TIP;
        Some(Self {
            first_u: u_tip - SPACING * tip as f64,
            tip,
            rod: *rod,
            least_q: folds.iter().map(q).fold(f64::INFINITY, f64::min),
            ln_tau: lines(0).collect(),
            ln_q: lines(1).collect(),
            folds,
            slopes,
        })
    }

    /// Whether the load is surely less than that of the fold for the contact at `tau`.
    #[must_use]
    pub fn is_below_folds(&self, tau: f64, load: f64) -> bool {
        load.abs() * tau * tau < BELOW * self.least_q
    }

    /// How `(ln D, phi)` of the `landing` of a contact at `column`, under the load that is this `part` of the fold's, changes to the
    /// next column.
    #[must_use]
    pub fn slope(&self, column: usize, part: f64, landing: &Landing) -> DVec2 {
        let (fold, [ln_tau, ln_q]) = (&self.folds[column], self.slopes[column]);
        let ln_load = ln_q - 2.0 * ln_tau;
        landing.by_tau * (fold.tau * ln_tau) + landing.by_load * (part * fold.load * ln_load)
    }

    /// Whether the distance at the fold grows from `column` to the next one, and the fold does not jump.
    #[must_use]
    pub fn grow_after(&self, column: usize) -> bool {
        let ends = [column, column + 1];
        let landings = ends.map(|column| &self.folds[column].landing.landing);
        let [here, next] = landings.map(|landing| landing.pole.length());
        let grows = |i: usize| self.slope(ends[i], 1.0, landings[i]).x > 0.0;
        here < next && grows(0) && grows(1) && self.jump(column) < JUMP
    }

    /// How much more, or less, `ln q` of the fold changes from `column` to the next one than the slopes at both tell.
    fn jump(&self, column: usize) -> f64 {
        let ln_q = |column: usize| q(&self.folds[column]).ln();
        let [here, next] = [column, column + 1].map(|column| self.slopes[column][1]);
        (ln_q(column + 1) - ln_q(column) - 0.5 * (here + next)).abs()
    }

    /// `|load|` at the fold for the contact at `tau`, by interpolation.
    #[must_use]
    pub fn fold_load(&self, tau: f64) -> f64 {
        let place = (u_of(&self.rod, tau) - self.first_u) / SPACING;
        let last = self.folds.len() - 2;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates, and the result is clamped to the columns"
        )]
        let k = (place as usize).min(last);
        let start = stencil(k, AROUND, self.folds.len());
        self.ln_q[start].at(place - start as f64).0.exp() / (tau * tau)
    }
}
