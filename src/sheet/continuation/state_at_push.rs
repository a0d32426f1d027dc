//! The state at a push angle on a part of a level curve that has been walked.

use crate::sheet::continuation::level_curve::{LevelCurve, Node, ON_CURVE};

/// Rounds of the search between two nodes; bisection alone would need 50.
const MOST_ROUNDS: usize = 100;

impl LevelCurve {
    /// The state at the signed `push` (radians) on a part of the curve along which the push angle grows or falls
    /// throughout; `None` outside, or where the curve is lost.
    #[must_use]
    pub fn find(&self, part: &[Node], push: f64) -> Option<Node> {
        let above = |node: &Node| self.side.sign() * (node.push - push) > 0.0;
        let pair = part.windows(2).find(|pair| {
            above(&pair[0]) != above(&pair[1]) || pair[0].push == push || pair[1].push == push
        })?;
        self.between(&pair[0], &pair[1], push)
    }

    /// The node at `push` between two others: regula falsi along the curve, with the Illinois weights, which needs no
    /// Jacobian and so is as good at the fold as elsewhere.
    fn between(&self, from: &Node, to: &Node, push: f64) -> Option<Node> {
        let miss = |node: &Node| node.push - push;
        let (mut low, mut at_low) = (0.0, miss(from));
        let (mut high, mut at_high) = (1.0, miss(to));
        let mut best = if at_low.abs() < at_high.abs() {
            *from
        } else {
            *to
        };
        for _ in 0..MOST_ROUNDS {
            if miss(&best).abs() <= f64::EPSILON * push.abs() || high - low <= f64::EPSILON {
                break;
            }
            let t = (low * at_high - high * at_low) / (at_high - at_low);
            let start = from.point.lerp(to.point, t.clamp(0.0, 1.0));
            let (point, full) = self.settle(&[start], ON_CURVE).pop()??;
            let node = self.node(point, &full, from.push, from.angle);
            if miss(&node).abs() < miss(&best).abs() {
                best = node;
            }
            if (miss(&node) > 0.0) == (at_high > 0.0) {
                (high, at_high, at_low) = (t, miss(&node), 0.5 * at_low);
            } else {
                (low, at_low, at_high) = (t, miss(&node), 0.5 * at_high);
            }
        }
        Some(best)
    }
}
