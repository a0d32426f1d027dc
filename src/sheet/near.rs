//! Places on the edges between their samples, as good as most trajectories would tell them.

use super::edges::Sample;
use super::fold::FoldPoint;
use super::polynomial::{NODES, Polynomial, differences_of_each, stencil};
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

/// `N` numbers along an edge, `ln D` the first of them: polynomials through [`NODES`] neighbouring even samples.
#[derive(Clone, Debug)]
struct Line<const N: usize> {
    count: usize,
    /// Divided differences, by the first sample.
    pieces: Vec<[[f64; N]; NODES]>,
}

impl<const N: usize> Line<N> {
    fn new(samples: &[[f64; N]]) -> Self {
        Self {
            count: samples.len(),
            pieces: differences_of_each(samples),
        }
    }

    /// The place `between` two, no more than a sample apart, where the number `which` is `target`; they lie on different sides
    /// of it. The numbers there, and their slopes.
    fn find(&self, which: usize, between: [f64; 2], target: f64) -> Point<N> {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "places are not negative, and few"
        )]
        let start = stencil((0.5 * (between[0] + between[1])) as usize, self.count);
        let piece = &self.pieces[start];
        let number = Polynomial::of(piece.map(|differences| differences[which]));
        let between = between.map(|place| place - start as f64);
        let [from, to] = between.map(|place| number.at(place).0);
        let part = (target - from) / (to - from);
        let near = part.mul_add(between[1] - between[0], between[0]);
        let place = number.solve(target, near, between);
        let (mut values, mut slopes) = (piece[NODES - 1], [0.0; N]);
        for i in (0..NODES - 1).rev() {
            let x = place - i as f64;
            for j in 0..N {
                slopes[j] = slopes[j] * x + values[j];
                values[j] = values[j] * x + piece[i][j];
            }
        }
        Point {
            place: place + start as f64,
            values,
            slopes,
        }
    }
}

/// What a line has at a place.
struct Point<const N: usize> {
    place: f64,
    values: [f64; N],
    slopes: [f64; N],
}

/// The fold edge: `ln D`, `ln tau`, `load tau^2`, the direction of the pole, and second derivatives in the logarithm of `tau`
/// and in `load tau^2`, which change little from contact to contact.
#[derive(Clone, Debug)]
pub struct FoldLine(Line<10>);

impl FoldLine {
    /// Through the folds of all columns, with the directions `phis` of the pole.
    pub fn new(folds: &[FoldPoint], phis: impl Iterator<Item = f64>) -> Self {
        let numbers = |(fold, phi): (&FoldPoint, f64)| {
            let (tau, here) = (fold.tau, &fold.landing);
            let tau_tau = here.by_tau_tau * tau.powi(2);
            let tau_load = here.by_tau_load / tau;
            let load_load = here.by_load_load / tau.powi(4);
            [
                here.landing.pole.length().ln(),
                tau.ln(),
                fold.load * tau * tau,
                phi,
                tau_tau.x,
                tau_tau.y,
                tau_load.x,
                tau_load.y,
                load_load.x,
                load_load.y,
            ]
        };
        let samples: Vec<[f64; 10]> = folds.iter().zip(phis).map(numbers).collect();
        Self(Line::new(&samples))
    }

    /// Where `ln D` is `target` between two places.
    pub fn at(&self, between: [f64; 2], target: f64) -> Near {
        let [_, ln_tau, q, phi, bends @ ..] = self.0.find(0, between, target).values;
        let tau = ln_tau.exp();
        let pair = |i: usize| DVec2::new(bends[i], bends[i + 1]);
        Near {
            tau,
            load: q / (tau * tau),
            phi,
            bends: Some([pair(0) / (tau * tau), pair(2) * tau, pair(4) * tau.powi(4)]),
        }
    }
}

/// The tip edge: `ln D`, the direction of the pole, and the derivatives of both by the load.
#[derive(Clone, Debug)]
pub struct TipLine {
    tau: f64,
    /// From sample to sample.
    load_step: f64,
    line: Line<4>,
}

impl TipLine {
    /// Through `landings` with the contact at `tau`, under the loads 0, `load_step`, ..., with the directions `phis` of the pole.
    pub fn new(tau: f64, load_step: f64, landings: &[Landing], phis: &[f64]) -> Self {
        let numbers = |(landing, phi): (&Landing, &f64)| {
            let ln_distance = landing.pole.length().ln();
            [ln_distance, *phi, landing.by_load.x, landing.by_load.y]
        };
        let samples: Vec<[f64; 4]> = landings.iter().zip(phis).map(numbers).collect();
        Self {
            tau,
            load_step,
            line: Line::new(&samples),
        }
    }

    /// Where `ln D` is `target` between two places.
    pub fn at(&self, between: [f64; 2], target: f64) -> Near {
        let found = self.line.find(0, between, target);
        Near {
            tau: self.tau,
            load: self.load_step * found.place,
            phi: found.values[1],
            bends: Some([DVec2::ZERO, DVec2::ZERO, self.bend(&found)]),
        }
    }

    /// The load between two places at which `dlnD/dload` is 0, and the second derivatives of `(ln D, phi)` by the load there.
    pub fn level(&self, between: [f64; 2]) -> (f64, DVec2) {
        let found = self.line.find(2, between, 0.0);
        (self.load_step * found.place, self.bend(&found))
    }

    fn bend(&self, found: &Point<4>) -> DVec2 {
        DVec2::new(found.slopes[2], found.slopes[3]) / self.load_step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two functions on even samples, found by either of them: also between places that are no samples.
    #[test]
    fn a_line_knows_what_is_between_its_samples() {
        let [f, g] = [|t: f64| (0.1 * t).exp(), |t: f64| (0.1 * t).sin()];
        for count in [9, NODES, 30] {
            let samples: Vec<[f64; 2]> = (0..count).map(|t| [f(t as f64), g(t as f64)]).collect();
            let line = Line::new(&samples);
            for (from, to, part) in [(0, 1, 0.2), (4, 5, 0.0), (6, 7, 0.7), (7, 8, 1.0)] {
                let between = [f64::from(from), f64::from(to)];
                let t = between[0] + part;
                for (which, target) in [f(t), g(t)].into_iter().enumerate() {
                    for between in [between, [between[0], between[1].midpoint(t)]] {
                        let found = line.find(which, between, target);
                        let values = [f(t), g(t)];
                        let slopes = [0.1 * f(t), 0.1 * (0.1 * t).cos()];
                        assert!((found.place - t).abs() < 1e-9, "{count} {t} {which}");
                        for i in 0..2 {
                            assert!((found.values[i] - values[i]).abs() < 1e-9, "{count} {t}");
                            assert!((found.slopes[i] - slopes[i]).abs() < 1e-8, "{count} {t}");
                        }
                    }
                }
            }
        }
    }
}
