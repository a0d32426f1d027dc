//! Where along the whisker the sheet is sampled.
//!
//! Columns are evenly spaced in `u = ln tau + tau`, but for a modulus that falls toward the tip: toward the base the sheet depends on the contact through
//! its logarithm (everything scales), toward a slender tip through `tau`. One column lies exactly at the tip;
//! a few lie beyond it, because a trajectory does not know where the whisker ends, so that interpolation is
//! as good at the tip as elsewhere.

use super::fold::{FoldPoint, first_folds};
use super::polynomial::{NODES, Polynomial, stencil};
use super::rows::Row;
use crate::model::batch::Method;
use crate::model::{Rod, Side, arclength};

/// Distance of the columns in `u`.
const SPACING: f64 = 0.15;

/// Columns beyond the tip.
pub const BEYOND_TIP: usize = 3;

/// Columns between the row nearest to the base and the end of the lattice.
const BEYOND_NEAREST: usize = 4;

/// Most columns: the smallest `tau` is then below 1e-12 of the tip's.
const MOST: usize = 400;

/// The sampled contacts with their folds, from the base outward.
#[derive(Clone, Debug)]
pub struct Columns {
    /// The fold at each contact.
    pub folds: Vec<FoldPoint>,
    /// Index of the column at the tip.
    pub tip: usize,
    first_u: f64,
    rod: Rod,
}

/// `ln tau + tau`, and minus the logarithm of the modulus where that falls toward the tip: continued beyond the tip, it
/// would become 0.
fn u_of(rod: &Rod, tau: f64) -> f64 {
    let modulus = rod.modulus(arclength(rod, tau)).min(1.0);
    tau.ln() + tau - modulus.ln()
}

/// Inverse of [`u_of`] by Newton's method, bisecting where a step would leave the bracket.
fn tau_of(rod: &Rod, u: f64) -> f64 {
    let softening = (-rod.gradient).max(0.0);
    let end = if softening > rod.taper {
        rod.tau(1.0 / softening)
    } else {
        f64::INFINITY
    };
    let most = if u < 1.0 { u.exp() } else { u };
    let (mut low, mut high) = (0.0, most.min(end));
    let mut tau = most.min(0.5 * end);
    for _ in 0..100 {
        let miss = u_of(rod, tau) - u;
        if miss > 0.0 {
            high = tau;
        } else {
            low = tau;
        }
        let modulus = 1.0 - softening * arclength(rod, tau);
        let slope = 1.0 / tau + 1.0 + softening * rod.radius(tau) / modulus;
        let newton = tau - miss / slope;
        let next = if low < newton && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - tau).abs() <= 2.0 * f64::EPSILON * tau {
            return next;
        }
        tau = next;
    }
    tau
}

impl Columns {
    /// Columns from the tip of `rod` down to some beyond `nearest`, the row nearest to the base: at the last
    /// ones the pole is nearer than that at first touch and at the fold. `None` where a fold is missing.
    pub fn new(method: Method, rod: &Rod, side: Side, nearest: &Row) -> Option<Self> {
        let u_tip = u_of(rod, rod.tau_tip());
        let tau = |below_tip: f64| tau_of(rod, u_tip - SPACING * below_tip);
        let beyond = (1..=BEYOND_TIP).rev().map(|i| tau(-(i as f64)));
        let mut taus: Vec<f64> = beyond.chain([rod.tau_tip()]).collect();
        let mut folds = Vec::new();
        loop {
            let batch: Option<Vec<FoldPoint>> =
                first_folds(method, rod, side, &taus).into_iter().collect();
            folds.extend(batch?);
            let reached = folds.iter().rev().nth(BEYOND_NEAREST).is_some_and(|fold| {
                let distance = fold.landing.landing.pole.length();
                distance < nearest.pole_distance && fold.tau < rod.tau(nearest.contact.min(1.0))
            });
            if reached || folds.len() > MOST {
                break;
            }
            let from = folds.len() - BEYOND_TIP;
            taus = (from..from + 8).map(|i| tau(i as f64)).collect();
        }
        folds.reverse();
        let tip = folds.len() - 1 - BEYOND_TIP;
        Some(Self {
            first_u: u_tip - SPACING * tip as f64,
            tip,
            folds,
            rod: *rod,
        })
    }

    /// Contact at the fractional column `k + t`.
    #[must_use]
    pub fn tau(&self, k: usize, t: f64) -> f64 {
        tau_of(&self.rod, self.first_u + SPACING * (k as f64 + t))
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
        let start = stencil(k, 0, self.folds.len());
        let scaled = |fold: &FoldPoint| (fold.load.abs() * fold.tau * fold.tau).ln();
        let polynomial = Polynomial::through(self.folds[start..].iter().take(NODES).map(scaled));
        polynomial.at(place - start as f64).0.exp() / (tau * tau)
    }
}
