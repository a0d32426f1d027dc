//! Where along the whisker the sheet is sampled.
//!
//! Columns are evenly spaced in `u = ln tau + tau`, but for a modulus that falls toward the tip: toward the base the sheet depends on the contact through
//! its logarithm (everything scales), toward a slender tip through `tau`. One column lies exactly at the tip;
//! one lies beyond it, because a trajectory does not know where the whisker ends, so that interpolation is
//! nearly as good at the tip as elsewhere. Lines along the columns go through values and slopes.

use crate::numerics::newton_form::{Polynomial, places, stencil, through_slopes};
use crate::rod::{Rod, Side};
use crate::sheet::fold::coordinate::{slope_of_u, tau_of, u_of};
use crate::sheet::fold::{FoldPoint, first_folds};
use crate::sheet::row::Row;
use crate::shooting::ShootingMap;
use crate::shooting::batch::Method;
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

/// Terms of a [`Line`]: values and slopes.
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
    /// See [`least_q`].
    least_q: f64,
    /// Slopes of `ln tau` and `ln(|load| tau^2)` of the folds, per column.
    slopes: Vec<[f64; 2]>,
    /// `ln tau` of the folds, by the first column of the stencil.
    pub ln_tau: Vec<Line>,
    /// `ln(|load| tau^2)` of them.
    pub ln_q: Vec<Line>,
}

/// How much the change of `ln q` of the fold from a column to the next one differs from the slope at one of them at the least where the
/// fold jumps (with friction, from 29 to 15); `scenes/measured.toml` has 0.19.
const JUMP: f64 = 0.25;

/// What rounding may leave of the slope of `ln D` where it is 0: at the tip of a perfect cone.
const LEVEL: f64 = 1e-6;

/// Whether the fold jumps between two columns from one to the other of which `ln q` changes by `change`.
fn jumps(change: f64, slopes: [f64; 2]) -> bool {
    let astray = slopes.map(|slope| (change - slope).abs());
    astray[0].max(astray[1]) >= JUMP
}

/// The most that `d ln q/d ln tau` of a fold counts for; it is 2 toward a slender tip.
const STEEPEST: f64 = 4.0;

/// A load is surely below the folds where `|load| tau^2` is this part of the smallest: the rest is for a fold that jumps between two
/// columns.
const BELOW: f64 = 0.75;

/// The smallest `|load| tau^2` of the folds, between the columns, too: how far a cubic between two of them, with their slopes, may be
/// below both.
fn least_q(values: &[[f64; 2]], slopes: &[[f64; 2]]) -> f64 {
    let pairs = values.windows(2).zip(slopes.windows(2));
    let least = pairs.map(|(values, slopes)| {
        let (falling, rising) = (-slopes[0][1], slopes[1][1]);
        let dip = 4.0 / 27.0 * (falling.max(0.0) + rising.max(0.0));
        values[0][1].min(values[1][1]) - dip
    });
    least.fold(f64::INFINITY, f64::min).exp()
}

fn q(fold: &FoldPoint) -> f64 {
    fold.load.abs() * fold.tau * fold.tau
}

/// Slopes of `ln tau` and `ln(|load| tau^2)` of the folds at `fold`, per column.
fn slopes_at(rod: &Rod, fold: &FoldPoint) -> [f64; 2] {
    let ln_tau = SPACING / slope_of_u(rod, fold.tau);
    let by_det = fold.variation.det_gradient();
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
                let distance = fold.variation.map.pole.length();
                distance < nearest.pole_distance && fold.tau < touch
            });
            if reached || folds.len() > MOST {
                break;
            }
            batch = FURTHER;
        }
        folds.reverse();
        let values: Vec<[f64; 2]> = folds.iter().map(|f| [f.tau.ln(), q(f).ln()]).collect();
        let slopes: Vec<[f64; 2]> = folds.iter().map(|fold| slopes_at(rod, fold)).collect();
        let both = through_slopes(&values, &slopes);
        let lines = |which: usize| both.iter().map(move |of| line(of.map(|term| term[which])));
        let tip = folds.len() - 1 - BEYOND_TIP;
        Some(Self {
            first_u: u_tip - SPACING * tip as f64,
            tip,
            rod: rod.clone(),
            least_q: least_q(&values, &slopes),
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

    /// The slope, per column, of `(ln D, phi)` where the load is this `part` of the fold's: that of the `map` at `column`.
    #[must_use]
    pub fn slope(&self, column: usize, part: f64, map: &ShootingMap) -> DVec2 {
        let (fold, [ln_tau, ln_q]) = (&self.folds[column], self.slopes[column]);
        let ln_load = ln_q - 2.0 * ln_tau;
        map.by_tau * (fold.tau * ln_tau) + map.by_load * (part * fold.load * ln_load)
    }

    /// Whether the distance at the fold grows from `column` to the next one, and the fold does not jump.
    #[must_use]
    pub fn grow_after(&self, column: usize) -> bool {
        let ends = [column, column + 1];
        let maps = ends.map(|column| &self.folds[column].variation.map);
        let [here, next] = maps.map(|map| map.pole.length());
        let grows = |i: usize| self.slope(ends[i], 1.0, maps[i]).x > -LEVEL;
        let [from, to] = ends.map(|column| q(&self.folds[column]).ln());
        let slopes = ends.map(|column| self.slopes[column][1]);
        here < next && grows(0) && grows(1) && !jumps(to - from, slopes)
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

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    reason = "a sheet that is not there fails the test"
)]
mod tests {
    use super::*;
    use crate::rod::Rest;
    use crate::shooting::ShootingMap;
    use crate::shooting::batch::{Batch, InitialCondition};

    /// Slopes against differences between neighbours, columns in the middle and the one at the tip.
    #[test]
    fn slopes_are_those_between_neighbours() {
        let slender = Rod {
            taper: 0.9,
            bend: 0.3,
            pole: 0.01,
            ..Rod::default()
        };
        let of_gradient = |gradient| Rod {
            gradient,
            ..slender.clone()
        };
        let rubbing = Rod {
            friction: 0.3,
            ..slender.clone()
        };
        for rod in [
            of_gradient(0.0),
            rubbing,
            of_gradient(-0.6),
            of_gradient(2.0),
        ] {
            let method = Method::fine();
            for side in Side::BOTH {
                let rod = Rod {
                    pole: side.sign() * rod.pole,
                    friction: side.sign() * rod.friction,
                    ..rod.clone()
                };
                let row = Row::new(&Rest::new(&rod), 0.3);
                let columns = Columns::new(method, &rod, side, &row).unwrap();
                for column in [2, columns.tip] {
                    check(&columns, method, side, column);
                }
            }
        }
    }

    fn check(columns: &Columns, method: Method, side: Side, column: usize) {
        const STEP: f64 = 1e-3;
        let rod = &columns.rod;
        let u = u_of(rod, columns.folds[column].tau);
        let around = [-STEP, STEP].map(|step| tau_of(rod, step.mul_add(SPACING, u), 1.0));
        let folds = first_folds(method, rod, side, &around);
        let folds = [0, 1].map(|i| folds[i].unwrap());
        let differ = |[a, b]: [f64; 2]| (b - a) / (2.0 * STEP);
        let [ln_tau, ln_q] = columns.slopes[column];
        assert!((differ(folds.map(|fold| fold.tau.ln())) - ln_tau).abs() < 1e-5);
        assert!((differ(folds.map(|fold| q(&fold).ln())) - ln_q).abs() < 1e-5);
        for part in [0.0, 0.5, 1.0] {
            let shot = |fold: &FoldPoint| {
                let (tau, load) = (fold.tau, part * fold.load);
                Batch::new(method).shoot::<ShootingMap>(&[InitialCondition { rod, tau, load }])[0]
            };
            let slope = columns.slope(column, part, &shot(&columns.folds[column]));
            let maps = [0, 1].map(|i| shot(&folds[i]));
            let ln_distance = differ(maps.map(|map| map.pole.length().ln()));
            let phi = differ(maps.map(|map| map.pole.to_angle()));
            assert!((ln_distance - slope.x).abs() < 1e-5, "{column} {part}");
            assert!((phi - slope.y).abs() < 1e-5, "{column} {part}");
        }
    }

    /// A fold that falls as a root right after it has jumped down is as steep there as the jump.
    #[test]
    fn a_jump_is_seen_whatever_the_slopes() {
        assert!(jumps(-0.6, [0.0, 0.0]));
        assert!(jumps(-0.6, [0.0, -1.2]));
        assert!(jumps(-0.6, [-0.6, -0.1]));
        assert!(!jumps(0.47, [0.38, 0.29]));
        assert!(!jumps(1.3, [1.3, 1.3]));
    }
}
