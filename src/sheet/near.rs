//! Places on the edges between their samples, as good as most trajectories would tell them.

use super::columns::{AROUND, Columns, Line, line};
use super::edges::Sample;
use super::loads::{Curve, LOADS, PARTS, through};
use super::polynomial::{Polynomial, oriented, places, stencil, through_slopes, through_values};
use super::seek::Bends;
use crate::model::Landing;
use glam::DVec2;

/// A place near an edge.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Direction of the pole, continuous from first touch.
    pub phi: f64,
    /// Second derivatives of `(ln D, phi)`; `None` where the place is not known well.
    pub bends: Option<Bends>,
}

impl Near {
    /// Where `ln D` is `target` if all else changes evenly from one sample to the other.
    pub fn between([a, b]: [&Sample; 2], target: f64) -> Self {
        let t = (target - a.ln_distance) / (b.ln_distance - a.ln_distance);
        let scaled = |s: &Sample| s.load * s.tau * s.tau;
        let tau = a.tau * (t * (b.tau / a.tau).ln()).exp();
        Self {
            tau,
            load: (scaled(a) + t * (scaled(b) - scaled(a))) / (tau * tau),
            phi: a.phi + t * (b.phi - a.phi),
            bends: None,
        }
    }
}

/// The last step along an edge, in distances of columns or in parts of the load: its square is left.
const LAST_STEP: f64 = 1e-5;

/// Where `ln D` is `target` on a `line` between two samples.
fn place<const N: usize>(
    line: &Polynomial<N>,
    ends: [f64; 2],
    pair: [&Sample; 2],
    target: f64,
) -> f64 {
    let [from, to] = pair.map(|sample| sample.ln_distance);
    let near = ends[0] + (target - from) / (to - from) * (ends[1] - ends[0]);
    line.solve(target, near, oriented(ends, [from, to]), LAST_STEP)
}

/// The fold edge through [`AROUND`] columns.
#[derive(Clone, Debug)]
struct FoldPiece {
    ln_distance: Line,
    phi: Line,
    ln_tau: Line,
    ln_q: Line,
    /// Second derivatives in the logarithm of `tau` and in `load tau^2`, which change little from contact to contact.
    bends: [Polynomial<AROUND>; 6],
}

/// The fold edge.
#[derive(Clone, Debug)]
pub struct FoldLine {
    count: usize,
    sign: f64,
    /// By the first column.
    pieces: Vec<FoldPiece>,
}

impl FoldLine {
    /// Through the folds of all columns, with the directions `phis` of the pole.
    pub fn new(columns: &Columns, phis: impl Iterator<Item = f64>) -> Self {
        let folds = &columns.folds;
        let landings = folds.iter().map(|fold| &fold.landing.landing);
        let values: Vec<[f64; 2]> = landings
            .clone()
            .zip(phis)
            .map(|(landing, phi)| [landing.pole.length().ln(), phi])
            .collect();
        let slopes: Vec<[f64; 2]> = landings
            .enumerate()
            .map(|(column, landing)| columns.slope(column, 1.0, landing).to_array())
            .collect();
        let bends: Vec<[f64; 6]> = folds
            .iter()
            .map(|fold| {
                let (tau, here) = (fold.tau, &fold.landing);
                let tau_tau = here.by_tau_tau * tau.powi(2);
                let tau_load = here.by_tau_load / tau;
                let load_load = here.by_load_load / tau.powi(4);
                [
                    tau_tau.x,
                    tau_tau.y,
                    tau_load.x,
                    tau_load.y,
                    load_load.x,
                    load_load.y,
                ]
            })
            .collect();
        let pieces = through_slopes(&values, &slopes)
            .iter()
            .zip(through_values::<6, AROUND>(&bends))
            .zip(columns.ln_tau.iter().zip(&columns.ln_q))
            .map(|((terms, bends), (ln_tau, ln_q))| FoldPiece {
                ln_distance: line(terms.map(|term| term[0])),
                phi: line(terms.map(|term| term[1])),
                ln_tau: *ln_tau,
                ln_q: *ln_q,
                bends: std::array::from_fn(|i| Polynomial {
                    places: places(1),
                    differences: bends.map(|bend| bend[i]),
                }),
            })
            .collect();
        Self {
            count: folds.len(),
            sign: folds[0].load.signum(),
            pieces,
        }
    }

    /// Where `ln D` is `target` between two samples, no more than a column apart.
    pub fn at(&self, pair: [&Sample; 2], target: f64) -> Near {
        let ends = pair.map(|sample| sample.place);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "places are not negative, and few"
        )]
        let start = stencil(ends[0] as usize, AROUND, self.count);
        let piece = &self.pieces[start];
        let place = place(
            &piece.ln_distance,
            ends.map(|end| end - start as f64),
            pair,
            target,
        );
        let tau = piece.ln_tau.at(place).0.exp();
        let bend = |i: usize| piece.bends[i].at(place).0;
        let pair = |i: usize| DVec2::new(bend(i), bend(i + 1));
        Near {
            tau,
            load: self.sign * piece.ln_q.at(place).0.exp() / (tau * tau),
            phi: piece.phi.at(place).0,
            bends: Some([pair(0) / (tau * tau), pair(2) * tau, pair(4) * tau.powi(4)]),
        }
    }
}

/// The tip edge, by the parts of the load at the corner.
#[derive(Clone, Debug)]
pub struct TipLine {
    tau: f64,
    corner: f64,
    ln_distance: Curve,
    phi: Curve,
    by_load: [Curve; 2],
}

impl TipLine {
    /// Through `landings` with the contact at `tau`, under all parts of the load `corner`, with the directions `phis` of the pole.
    pub fn new(tau: f64, corner: f64, landings: &[Landing], phis: &[f64; LOADS]) -> Self {
        let numbers = |number: fn(&Landing) -> f64| {
            let mut numbers = [0.0; LOADS];
            for (slot, landing) in numbers.iter_mut().zip(landings) {
                *slot = number(landing);
            }
            numbers
        };
        let [ln_distance, phi, by_load @ ..] = through(
            0,
            LOADS,
            [
                numbers(|landing| landing.pole.length().ln()),
                *phis,
                numbers(|landing| landing.by_load.x),
                numbers(|landing| landing.by_load.y),
            ],
        );
        Self {
            tau,
            corner,
            ln_distance,
            phi,
            by_load,
        }
    }

    /// Where `ln D` is `target` between two samples.
    pub fn at(&self, pair: [&Sample; 2], target: f64) -> Near {
        let part = place(
            &self.ln_distance,
            pair.map(|sample| sample.place),
            pair,
            target,
        );
        Near {
            tau: self.tau,
            load: self.corner * part,
            phi: self.phi.at(part).0,
            bends: Some([DVec2::ZERO, DVec2::ZERO, self.bend(part)]),
        }
    }

    /// The load between those of two landings, `m` and the next one, at which `dlnD/dload` is 0, and the second derivatives of `(ln D, phi)`
    /// by the load there.
    pub fn level(&self, m: usize) -> (f64, DVec2) {
        let slope = &self.by_load[0];
        let ends = [PARTS[m], PARTS[m + 1]];
        let [from, to] = ends.map(|part| slope.at(part).0);
        let near = ends[0] + from / (from - to) * (ends[1] - ends[0]);
        let part = slope.solve(0.0, near, oriented(ends, [from, to]), LAST_STEP);
        (self.corner * part, self.bend(part))
    }

    fn bend(&self, part: f64) -> DVec2 {
        let [distance, phi] = &self.by_load;
        DVec2::new(distance.at(part).1, phi.at(part).1) / self.corner
    }
}
