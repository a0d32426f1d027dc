//! The sampled edges of the stable sheet: the fold at every contact node, and the tip from first touch to the corner.

mod bisection;
pub mod crossings;
pub mod edge_newton;
mod predictor;
mod tip_edge;

use crate::sheet::case::SheetCase;
use crate::sheet::edges::predictor::{EdgeSample, FoldEdge, Prediction};
use crate::sheet::edges::tip_edge::{SampledTipEdge, TipEdge};
use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::row::Edge;
use whiskmap_mechanics::rod::{Rest, arclength};

/// Sampled edges of a sheet.
#[derive(Clone, Debug)]
pub struct Edges {
    /// Samples of the fold edge, from the base to the corner, `[sample]`.
    pub fold: Vec<EdgeSample>,
    fold_edge: FoldEdge,
    /// True if the distance grows along the fold from the base to the tip, also between the samples, so that no row crosses it twice.
    pub fold_grows: bool,
    /// Samples of the tip edge, from first touch to the corner, `[sample]`.
    pub tip: Vec<EdgeSample>,
    /// Polynomials of the tip edge; `None` where the edge needs more samples than polynomials have nodes.
    tip_edge: Option<TipEdge>,
    /// True if the changes along the fold between samples agree with the slopes there.
    fold_is_certified: bool,
    /// Magnitude of the difference in `tau` between the tip of the resting whisker by integration and by its shape at rest.
    pub tip_error: f64,
}

/// Largest difference between the change from one sample to the next and the slope at either of them.
const SLOPE_TOLERANCE: f64 = 0.25;

/// Returns true if the `change` of a function between two samples agrees with its `slopes` there.
fn is_as_steep_as(change: f64, slopes: [f64; 2]) -> bool {
    slopes.iter().all(|slope| (change - slope).abs() < SLOPE_TOLERANCE)
}

impl Edges {
    /// Samples both edges of the sheet.
    pub fn new(case: SheetCase, contacts: &ContactNodes) -> Self {
        let rod = case.rod;
        let fold: Vec<EdgeSample> = contacts.folds[..=contacts.tip]
            .iter()
            .enumerate()
            .map(|(i, fold)| EdgeSample {
                place: i as f64,
                tau: fold.tau,
                load: fold.load,
                ln_distance: libm::log(fold.variation.map.pole.length()),
                phi: fold.phi,
            })
            .collect();
        let corner = &contacts.folds[contacts.tip];
        let SampledTipEdge { samples: mut tip, edge: tip_edge, at_touch } =
            SampledTipEdge::new(case, corner);
        let rest = Rest::new(rod);
        let (tip_at_rest, _) = rest.at_arclength(arclength(rod, rod.tau_tip()));
        let pole = rest.pole_at_distance(tip_at_rest.length()).length();
        tip.extend(fold.last().map(|corner| EdgeSample { place: 1.0, ..*corner }));
        let is_certified = |(i, pair): (usize, &[EdgeSample])| {
            let slopes = [i, i + 1].map(|i| contacts.slope(i));
            let [from, to] = [pair[0], pair[1]];
            is_as_steep_as(to.ln_distance - from.ln_distance, slopes.map(|by| by.x))
                && is_as_steep_as(to.phi - from.phi, slopes.map(|by| by.y))
        };
        let fold_edge = FoldEdge::new(contacts);
        Self {
            fold_is_certified: fold.windows(2).enumerate().all(is_certified),
            fold_grows: (0..contacts.tip).all(|i| fold_edge.grows_after(i)),
            fold,
            fold_edge,
            tip,
            tip_edge,
            tip_error: (libm::log(at_touch.pole.length() / pole) / at_touch.by_tau.x).abs(),
        }
    }

    /// Returns the predicted point of `edge` between two neighbouring samples at which `ln D` is `target`.
    pub fn predict(&self, edge: Edge, pair: [&EdgeSample; 2], target: f64) -> Prediction {
        match edge {
            Edge::Fold => self.fold_edge.predict(pair, target),
            Edge::Tip => match &self.tip_edge {
                Some(tip_edge) => tip_edge.predict(pair, target),
                None => Prediction::linear(pair, target),
            },
        }
    }

    /// Returns true if no crossing is hidden between the samples of the edges.
    pub fn are_certified(&self) -> bool {
        self.fold_is_certified && self.tip_edge.is_some()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a sheet that is not there fails the test")]
mod tests {
    use super::*;
    use crate::newton::LaneSharing;
    use crate::sheet::edges::edge_newton::{EdgeProblem, edge_newton};
    use crate::sheet::fold::contact_nodes::{Folds, SPACING};
    use crate::sheet::row::Edge;
    use crate::sheet::row::Row;
    use glam::DVec2;
    use whiskmap_mechanics::numerics::chebyshev::CHEBYSHEV_COUNT;
    use whiskmap_mechanics::rod::{Rest, Rod, Side};
    use whiskmap_mechanics::shooting::batch::Method;

    /// Compares predictions in the middle between samples with the results of Newton's method from there.
    #[test]
    fn edges_are_known_between_their_samples() {
        for side in Side::BOTH {
            let rod = Rod { taper: 0.95, bend: 0.4, pole: 0.0125 * side.sign(), ..Rod::default() };
            let method = Method::fine();
            let row = Row::new(&Rest::new(&rod), 0.1);
            let case = SheetCase { method, rod: &rod, side };
            let contacts = ContactNodes::new(case, &row, SPACING, Folds::Predicted).unwrap();
            let edges = Edges::new(case, &contacts);
            let mut checked = 0;
            for (edge, samples) in [(Edge::Fold, &edges.fold), (Edge::Tip, &edges.tip)] {
                for pair in samples.windows(2) {
                    let pair = [&pair[0], &pair[1]];
                    let target = pair[0].ln_distance.midpoint(pair[1].ln_distance);
                    // Contacts are sampled only as far as this nearest row.
                    if target < row.pole_distance.ln() {
                        continue;
                    }
                    let predicted = edges.predict(edge, pair, target);
                    let problem = EdgeProblem {
                        rod: &rod,
                        edge,
                        pole_distance: target.exp(),
                        start: DVec2::new(predicted.tau, predicted.load),
                        second: None,
                    };
                    let found = edge_newton(method, LaneSharing::Open, &[problem])[0];
                    let away = (found.point / problem.start - DVec2::ONE).abs();
                    assert!(found.has_converged && away.max_element() < 1e-7, "{edge:?} {away}");
                    let phi = found.here.map.pole.to_angle();
                    assert!((predicted.phi - phi).abs() < 1e-6, "{edge:?}");
                    let second = predicted.second.unwrap()[2];
                    let known = found.here.by_load_load;
                    assert!(second.distance(known) < 1e-2 * known.length(), "{edge:?} {second}");
                    checked += 1;
                }
            }
            assert!(checked > 20);
            let extrema = edges.tip.len() - CHEBYSHEV_COUNT;
            assert_eq!(edges.tip_edge.unwrap().extrema().len(), extrema);
        }
    }
}
