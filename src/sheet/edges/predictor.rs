//! The predictor of crossings: points of an edge between its samples, usually so accurate that one trajectory confirms them.

use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::fold::coordinate::{Hermite, STENCIL};
use glam::DVec2;
use whiskmap_mechanics::numerics::Bracket;
use whiskmap_mechanics::numerics::newton_form::{Polynomial, RootProblem, stencil, through_runs};

/// Sample of an edge of the sheet: a computed point.
#[derive(Clone, Copy, Debug)]
pub struct EdgeSample {
    /// Coordinate of the sample along the edge, dimensionless: the index of the contact node on the fold, or the part of the corner's
    /// load at the tip.
    pub place: f64,
    /// Contact coordinate `tau` of the edge sample, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` of the edge sample, dimensionless.
    pub load: f64,
    /// Logarithm `ln D` of the pole's distance, in whisker lengths, at the edge sample.
    pub ln_distance: f64,
    /// Direction of the pole at the edge sample in radians, continuous from first touch.
    pub phi: f64,
}

/// Second derivatives of `(ln D, phi)` at a point of an edge: twice by `tau`, by `tau` and load, twice by load.
pub type SecondDerivatives = [DVec2; 3];

/// Predicted point of an edge of the sheet, where Newton's method starts.
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    /// Contact coordinate `tau` of the predicted point, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` of the predicted point, dimensionless.
    pub load: f64,
    /// Direction of the pole at the predicted point in radians, continuous from first touch.
    pub phi: f64,
    /// Second derivatives of `(ln D, phi)` at the predicted point; `None` where the prediction is poor.
    pub second: Option<SecondDerivatives>,
}

impl Prediction {
    /// Returns the point between two edge samples at which `ln D` is `target` if all quantities change linearly from one sample to the
    /// other.
    pub fn linear([a, b]: [&EdgeSample; 2], target: f64) -> Self {
        let t = (target - a.ln_distance) / (b.ln_distance - a.ln_distance);
        let scaled = |s: &EdgeSample| s.load * s.tau * s.tau;
        let tau = a.tau * libm::exp(t * libm::log(b.tau / a.tau));
        Self {
            tau,
            load: (scaled(a) + t * (scaled(b) - scaled(a))) / (tau * tau),
            phi: a.phi + t * (b.phi - a.phi),
            second: None,
        }
    }
}

/// Newton step along an edge, in contact nodes or in parts of the corner's load, after which the iteration stops. The remaining error is
/// its square.
pub const LAST_STEP_ALONG_EDGE: f64 = 1e-5;

/// Returns the place along an edge between the places `ends` of two samples at which `ln_distance` is `target`.
pub fn place_between<const N: usize>(
    ln_distance: &Polynomial<N>,
    ends: [f64; 2],
    pair: [&EdgeSample; 2],
    target: f64,
) -> f64 {
    let [from, to] = pair.map(|sample| sample.ln_distance);
    let near = ends[0] + (target - from) / (to - from) * (ends[1] - ends[0]);
    let problem = RootProblem { target, near, bracket: Bracket::new(ends, [from, to]) };
    ln_distance.solve(&problem, LAST_STEP_ALONG_EDGE)
}

/// Polynomials of the fold edge over one stencil of contact nodes.
#[derive(Clone, Debug)]
struct FoldPiece {
    ln_distance: Hermite,
    phi: Hermite,
    ln_tau: Hermite,
    ln_q: Hermite,
    /// [`SecondDerivatives`] by `ln tau` and by `load tau^2`, which change little from contact to contact.
    second: [Polynomial<STENCIL>; 6],
}

/// Number of parts of the interval between two samples at whose ends the slope of `ln D` is checked.
const SLOPES: u32 = 8;

/// Smallest slope of `ln D` between two samples, in parts of its mean there, of a fold edge that certainly grows. The distance turned back
/// in 52 of 850,000 intervals of 116,000 random whiskers. The smallest slope of their polynomials was at most 0.09.
const LEAST_SLOPE: f64 = 0.25;

/// Fold edge between its samples, as polynomials.
#[derive(Clone, Debug)]
pub struct FoldEdge {
    count: usize,
    sign: f64,
    /// Pieces of the edge, indexed by the first node of their stencil.
    pieces: Vec<FoldPiece>,
}

impl FoldEdge {
    /// Interpolates the folds of all contact nodes.
    pub fn new(contacts: &ContactNodes) -> Self {
        let folds = &contacts.folds;
        let values: Vec<[f64; 2]> = folds
            .iter()
            .map(|fold| [libm::log(fold.variation.map.pole.length()), fold.phi])
            .collect();
        let slopes = (0..folds.len()).map(|i| contacts.slope(i).to_array());
        let slopes: Vec<[f64; 2]> = slopes.collect();
        let second: Vec<[f64; 6]> = folds
            .iter()
            .map(|fold| {
                let (tau, here) = (fold.tau, &fold.variation);
                let tau_tau = here.by_tau_tau * tau.powi(2);
                let tau_load = here.by_tau_load / tau;
                let load_load = here.by_load_load / tau.powi(4);
                let [a, b, c] = [tau_tau, tau_load, load_load];
                [a.x, a.y, b.x, b.y, c.x, c.y]
            })
            .collect();
        let pieces = through_runs(&values, &slopes)
            .iter()
            .zip(through_runs::<6, STENCIL>(&second, &[]))
            .zip(contacts.ln_tau.iter().zip(&contacts.ln_q))
            .map(|((terms, second), (ln_tau, ln_q))| FoldPiece {
                ln_distance: Hermite::on_even_nodes(2, terms.map(|term| term[0])),
                phi: Hermite::on_even_nodes(2, terms.map(|term| term[1])),
                ln_tau: *ln_tau,
                ln_q: *ln_q,
                second: std::array::from_fn(|i| {
                    Polynomial::on_even_nodes(1, second.map(|term| term[i]))
                }),
            })
            .collect();
        Self { count: folds.len(), sign: folds[0].load.signum(), pieces }
    }

    /// Returns true if the distance grows steadily from the sample `after` to the next one. At a cusp, where two folds meet, it turns back.
    /// A row then crosses the edge three times between the samples, or twice although both samples are nearer.
    pub fn grows_after(&self, after: usize) -> bool {
        let start = stencil(after, STENCIL, self.count);
        let ln_distance = &self.pieces[start].ln_distance;
        let from = (after - start) as f64;
        let change = ln_distance.at(from + 1.0).0 - ln_distance.at(from).0;
        let mut parts = (1..SLOPES).map(|i| f64::from(i) / f64::from(SLOPES));
        change > 0.0 && parts.all(|part| ln_distance.at(from + part).1 > LEAST_SLOPE * change)
    }

    /// Returns the predicted point of the fold edge between the samples of two neighbouring contact nodes at which `ln D` is `target`.
    pub fn predict(&self, pair: [&EdgeSample; 2], target: f64) -> Prediction {
        let ends = pair.map(|sample| sample.place);
        let start = stencil(ends[0] as usize, STENCIL, self.count);
        let piece = &self.pieces[start];
        let ends = ends.map(|end| end - start as f64);
        let place = place_between(&piece.ln_distance, ends, pair, target);
        let tau = libm::exp(piece.ln_tau.at(place).0);
        let number = |i: usize| piece.second[i].at(place).0;
        let vector = |i: usize| DVec2::new(number(i), number(i + 1));
        Prediction {
            tau,
            load: self.sign * libm::exp(piece.ln_q.at(place).0) / (tau * tau),
            phi: piece.phi.at(place).0,
            second: Some([vector(0) / (tau * tau), vector(2) * tau, vector(4) * tau.powi(4)]),
        }
    }
}
