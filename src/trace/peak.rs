//! Largest value of a quantity during a push.

use super::resample::interpolate;
use super::{Branch, BranchPoint};
use crate::sheet::{CurveNode, ON_CURVE};
use whiskmap_mechanics::numerics::least_between;

impl Branch {
    /// Returns the largest `size` of the states of a push from first touch to its detachment. The nodes of the continuation enclose the
    /// maximum, and the golden section finds it between them. A larger maximum between two other nodes can be missed.
    #[must_use]
    pub fn largest(&self, size: fn(&BranchPoint) -> f64) -> f64 {
        let nodes = &self.continuation.nodes;
        let stable = &nodes[..self.continuation.fold.map_or(nodes.len(), |fold| fold + 1)];
        let of = |node: &CurveNode| {
            let states = self.pushed(std::slice::from_ref(node));
            states.map_or(f64::NAN, |states| size(&self.point(&states[0], true)))
        };
        let sizes: Vec<f64> = stable.iter().map(of).collect();
        let Some(best) = (0..sizes.len()).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b])) else {
            return f64::NAN;
        };
        let lengths = self.lengths();
        let ends = [best.saturating_sub(1), (best + 1).min(sizes.len() - 1)];
        let [_, inside] =
            least_between(ends.map(|end| lengths[end]), f64::NEG_INFINITY, |length| {
                let (near, start) = interpolate(nodes, &lengths, length);
                let CurveNode { push, angle, .. } = nodes[near];
                let corrected = self.level.correct(&[start], ON_CURVE).pop().flatten();
                corrected.map_or(f64::NAN, |(point, full)| {
                    -of(&self.level.node(point, &full, push, angle))
                })
            });
        sizes[best].max(-inside)
    }
}
