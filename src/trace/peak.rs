//! Largest value of a quantity during a push.

use super::resample::interpolate;
use super::{Branch, BranchPoint};
use crate::sheet::{CurveNode, ON_CURVE};
use whiskmap_mechanics::numerics::least_between;

/// Largest excess of a maximum over the value at the end, relative to this, with which it counts as that at the end.
const AT_END: f64 = 1e-9;

/// Largest value of a quantity during a push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushPeak {
    /// Largest size of the quantity, in its unit; NaN if no state is known.
    pub size: f64,
    /// Push angle of the largest size, in degrees; `None` at the end of the push.
    pub before_end_deg: Option<f64>,
}

impl Branch {
    /// Returns the largest `size` of the states of a push from first touch to its detachment, as [`Branch::peak`] does.
    #[must_use]
    pub fn largest(&self, size: fn(&BranchPoint) -> f64) -> f64 {
        self.peak(size).size
    }

    /// Returns the largest `size` of the states of a push from first touch to its detachment, with its push angle. The nodes of the continuation enclose the
    /// maximum, and the golden section finds it between them. A larger maximum between two other nodes can be missed.
    #[must_use]
    pub fn peak(&self, size: fn(&BranchPoint) -> f64) -> PushPeak {
        let nodes = &self.continuation.nodes;
        let stable = &nodes[..self.continuation.fold.map_or(nodes.len(), |fold| fold + 1)];
        let of = |node: &CurveNode| {
            let states = self.pushed(std::slice::from_ref(node));
            states.map_or(f64::NAN, |states| size(&self.point(&states[0], true)))
        };
        let sizes: Vec<f64> = stable.iter().map(of).collect();
        let Some(best) = (0..sizes.len()).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b])) else {
            return PushPeak {
                size: f64::NAN,
                before_end_deg: None,
            };
        };
        let lengths = self.lengths();
        let ends = [best.saturating_sub(1), (best + 1).min(sizes.len() - 1)];
        let mut push_deg = f64::NAN;
        let [at, inside] =
            least_between(ends.map(|end| lengths[end]), f64::NEG_INFINITY, |length| {
                let (near, start) = interpolate(nodes, &lengths, length);
                let CurveNode { push, angle, .. } = nodes[near];
                let corrected = self.level.correct(&[start], ON_CURVE).pop().flatten();
                corrected.map_or(f64::NAN, |(point, full)| {
                    -of(&self.level.node(point, &full, push, angle))
                })
            });
        let (last, inside) = (sizes[sizes.len() - 1], -inside);
        let size = sizes[best].max(inside);
        // Next to the end, the push angle of a maximum is known to the root of the rounding errors.
        let is_before = size > last * (1.0 + AT_END);
        if is_before {
            let at = if inside >= sizes[best] {
                at
            } else {
                lengths[best]
            };
            let (near, start) = interpolate(nodes, &lengths, at);
            let CurveNode { push, angle, .. } = nodes[near];
            let corrected = self.level.correct(&[start], ON_CURVE).pop().flatten();
            let node = corrected.map(|(point, full)| self.level.node(point, &full, push, angle));
            push_deg = node.unwrap_or(nodes[best]).push.to_degrees();
        }
        PushPeak {
            size,
            before_end_deg: is_before.then_some(push_deg),
        }
    }
}
