//! The predictor: points of an edge between its samples, so good that one trajectory mostly confirms them.

use crate::numerics::Bracket;
use crate::numerics::newton_form::{
    Polynomial, RootProblem, even_nodes, stencil, through_slopes, through_values,
};
use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::fold::coordinate::{Hermite, STENCIL, hermite};
use glam::DVec2;

/// A computed point of an edge.
#[derive(Clone, Copy, Debug)]
pub struct EdgeSample {
    /// Along the edge: the contact node of a fold, or the part of the corner's load at the tip.
    pub place: f64,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// `ln D`.
    pub ln_distance: f64,
    /// Direction of the pole, continuous from first touch.
    pub phi: f64,
}

/// Second derivatives of `(ln D, phi)`: twice by `tau`, by `tau` and load, twice by load.
pub type SecondDerivatives = [DVec2; 3];

/// A point of an edge as it is predicted.
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Direction of the pole, continuous from first touch.
    pub phi: f64,
    /// `None` where the point is not known well.
    pub second: Option<SecondDerivatives>,
}

impl Prediction {
    /// Where `ln D` is `target` if all else changes evenly from one sample to the other.
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

/// The last step along an edge, in contact nodes or in parts of the corner's load: its square is left.
pub const LAST_STEP_ALONG_EDGE: f64 = 1e-5;

/// Where `ln_distance` is `target` between the places `ends` of two samples.
pub fn place_between<const N: usize>(
    ln_distance: &Polynomial<N>,
    ends: [f64; 2],
    pair: [&EdgeSample; 2],
    target: f64,
) -> f64 {
    let [from, to] = pair.map(|sample| sample.ln_distance);
    let near = ends[0] + (target - from) / (to - from) * (ends[1] - ends[0]);
    let problem = RootProblem {
        target,
        near,
        bracket: Bracket::new(ends, [from, to]),
    };
    ln_distance.solve(&problem, LAST_STEP_ALONG_EDGE)
}

/// The fold edge over one stencil of contact nodes.
#[derive(Clone, Debug)]
struct FoldPiece {
    ln_distance: Hermite,
    phi: Hermite,
    ln_tau: Hermite,
    ln_q: Hermite,
    /// [`SecondDerivatives`] by `ln tau` and by `load tau^2`, which change little from contact to contact.
    second: [Polynomial<STENCIL>; 6],
}

/// The fold edge between its samples.
#[derive(Clone, Debug)]
pub struct FoldEdge {
    count: usize,
    sign: f64,
    /// By the first node of their stencils.
    pieces: Vec<FoldPiece>,
}

impl FoldEdge {
    /// Through the folds of all contact nodes, with the directions `phis` of the pole.
    pub fn new(contacts: &ContactNodes, phis: impl Iterator<Item = f64>) -> Self {
        let folds = &contacts.folds;
        let maps = folds.iter().map(|fold| &fold.variation.map);
        let values: Vec<[f64; 2]> = maps
            .clone()
            .zip(phis)
            .map(|(map, phi)| [libm::log(map.pole.length()), phi])
            .collect();
        let slopes: Vec<[f64; 2]> = maps
            .enumerate()
            .map(|(i, map)| contacts.slope(i, 1.0, map).to_array())
            .collect();
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
        let pieces = through_slopes(&values, &slopes)
            .iter()
            .zip(through_values::<6, STENCIL>(&second))
            .zip(contacts.ln_tau.iter().zip(&contacts.ln_q))
            .map(|((terms, second), (ln_tau, ln_q))| FoldPiece {
                ln_distance: hermite(terms.map(|term| term[0])),
                phi: hermite(terms.map(|term| term[1])),
                ln_tau: *ln_tau,
                ln_q: *ln_q,
                second: std::array::from_fn(|i| Polynomial {
                    nodes: even_nodes(1),
                    differences: second.map(|term| term[i]),
                }),
            })
            .collect();
        Self {
            count: folds.len(),
            sign: folds[0].load.signum(),
            pieces,
        }
    }

    /// Where `ln D` is `target` between the samples of two neighbouring contact nodes.
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
            second: Some([
                vector(0) / (tau * tau),
                vector(2) * tau,
                vector(4) * tau.powi(4),
            ]),
        }
    }
}
