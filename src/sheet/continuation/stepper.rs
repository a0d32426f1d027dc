//! The stepper of a continuation: predictor and corrector, from node to node.

use crate::newton::{NewtonProblem, NewtonStep};
use crate::sheet::continuation::Path;
use crate::sheet::continuation::corrector::{CORRECTOR_TRAJECTORIES, Corrector};
use crate::sheet::continuation::level_curve::{CurveNode, LevelCurve, ON_CURVE, Stretch};
use crate::sheet::continuation::meeting::{Chord, MOST_TURN};
use crate::sheet::row::Edge;
use glam::DVec2;
use std::f64::consts::TAU;
use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::{FirstVariation, FullState};

/// Approximate distance between neighbouring nodes, as [`LevelCurve::length`] measures it.
const NODE_DISTANCE: f64 = 0.05;

/// Largest angle, in radians, between neighbouring chords that are not short: chords and curve then have about the same length.
const SHARPEST_TURN: f64 = 0.1;

/// Length below which chords may form any angle: after a longer chord, no step is short enough for a small angle.
const SHORT_CHORD: f64 = 0.01 * NODE_DISTANCE;

/// Length of a doubtful chord below which the errors of inaccurate nodes may decide. Beyond a saddle of `D`, level curves that differ by such an
/// error lie far apart.
const RESTART_CHORD: f64 = 0.5 * NODE_DISTANCE;

/// Distance of a node from its prediction, in parts of the step, beyond which the step may have led past a saddle of `D`, to another
/// branch of the level curve. It is then about the step times the sine of the angle between the branches, by which the direction turns.
const MOST_CORRECTED: f64 = 0.1;

/// Largest angle, in radians, between the directions of the curve at neighbouring nodes, if the second one is not where it was predicted. The
/// error of the integration changes in steps, and can move a node without turning its direction.
const LEAST_TURN: f64 = 0.1;

/// First step of the continuation, relative to contact and load.
const FIRST_ARC_STEP: f64 = 0.05;

/// Step length below which a continuation has failed.
const SHORTEST_ARC_STEP: f64 = 1e-9;

/// Largest push angle of a node of a continuation, in radians: nine turns. Push angles of maps are at most one turn. The largest
/// detachment that another program has confirmed is at 2924 degrees. Beyond a soft waist, a whisker can coil up for thirty turns, in
/// thousands of nodes.
pub const MOST_PUSH: f64 = 9.0 * TAU;

/// Largest push angle, in radians, toward the other side at which unstable states are followed: one turn. They lead to further pieces of a row, of which
/// pushes toward its own side matter; a whole branch is followed for nine turns. In a soft follicle, a coil would unwind for many turns, in as many nodes as it has wound up.
const MOST_BACK: f64 = TAU;

/// Maximum number of nodes; no known branch has more than 300.
const MOST_NODES: usize = 10_000;

/// Stepper of a continuation in progress. As a [`NewtonProblem`] it takes one step after another, until a chord may meet an edge.
pub struct Stepper<'a> {
    /// Index of the stepper's level curve among those followed in the same batch.
    pub index: usize,
    level: &'a LevelCurve,
    /// Nodes of the continuation, from the start to the last one found, `[node]`.
    pub nodes: Vec<CurveNode>,
    /// Index of the continuation's node at the first fold; `None` before it is found.
    pub fold: Option<usize>,
    /// Node after the last one, if the chord to it may meet an edge; otherwise `None`.
    pub candidate: Option<CurveNode>,
    step: f64,
    /// Step lengths from node to node, up to the last node, since the last edge.
    steps: Vec<f64>,
    /// Largest miss in `ln D` at a node.
    miss: f64,
    /// Push angles between which nodes are followed, positive toward the row's side, in radians.
    pushes: [f64; 2],
    /// Unit direction at the last node, in parts of the scale.
    along: DVec2,
    /// Predicted `(tau, load)` of the next node, at which the corrector starts, dimensionless.
    pub predicted: DVec2,
    corrector: Corrector<'a>,
    /// Number of trajectories of the corrector for this node.
    trajectories: u32,
}

impl<'a> Stepper<'a> {
    /// Creates the stepper of a `stretch` of curve `index` of the batch, whose first node is `start`. Nodes may miss the curve by `miss` in
    /// `ln D`.
    pub fn new(
        index: usize,
        level: &'a LevelCurve,
        start: CurveNode,
        stretch: Stretch,
        miss: f64,
    ) -> Self {
        let mut stepper = Self {
            index,
            level,
            nodes: vec![start],
            fold: (stretch == Stretch::Unstable).then_some(0),
            candidate: None,
            step: FIRST_ARC_STEP,
            steps: Vec::new(),
            miss,
            pushes: match stretch {
                Stretch::Unstable => [-MOST_BACK, MOST_PUSH],
                Stretch::Stable | Stretch::PastFold => [-MOST_PUSH, MOST_PUSH],
            },
            along: DVec2::ZERO,
            predicted: start.point,
            corrector: Corrector::new(level, miss),
            trajectories: 0,
        };
        stepper.predict();
        stepper
    }

    /// Predicts the next node of the continuation. Returns false where it ends without an edge.
    pub fn advance(&mut self) -> bool {
        self.predict();
        let is_within = self.nodes.len() < MOST_NODES && !self.is_beyond_turns();
        is_within && self.step > SHORTEST_ARC_STEP
    }

    /// Predicts the next node of the continuation with half the step. Returns false if the step is too short.
    pub fn shorten(&mut self) -> bool {
        self.step *= 0.5;
        self.advance()
    }

    /// Returns true if the last node lies beyond the push angles that are followed.
    pub fn is_beyond_turns(&self) -> bool {
        let [least, most] = self.pushes;
        let push = self.nodes.last().map(|last| self.level.side.sign() * last.signed_push);
        push.is_some_and(|push| push < least || push > most)
    }

    /// Returns the path up to the last node, which lies at the edge `end`, and leaves the stepper without nodes.
    pub fn path(&mut self, end: Option<Edge>) -> Path {
        Path {
            level: self.level.clone(),
            nodes: std::mem::take(&mut self.nodes),
            fold: self.fold,
            end,
        }
    }

    fn last(&self) -> &CurveNode {
        &self.nodes[self.nodes.len() - 1]
    }

    /// Returns the next node at a point of the curve, if the point lies ahead and not too far away.
    fn next(&self, point: DVec2, full: FullState) -> Option<CurveNode> {
        let (level, last) = (self.level, self.last());
        let scale = level.scale(last.point);
        let moved = (point - last.point) / scale;
        let corrected = (point - self.predicted) / scale;
        let is_ahead = moved.dot(self.along) > 0.5 * moved.length();
        let next = level.node(point, &full, last.signed_push, last.angle);
        let chord = self.chord(next);
        let is_predicted = corrected.length() <= MOST_CORRECTED * moved.length();
        let is_on_branch = chord.turn() < if is_predicted { MOST_TURN } else { LEAST_TURN };
        (is_ahead && is_on_branch && self.fits(&next)).then_some(next)
    }

    /// Predicts the next node by the polynomial through up to three nodes and their tangents.
    fn predict(&mut self) {
        let (level, step) = (self.level, self.step);
        let mut moved = step * level.velocity(self.last());
        let chords = self.nodes.windows(2).rev().zip(self.steps.iter().rev());
        let mut bends = chords.map(|(nodes, length)| {
            let change = level.velocity(&nodes[1]) - level.velocity(&nodes[0]);
            (change / *length, *length)
        });
        if let Some((bend, length)) = bends.next() {
            moved += 0.5 * step * step * bend;
            if let Some((before, length_before)) = bends.next() {
                let change = (bend - before) / (length + length_before);
                moved += step * step * (step / 3.0 + 0.5 * length) * change;
            }
        }
        self.predicted = self.last().point + moved;
        self.along = level.direction(self.last());
        self.corrector = Corrector::new(level, self.miss);
        self.trajectories = 0;
    }

    /// Returns the [`Chord`] from the last node of the continuation to `next`: its level curve, both nodes, and whether they are stable.
    pub fn chord(&self, next: CurveNode) -> Chord<'a> {
        Chord { level: self.level, from: *self.last(), to: next, is_stable: self.fold.is_none() }
    }

    /// Returns true if the chord to `next` is about as long as the curve.
    fn fits(&self, next: &CurveNode) -> bool {
        let (level, last) = (self.level, self.last());
        let chord = level.place(next) - level.place(last);
        let before = self.nodes.iter().rev().nth(1);
        let turn = before
            .map_or(0.0, |before| chord.angle_between(level.place(last) - level.place(before)));
        chord.length() < 2.0 * NODE_DISTANCE
            && (turn < SHARPEST_TURN || chord.length() < SHORT_CHORD)
    }

    /// Adds the node `next` to the continuation and predicts the one after it. Returns false where the continuation ends without an edge.
    pub fn add(&mut self, next: CurveNode) -> bool {
        let length = self.level.length(self.last(), &next);
        self.steps.push(self.step);
        self.step *= (NODE_DISTANCE / length).clamp(0.5, 2.0);
        self.nodes.push(next);
        self.advance()
    }

    /// Returns true if the errors of inaccurate nodes may decide where the curve leads, or which edges it meets: the `chord` to the next node
    /// is short because the step had to be shortened, or it still may hide edges.
    fn needs_exact_nodes(&self, chord: &Chord, hides_edges: bool) -> bool {
        let before = self.steps.last();
        let was_shortened = before.is_some_and(|before| self.step <= 0.5 * before);
        let is_doubtful = hides_edges || was_shortened && self.fold.is_none();
        self.miss > ON_CURVE && is_doubtful && chord.length() < RESTART_CHORD
    }

    /// Adds the node of an edge to the continuation. Returns true if it is the first fold.
    pub fn end_at(&mut self, edge: Edge, node: CurveNode) -> bool {
        self.nodes.push(node);
        self.steps.clear();
        let is_first_fold = edge == Edge::Fold && self.fold.is_none();
        if is_first_fold {
            self.fold = Some(self.nodes.len() - 1);
        }
        is_first_fold
    }
}

impl<'a> NewtonProblem<'a> for Stepper<'a> {
    type Output = FirstVariation;

    fn rod(&self) -> &'a Rod {
        &self.level.rod
    }

    fn step(&mut self, at: DVec2, here: &FirstVariation) -> NewtonStep {
        self.trajectories += 1;
        let next = match self.corrector.step(at, here) {
            NewtonStep::Accept => self.next(at, here.full),
            NewtonStep::Extrapolate(step) => self.next(at + step, here.extrapolated(step)),
            NewtonStep::Shoot(next)
                if next.x > 0.0 && self.trajectories < CORRECTOR_TRAJECTORIES =>
            {
                return NewtonStep::Shoot(next);
            }
            NewtonStep::Shoot(_) | NewtonStep::Fail => None,
        };
        let mut may_go_on = match next {
            Some(next) => {
                let chord = self.chord(next);
                let hides_edges = chord.hides_edges();
                if self.needs_exact_nodes(&chord, hides_edges) {
                    // The continuation begins again with nodes on the curve.
                    false
                } else if hides_edges {
                    self.shorten()
                } else if chord.may_meet() {
                    self.candidate = Some(next);
                    return NewtonStep::Accept;
                } else {
                    self.add(next)
                }
            }
            None => self.shorten(),
        };
        while may_go_on && self.predicted.x <= 0.0 {
            may_go_on = self.shorten();
        }
        match may_go_on {
            true => NewtonStep::Shoot(self.predicted),
            false => NewtonStep::Fail,
        }
    }
}
