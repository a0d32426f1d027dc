//! Crossings that Newton's method loses because the distance turns along the edge nearby.

use crate::rod::{Rod, Side};
use crate::sheet::edges::Sample;
use crate::sheet::edges::edge_newton::Edge;
use crate::sheet::fold::first_folds;
use crate::shooting::SecondVariation;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use glam::DVec2;

/// Halvings: more than a mantissa has bits.
const ROUNDS: usize = 64;

/// The point `(tau, load)` of `edge` at which `ln D` is `target`, between two samples; the one that is closer to it where
/// both are on the same side. `None` where a fold is missing.
pub fn bisect(
    method: Method,
    rod: &Rod,
    side: Side,
    edge: Edge,
    target: f64,
    [from, to]: [Sample; 2],
) -> Option<(DVec2, SecondVariation)> {
    let between = |part: f64| -> Option<(DVec2, SecondVariation)> {
        let tau = from.tau + part * (to.tau - from.tau);
        if edge == Edge::Fold {
            let fold = first_folds(method, rod, side, &[tau]).pop()??;
            return Some((DVec2::new(tau, fold.load), fold.variation));
        }
        let load = from.load + part * (to.load - from.load);
        let shot =
            Batch::new(method).shoot::<SecondVariation>(&[InitialCondition { rod, tau, load }]);
        Some((DVec2::new(tau, load), *shot.first()?))
    };
    let is_nearer = |ln_distance: f64| ln_distance <= target;
    if is_nearer(from.ln_distance) == is_nearer(to.ln_distance) {
        let miss = |sample: Sample| (sample.ln_distance - target).abs();
        return between(if miss(from) <= miss(to) { 0.0 } else { 1.0 });
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..ROUNDS {
        let middle = 0.5 * (low + high);
        let (_, here) = between(middle)?;
        if is_nearer(here.map.pole.length().ln()) == is_nearer(from.ln_distance) {
            low = middle;
        } else {
            high = middle;
        }
    }
    between(0.5 * (low + high))
}
