//! Continuation along `D = const`: the states in front of one pole, from first touch through the fold to the end of the branch.

pub mod level_curve;
mod meeting;
pub mod pieces;
pub mod walked;

use crate::sheet::continuation::level_curve::{LevelCurve, Node, ON_CURVE, correct};
use crate::sheet::continuation::meeting::{Chord, Meeting, meet};
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
    let walk = |(index, (level, start)): (usize, (_, Node))| Walk {
        index,
        level,
        nodes: vec![start],
        fold: None,
        step: FIRST_ARC_STEP,
        last_step: None,
    };
    let mut walks: Vec<Walk> = starts.into_iter().enumerate().map(walk).collect();
    while !walks.is_empty() {
        let nexts = next_nodes(&walks, miss);
        let chord = |(walk, next): (&Walk<'a>, &Option<Node>)| Some(walk.chord((*next)?));
        let chords: Vec<Option<Chord>> = walks.iter().zip(&nexts).map(chord).collect();
        let mut meetings = meet(&chords).into_iter();
        let mut nexts = nexts.into_iter();
        walks.retain_mut(|walk| {
            let next = nexts.next().flatten();
            match (next, meetings.next()) {
                (Some(next), Some(Meeting::None)) => walk.go_on(next),
                (Some(_), Some(Meeting::Edge(edge, node))) => {
                    let is_first_fold = walk.end_at(edge, node);
                    if !(is_first_fold && past_fold) {
                        ended[walk.index] = Some(Continuation {
                            nodes: std::mem::take(&mut walk.nodes),
                            fold: walk.fold,
                            end: edge,
                        });
                        return false;
                    }
                }
                _ => walk.step *= 0.5,
            }
            walk.nodes.len() < MOST_NODES && walk.step > SHORTEST_ARC_STEP
        });
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
    /// The step to the last node from the one before it; `None` where that is not the way on.
    last_step: Option<f64>,
}

/// The next node of each of the `walks`, where it was found and fits.
fn next_nodes(walks: &[Walk], miss: f64) -> Vec<Option<Node>> {
    let predictions: Vec<(DVec2, DVec2)> = walks.iter().map(Walk::predicted).collect();
    let points: Vec<(&LevelCurve, DVec2)> = walks
        .iter()
        .zip(&predictions)
        .map(|(walk, (point, _))| (walk.level, *point))
        .collect();
    correct(&points, |_| miss)
        .into_iter()
        .zip(walks.iter().zip(&predictions))
        .map(|(corrected, (walk, (_, along)))| {
            let next = walk.level.next(walk.last(), *along, corrected?)?;
            walk.fits(&next).then_some(next)
        })
        .collect()
}

impl<'a> Walk<'a> {
    fn last(&self) -> &Node {
        &self.nodes[self.nodes.len() - 1]
    }

    /// The predictor of the next node, and the direction at the last one in parts of the scale.
    ///
    /// It bends as the curve has bent since the node before.
    fn predicted(&self) -> (DVec2, DVec2) {
        let (level, last) = (self.level, self.last());
        let scale = level.scale(last.point);
        let along = level.direction(last);
        let before = self.nodes.iter().rev().nth(1).zip(self.last_step);
        let bend = before.map_or(DVec2::ZERO, |(before, last_step)| {
            let turned = along - level.direction(before);
            let bends = turned.length() < MOST_BEND;
            f64::from(bends) * turned / last_step
        });
        let moved = self.step * along + 0.5 * self.step * self.step * bend;
        (last.point + scale * moved, along)
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

    fn go_on(&mut self, next: Node) {
        let length = self.level.length(self.last(), &next);
        self.last_step = Some(self.step);
        self.step *= (NODE_DISTANCE / length).clamp(0.5, 2.0);
        self.nodes.push(next);
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
        self.last_step = None;
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
