//! Continuation along `D = const`: the states in front of one pole, from first touch through the fold to the end of the branch.

pub mod level_curve;
pub mod pieces;
pub mod walked;

use crate::sheet::continuation::level_curve::{LevelCurve, Node, ON_CURVE};
use crate::sheet::edges::edge_newton::{EdgeProblem, edge_newton_fine};
use crate::sheet::row::Edge;
use glam::DVec2;

/// Nodes are about this far apart.
const NODE_DISTANCE: f64 = 0.05;

/// Neighbouring chords make at most this angle, unless they are short, so that their length is that of the curve.
const SHARPEST_TURN: f64 = 0.1;

/// Chords shorter than this may turn as they like: after a longer one, no step is short enough not to.
const SHORT: f64 = 0.01 * NODE_DISTANCE;

/// The first step of the continuation, relative to contact and load.
const FIRST_ARC_STEP: f64 = 0.05;

/// A step that has become this short leads nowhere.
const SHORTEST_ARC_STEP: f64 = 1e-9;

/// Most nodes: no branch known has more than 300.
const MOST_NODES: usize = 10_000;

/// A part of a level curve.
#[derive(Clone, Debug)]
pub struct Continuation {
    /// From the start on.
    pub nodes: Vec<Node>,
    /// Index of the fold; `None` where the tip comes first.
    pub fold: Option<usize>,
    /// What the last node is.
    pub end: Edge,
}

/// What `ln D` may miss at the tip, where moving the contact would do more harm.
const TIP_MISS: f64 = 1e-11;

impl LevelCurve {
    /// The curve from `start` on to the tip or the fold, or past the fold to the tip or the second one; `None` where the continuation
    /// gets lost.
    #[must_use]
    pub fn continuation(&self, start: Node, past_fold: bool) -> Option<Continuation> {
        let mut nodes = vec![start];
        let mut fold = None;
        let mut step = FIRST_ARC_STEP;
        while nodes.len() < MOST_NODES && step > SHORTEST_ARC_STEP {
            let last = *nodes.last()?;
            let next = self.step(&last, step);
            let fits = |next: &Node| {
                let chord = self.place(next) - self.place(&last);
                let before = nodes.iter().rev().nth(1);
                let turn = before.map_or(0.0, |before| {
                    chord.angle_between(self.place(&last) - self.place(before))
                });
                chord.length() < 2.0 * NODE_DISTANCE
                    && (turn < SHARPEST_TURN || chord.length() < SHORT)
            };
            let Some(next) = next.filter(fits) else {
                step *= 0.5;
                continue;
            };
            let (edge, node) = match meet(self, &last, &next, fold.is_none()) {
                Meeting::None => {
                    step *= (NODE_DISTANCE / self.length(&last, &next)).clamp(0.5, 2.0);
                    nodes.push(next);
                    continue;
                }
                Meeting::Unclear => {
                    step *= 0.5;
                    continue;
                }
                Meeting::Edge(edge, node) => (edge, node),
            };
            // Two nodes next to each other are a poor base for interpolation.
            if let [.., before, _] = nodes[..]
                && fold != Some(nodes.len() - 1)
                && self.length(&last, &node) < 0.2 * self.length(&before, &last)
            {
                nodes.pop();
            }
            nodes.push(node);
            let first_fold = edge == Edge::Fold && fold.is_none();
            if first_fold {
                fold = Some(nodes.len() - 1);
            }
            if !(first_fold && past_fold) {
                return Some(Continuation {
                    nodes,
                    fold,
                    end: edge,
                });
            }
        }
        None
    }
}

/// What lies between two nodes.
enum Meeting {
    None,
    Edge(Edge, Node),
    /// An edge, but Newton's method did not find it from here.
    Unclear,
}

/// The first edge between two nodes of the stable or the unstable part.
fn meet(level: &LevelCurve, from: &Node, to: &Node, stable: bool) -> Meeting {
    let mut met = Meeting::None;
    if to.point.x > level.rod.tau_tip() {
        let Some(tip) = edge(level, Edge::Tip, from, to) else {
            return Meeting::Unclear;
        };
        met = Meeting::Edge(Edge::Tip, tip);
    }
    if (to.full.map.det() < 0.0) == stable {
        match edge(level, Edge::Fold, from, to) {
            None => return Meeting::Unclear,
            Some(fold) if fold.point.x <= level.rod.tau_tip() => {
                met = Meeting::Edge(Edge::Fold, fold);
            }
            Some(_) => {}
        }
    }
    met
}

/// The point of an edge between two nodes; `None` if Newton's method found none, or one somewhere else.
fn edge(level: &LevelCurve, edge: Edge, from: &Node, to: &Node) -> Option<Node> {
    let height = |node: &Node| match edge {
        Edge::Fold => node.full.map.det(),
        Edge::Tip => node.point.x - level.rod.tau_tip(),
    };
    let part = height(from) / (height(from) - height(to));
    let start = from.point.lerp(to.point, part.clamp(0.0, 1.0));
    let start = match edge {
        Edge::Fold => start,
        Edge::Tip => DVec2::new(level.rod.tau_tip(), start.y),
    };
    let problem = EdgeProblem {
        rod: &level.rod,
        edge,
        pole_distance: level.row.pole_distance,
        start,
        second: None,
    };
    let iterate = *edge_newton_fine(level.method, &[problem]).first()?;
    // At a fold rounding can leave Newton's method a little beside the curve; at the tip it is on it.
    let tolerance = match edge {
        Edge::Fold => ON_CURVE,
        Edge::Tip => TIP_MISS,
    };
    let (point, full) = level.correct(&[iterate.point], tolerance).pop()??;
    let node = level.node(point, &full, from.push, from.angle);
    let reach = 2.0 * level.length(from, to) + f64::EPSILON;
    let near = level.length(from, &node).max(level.length(to, &node)) <= reach;
    (iterate.has_converged && near).then_some(node)
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    reason = "a branch that is not there fails the test"
)]
mod tests {
    use super::*;
    use crate::rod::{Rest, Rod, Side};
    use crate::sheet::row::Row;
    use crate::shooting::batch::Method;

    /// Stable and unstable states of branches, up to their folds, where the push angle is flat.
    #[test]
    fn a_state_at_a_push_takes_few_iterations() {
        for side in Side::BOTH {
            let rod = Rod {
                taper: 0.95,
                bend: 0.4,
                pole: 0.0125 * side.sign(),
                ..Rod::default()
            };
            let row = Row::new(&Rest::new(&rod), 0.75);
            let level = LevelCurve::new(Method::fine(), &rod, side, &row);
            let branch = level.continuation(level.touch().unwrap(), true).unwrap();
            let fold = branch.fold.unwrap();
            for part in [&branch.nodes[..=fold], &branch.nodes[fold..]] {
                let [from, to] = [part[0].push, part[part.len() - 1].push];
                for i in 0..=200 {
                    let push = from + (to - from) * f64::from(i) / 200.0;
                    let (node, root) = level.bracketed_push(part, push).unwrap();
                    assert!((node.push - push).abs() <= ON_CURVE, "{push} {root:?}");
                    assert!(root.iterations <= 10, "{push} {root:?}");
                }
            }
        }
    }
}
