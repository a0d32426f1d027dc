//! Continuation along `D = const`: the states in front of one pole, from first touch through the fold to the end of the branch.

mod corrector;
pub mod level_curve;
mod meeting;
pub mod pieces;
pub mod walked;

use crate::sheet::continuation::corrector::{Correction, Corrector, shoot};
use crate::sheet::continuation::level_curve::{LevelCurve, Node, ON_CURVE};
use crate::sheet::continuation::meeting::{Chord, Meeting, meet};
use crate::sheet::row::Edge;
use crate::shooting::FullState;
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

/// What `ln D` may miss at a node between the ends that only tells the way, and about where states are.
pub const NODE_MISS: f64 = 1e-8;

/// A predictor bends where the direction has changed by less than this since the node before.
const MOST_BEND: f64 = 0.25;

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

impl LevelCurve {
    /// The curve from `start` on to the tip or the fold, or past the fold to the tip or the second one; `None` where the continuation
    /// gets lost.
    #[must_use]
    pub fn continuation(&self, start: Node, past_fold: bool) -> Option<Continuation> {
        continuations(vec![(self, start)], past_fold, ON_CURVE).pop()?
    }
}

/// The same for several curves at once, whose trajectories share batches; nodes between the ends may `miss` the curve by so much in
/// `ln D`. No answer depends on the other curves.
#[must_use]
pub fn continuations<'a>(
    starts: Vec<(&'a LevelCurve, Node)>,
    past_fold: bool,
    miss: f64,
) -> Vec<Option<Continuation>> {
    let mut ended = vec![None; starts.len()];
    let walk = |(index, (level, start))| Walk::new(index, level, start, miss);
    let mut open: Vec<Walk> = starts.into_iter().enumerate().map(walk).collect();
    while !open.is_empty() {
        // They wait for each other there, so that what finds the edges shares batches, too.
        let mut at_edges: Vec<(Walk, Node)> = Vec::new();
        while !open.is_empty() {
            let shots = shoot(open.iter().map(|walk| &walk.corrector));
            for (mut walk, shot) in std::mem::take(&mut open).into_iter().zip(shots) {
                let next = match walk.corrector.advance(&shot) {
                    Correction::Open => {
                        open.push(walk);
                        continue;
                    }
                    Correction::Done(point, full) => walk.next(point, full),
                    Correction::Lost => None,
                };
                match next {
                    Some(next) if walk.chord(next).may_meet() => at_edges.push((walk, next)),
                    Some(next) => open.extend(walk.go_on(next)),
                    None => open.extend(walk.shorten()),
                }
            }
        }
        let chords: Vec<Chord> = at_edges
            .iter()
            .map(|(walk, next)| walk.chord(*next))
            .collect();
        for ((mut walk, next), meeting) in at_edges.into_iter().zip(meet(&chords)) {
            match meeting {
                Meeting::None => open.extend(walk.go_on(next)),
                Meeting::Unclear => open.extend(walk.shorten()),
                Meeting::Edge(edge, node) => {
                    let is_first_fold = walk.end_at(edge, node);
                    if is_first_fold && past_fold {
                        open.extend(walk.predict());
                    } else {
                        ended[walk.index] = Some(Continuation {
                            nodes: walk.nodes,
                            fold: walk.fold,
                            end: edge,
                        });
                    }
                }
            }
        }
    }
    ended
}

/// A continuation on its way.
struct Walk<'a> {
    /// Which one.
    index: usize,
    level: &'a LevelCurve,
    nodes: Vec<Node>,
    fold: Option<usize>,
    step: f64,
    /// The steps from node to node, up to the last one; none across an edge.
    steps: Vec<f64>,
    /// What a node may miss.
    miss: f64,
    /// The direction at the last node in parts of the scale, and the next node on its way.
    along: DVec2,
    corrector: Corrector<'a>,
}

impl<'a> Walk<'a> {
    fn last(&self) -> &Node {
        &self.nodes[self.nodes.len() - 1]
    }

    /// Begins at `start`.
    fn new(index: usize, level: &'a LevelCurve, start: Node, miss: f64) -> Self {
        let mut walk = Self {
            index,
            level,
            nodes: vec![start],
            fold: None,
            step: FIRST_ARC_STEP,
            steps: Vec::new(),
            miss,
            along: DVec2::ZERO,
            corrector: Corrector::new(level, start.point, miss),
        };
        walk.set_out();
        walk
    }

    /// Sets out for the next node, unless it is lost.
    fn predict(mut self) -> Option<Self> {
        self.set_out();
        (self.nodes.len() < MOST_NODES && self.step > SHORTEST_ARC_STEP).then_some(self)
    }

    /// The same with a shorter step.
    fn shorten(mut self) -> Option<Self> {
        self.step *= 0.5;
        self.predict()
    }

    fn set_out(&mut self) {
        let (point, along) = self.predicted();
        self.along = along;
        self.corrector = Corrector::new(self.level, point, self.miss);
    }

    /// The next node at a point of the curve, where that is the way, and not too far.
    fn next(&self, point: DVec2, full: FullState) -> Option<Node> {
        let next = self.level.next(self.last(), self.along, (point, full))?;
        self.fits(&next).then_some(next)
    }

    /// The predictor of the next node, and the direction at the last one in parts of the scale.
    ///
    /// It goes on as the curve has gone through up to three nodes.
    fn predicted(&self) -> (DVec2, DVec2) {
        let (level, step) = (self.level, self.step);
        let along = level.direction(self.last());
        let mut moved = step * level.velocity(self.last());
        let ways = self.nodes.windows(2).rev().zip(self.steps.iter().rev());
        let mut bends = ways.map_while(|(nodes, length)| {
            let [from, to] = [&nodes[0], &nodes[1]];
            let turned = level.direction(to) - level.direction(from);
            let bend = (level.velocity(to) - level.velocity(from)) / *length;
            (turned.length() < MOST_BEND).then_some((bend, *length))
        });
        if let Some((bend, length)) = bends.next() {
            moved += 0.5 * step * step * bend;
            if let Some((before, length_before)) = bends.next() {
                let change = (bend - before) / (length + length_before);
                moved += step * step * (step / 3.0 + 0.5 * length) * change;
            }
        }
        (self.last().point + moved, along)
    }

    fn chord(&self, next: Node) -> Chord<'a> {
        Chord::new(self.level, *self.last(), next, self.fold.is_none())
    }

    /// Whether the chord to `next` is about as long as the curve.
    fn fits(&self, next: &Node) -> bool {
        let (level, last) = (self.level, self.last());
        let chord = level.place(next) - level.place(last);
        let before = self.nodes.iter().rev().nth(1);
        let turn = before.map_or(0.0, |before| {
            chord.angle_between(level.place(last) - level.place(before))
        });
        chord.length() < 2.0 * NODE_DISTANCE && (turn < SHARPEST_TURN || chord.length() < SHORT)
    }

    fn go_on(mut self, next: Node) -> Option<Self> {
        let length = self.level.length(self.last(), &next);
        self.steps.push(self.step);
        self.step *= (NODE_DISTANCE / length).clamp(0.5, 2.0);
        self.nodes.push(next);
        self.predict()
    }

    /// Ends at an edge; whether that is the first fold.
    fn end_at(&mut self, edge: Edge, node: Node) -> bool {
        // Two nodes next to each other are a poor base for interpolation.
        if let [.., before, last] = &self.nodes[..]
            && self.fold != Some(self.nodes.len() - 1)
            && self.level.length(last, &node) < 0.2 * self.level.length(before, last)
        {
            self.nodes.pop();
        }
        self.nodes.push(node);
        self.steps.clear();
        let is_first_fold = edge == Edge::Fold && self.fold.is_none();
        if is_first_fold {
            self.fold = Some(self.nodes.len() - 1);
        }
        is_first_fold
    }
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
                    // Rounding may lead beyond the end.
                    let push = push.clamp(from.min(to), from.max(to));
                    let (node, root) = level.bracketed_push(part, push).unwrap();
                    assert!((node.push - push).abs() <= ON_CURVE, "{push} {root:?}");
                    // Measured 12, next to a fold.
                    assert!(root.iterations <= 12, "{push} {root:?}");
                }
            }
        }
    }
}
