//! Places on the edges between their samples, as good as most trajectories would tell them.

use crate::numerics::newton_form::{
    Polynomial, oriented, places, stencil, through_slopes, through_values,
};
use crate::sheet::edges::Sample;
use crate::sheet::edges::edge_newton::Bends;
use crate::sheet::fold::contact_nodes::{AROUND, Columns, Line, line};
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
pub const LAST_STEP: f64 = 1e-5;

/// Where `ln D` is `target` on a `line` between two samples.
pub fn place<const N: usize>(
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
        let maps = folds.iter().map(|fold| &fold.variation.map);
        let values: Vec<[f64; 2]> = maps
            .clone()
            .zip(phis)
            .map(|(map, phi)| [map.pole.length().ln(), phi])
            .collect();
        let slopes: Vec<[f64; 2]> = maps
            .enumerate()
            .map(|(column, map)| columns.slope(column, 1.0, map).to_array())
            .collect();
        let bends: Vec<[f64; 6]> = folds
            .iter()
            .map(|fold| {
                let (tau, here) = (fold.tau, &fold.variation);
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
        let bends = |i: usize| DVec2::new(bend(i), bend(i + 1));
        Near {
            tau,
            load: self.sign * piece.ln_q.at(place).0.exp() / (tau * tau),
            phi: piece.phi.at(place).0,
            bends: Some([
                bends(0) / (tau * tau),
                bends(2) * tau,
                bends(4) * tau.powi(4),
            ]),
        }
    }
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    reason = "a sheet that is not there fails the test"
)]
mod tests {
    use super::*;
    use crate::numerics::lobatto::LOADS;
    use crate::rod::{Effects, Rest, Rod, Side};
    use crate::sheet::edges::Edges;
    use crate::sheet::edges::edge_newton::{Edge, Wanted, seek_finely};
    use crate::sheet::fold::contact_nodes::Columns;
    use crate::sheet::lattice::Lattice;
    use crate::sheet::row::Row;
    use crate::shooting::batch::Method;

    /// Places in the middle between samples, against those that trajectories find from there.
    #[test]
    fn edges_are_known_between_their_samples() {
        for side in Side::BOTH {
            let rod = Rod {
                taper: 0.95,
                bend: 0.4,
                pole: 0.0125 * side.sign(),
                ..Rod::default()
            };
            let method = Method::fine(Effects::of([&rod]));
            let row = Row::new(&Rest::new(&rod), 0.1);
            let columns = Columns::new(method, &rod, side, &row).unwrap();
            let lattice = Lattice::new(method.coarsely(), &rod, side, &columns);
            let edges = Edges::new(method, &rod, &Rest::new(&rod), &columns, &lattice);
            let mut checked = 0;
            for (edge, samples) in [(Edge::Fold, &edges.fold), (Edge::Tip, &edges.tip)] {
                for pair in samples.windows(2) {
                    let pair = [&pair[0], &pair[1]];
                    let target = pair[0].ln_distance.midpoint(pair[1].ln_distance);
                    // The nearest row.
                    if target < row.pole_distance.ln() {
                        continue;
                    }
                    let near = match edge {
                        Edge::Fold => edges.fold_line.at(pair, target),
                        Edge::Tip => edges.tip_line.at(pair, target),
                    };
                    let wanted = Wanted {
                        rod,
                        edge,
                        pole_distance: target.exp(),
                        from: DVec2::new(near.tau, near.load),
                    };
                    let found = seek_finely(method, &[wanted])[0];
                    let away = (found.point / wanted.from - DVec2::ONE).abs();
                    assert!(
                        found.is_found && away.max_element() < 1e-7,
                        "{edge:?} {away}"
                    );
                    let phi = found.here.map.pole.to_angle();
                    assert!((near.phi - phi).abs() < 1e-6, "{edge:?}");
                    let [bend, known] = [near.bends.unwrap()[2], found.here.by_load_load];
                    assert!(
                        bend.distance(known) < 1e-2 * known.length(),
                        "{edge:?} {bend}"
                    );
                    checked += 1;
                }
            }
            assert!(checked > 20);
            let turns = edges.tip_line.turns();
            let turning = edges.tip.len() - LOADS;
            assert_eq!(turns.len(), turning);
        }
    }
}
