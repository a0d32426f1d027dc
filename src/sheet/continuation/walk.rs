//! A continuation on its way from node to node.

use crate::sheet::continuation::corrector::Corrector;
use crate::sheet::continuation::level_curve::{LevelCurve, Node};
use crate::sheet::continuation::meeting::Chord;
use crate::sheet::row::Edge;
use crate::shooting::FullState;
use glam::DVec2;
use std::f64::consts::TAU;

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

/// A predictor bends where the direction has changed by less than this since the node before.
const MOST_BEND: f64 = 0.25;

/// The largest push angle of a node, in radians: nine turns. Push angles of maps are at most one turn, and the largest detachment
/// that another program has confirmed is at 2924 degrees. Beyond a soft waist, a whisker can coil up for thirty turns, in
/// thousands of nodes.
pub const MOST_PUSH: f64 = 9.0 * TAU;

/// Most nodes: no branch known has more than 300.
const MOST_NODES: usize = 10_000;

/// A continuation on its way.
pub struct Walk<'a> {
    /// Which one.
    pub index: usize,
    level: &'a LevelCurve,
    /// From the start on.
    pub nodes: Vec<Node>,
    /// Index of the first fold.
    pub fold: Option<usize>,
    step: f64,
    /// The steps from node to node, up to the last one; none across an edge.
    steps: Vec<f64>,
    /// What a node may miss.
    miss: f64,
    /// The direction at the last node, in parts of the scale.
    along: DVec2,
    /// The next node on its way to the curve.
    pub corrector: Corrector<'a>,
}

impl<'a> Walk<'a> {
    /// Begins at `start`; nodes may `miss` the curve by so much in `ln D`.
    pub fn new(index: usize, level: &'a LevelCurve, start: Node, miss: f64) -> Self {
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
        walk.predict();
        walk
    }

    /// Sets out for the next node; `None` where it is lost.
    pub fn set_out(mut self) -> Option<Self> {
        self.predict();
        let is_within = self.nodes.len() < MOST_NODES && self.last().push.abs() <= MOST_PUSH;
        (is_within && self.step > SHORTEST_ARC_STEP).then_some(self)
    }

    /// The same with a shorter step.
    pub fn shorten(mut self) -> Option<Self> {
        self.step *= 0.5;
        self.set_out()
    }

    fn last(&self) -> &Node {
        &self.nodes[self.nodes.len() - 1]
    }

    /// The next node at a point of the curve, where that is the way, and not too far.
    pub fn next(&self, point: DVec2, full: FullState) -> Option<Node> {
        let next = self.level.next(self.last(), self.along, (point, full))?;
        self.fits(&next).then_some(next)
    }

    /// Predicts the next node: the curve goes on as it has gone through up to three nodes.
    fn predict(&mut self) {
        let (level, step) = (self.level, self.step);
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
        let point = self.last().point + moved;
        self.along = level.direction(self.last());
        self.corrector = Corrector::new(level, point, self.miss);
    }

    /// From the last node to `next`.
    pub fn chord(&self, next: Node) -> Chord<'a> {
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

    /// Goes on to `next`, and sets out for the one after it.
    pub fn go_on(mut self, next: Node) -> Option<Self> {
        let length = self.level.length(self.last(), &next);
        self.steps.push(self.step);
        self.step *= (NODE_DISTANCE / length).clamp(0.5, 2.0);
        self.nodes.push(next);
        self.set_out()
    }

    /// Ends at an edge; whether that is the first fold.
    pub fn end_at(&mut self, edge: Edge, node: Node) -> bool {
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
