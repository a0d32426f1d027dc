//! The state of a branch at a push angle.

use super::{Branch, NoState};
use crate::model::Full;
use crate::sheet::{Node, ON_CURVE, Walk};

/// Rounds of the search between two nodes; bisection alone would need 50.
const MOST_ROUNDS: usize = 100;

/// A state found on a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Push angle, signed, in radians: the one asked for but for the residual.
    pub push: f64,
    /// Everything else.
    pub full: Full,
}

impl Branch {
    /// The state after the signed push angle `push`, in radians, on the stable or the unstable part.
    ///
    /// # Errors
    /// When there is no such state: the message tells how the whisker has left the pole, and at which push angle.
    pub fn state(&self, push: f64, stable: bool) -> Result<Found, NoState> {
        let Walk { nodes, fold, end } = &self.walk;
        let part = match (fold, stable) {
            (Some(fold), true) => &nodes[..=*fold],
            (Some(fold), false) => &nodes[*fold..],
            (None, true) => &nodes[..],
            (None, false) => {
                return Err(NoState::NoFold {
                    at_deg: nodes[nodes.len() - 1].push.to_degrees(),
                });
            }
        };
        let (first, last) = (&part[0], &part[part.len() - 1]);
        let above = |node: &Node| self.level.side.sign() * (node.push - push) > 0.0;
        let Some(k) = part.windows(2).position(|pair| {
            above(&pair[0]) != above(&pair[1]) || pair[0].push == push || pair[1].push == push
        }) else {
            let at_deg = last.push.to_degrees();
            return Err(match (stable, fold, end) {
                (false, ..) => NoState::NotUnstable {
                    ends_deg: [first.push.to_degrees(), at_deg],
                },
                (true, Some(_), _) => NoState::SlippedOff { at_deg },
                (true, None, _) => NoState::PulledOff { at_deg },
            });
        };
        let node = self.between(&part[k], &part[k + 1], push)?;
        Ok(Found {
            tau: node.point.x,
            load: node.point.y,
            push,
            full: node.full,
        })
    }

    /// The node at `push` between two others: regula falsi along the curve, with the Illinois weights, which needs no
    /// Jacobian and so is as good at the fold as elsewhere.
    fn between(&self, from: &Node, to: &Node, push: f64) -> Result<Node, NoState> {
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
            let settled = self.level.settle(&[start], ON_CURVE).pop().flatten();
            let (point, full) = settled.ok_or_else(|| self.lost())?;
            let node = self.level.node(point, &full, from.push, from.angle);
            if miss(&node).abs() < miss(&best).abs() {
                best = node;
            }
            if (miss(&node) > 0.0) == (at_high > 0.0) {
                (high, at_high, at_low) = (t, miss(&node), 0.5 * at_low);
            } else {
                (low, at_low, at_high) = (t, miss(&node), 0.5 * at_high);
            }
        }
        Ok(best)
    }
}
