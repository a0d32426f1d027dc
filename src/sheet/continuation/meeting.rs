//! Points at which level curves meet the edges of the sheet, between two of their nodes.

use crate::newton::LaneSharing;
use crate::sheet::continuation::corrector::correct;
use crate::sheet::continuation::level_curve::{CurveNode, LevelCurve, ON_CURVE};
use crate::sheet::edges::edge_newton::{EdgeProblem, edge_newton};
use crate::sheet::row::Edge;
use glam::DVec2;
use std::f64::consts::FRAC_PI_3;
use whiskmap_mechanics::rod::arclength;

/// Largest miss in `ln D` at the tip, where moving the contact would cause a larger error.
const TIP_MISS: f64 = 1e-11;

/// Largest error of a curve's maximum as a cubic predicts it, in parts of the maximum's height above both nodes.
const GRAZE_OFF: f64 = 0.5;

/// Error of the slope of a quantity along a chord, in parts of its bulge and of its change from node to node ([`Chord::may_fall`]). The
/// change counts more on a chord that spans a kink.
const BULGE_OFF: f64 = 0.5;
const CHANGE_OFF: f64 = 0.05;
const KINK_OFF: f64 = 1.0;

/// Slope at the end of a chord, in parts of the rise, that rounding leaves at a fold.
const FLAT_END: f64 = 1e-6;

/// Largest angle, in radians, between the directions of the curve at neighbouring nodes: 60 degrees.
pub const MOST_TURN: f64 = FRAC_PI_3;

/// Length of a chord, as [`LevelCurve::length`] measures it, on which a pair of folds cannot be distinguished from rounding.
const SHORTEST_TURN: f64 = 1e-6;

/// Chord from one node of a level curve to the next.
pub struct Chord<'a> {
    pub level: &'a LevelCurve,
    pub from: CurveNode,
    pub to: CurveNode,
    /// True if both nodes of the chord belong to the stable part of the level curve.
    pub is_stable: bool,
}

/// Edge of the sheet between two nodes of a level curve, if any.
pub enum Meeting {
    /// No edge of the sheet lies between the nodes of the level curve.
    None,
    /// First edge of the sheet between the nodes of the level curve, and the node on it.
    Edge(Edge, CurveNode),
    /// An edge of the sheet lies between the nodes of the level curve, but Newton's method has not found it from there.
    Unclear,
}

impl Chord<'_> {
    /// Returns true if the chord between the two nodes may meet the fold or the tip edge.
    pub fn may_meet(&self) -> bool {
        self.crossed().iter().any(Option::is_some)
    }

    /// Returns the length of the chord, as [`LevelCurve::length`] measures it.
    pub fn length(&self) -> f64 {
        self.level.length(&self.from, &self.to)
    }

    /// Returns true if the curve may meet an edge twice between the nodes: the tip from below, or the fold from one side.
    pub fn hides_edges(&self) -> bool {
        self.may_graze() || !self.turns_over() && self.push_may_turn()
    }

    /// Returns true if `det` has another sign at the last node than on this part of the curve.
    fn turns_over(&self) -> bool {
        (self.to.full.map.det() < 0.0) == self.is_stable
    }

    /// Returns true if the cubic through both nodes may go beyond the tip and come back between them.
    fn may_graze(&self) -> bool {
        let tip = self.level.rod.tau_tip();
        let [from, to] = [self.from.point.x, self.to.point.x];
        if from.max(to) >= tip {
            return false;
        }
        let chord = (self.to.point - self.from.point) / self.level.scale(self.from.point);
        let slope = |node: &CurveNode| self.level.velocity(node).x * chord.length();
        let [rises, falls] = [slope(&self.from), slope(&self.to)];
        if rises <= 0.0 || falls >= 0.0 {
            return false;
        }
        let square = 3.0 * (to - from) - 2.0 * rises - falls;
        let cube = 2.0 * (from - to) + rises + falls;
        let at = rises / ((square * square - 3.0 * cube * rises).max(0.0).sqrt() - square);
        let highest = from + at * (rises + at * (square + at * cube));
        let height = highest - from.max(to);
        highest + GRAZE_OFF * height > tip
    }

    /// Returns true if the push angle may turn back and forth between the nodes, over a pair of folds. Both nodes have the same sign of
    /// `det`, or one of them is a fold.
    fn push_may_turn(&self) -> bool {
        let sense = self.level.sense(self.is_stable);
        let by = |node: &CurveNode| {
            let map = &node.full.map;
            sense * DVec2::new(map.by_tau.y, map.by_load.y)
        };
        self.may_fall(sense * (self.to.signed_push - self.from.signed_push), by)
    }

    /// Returns true if the contact may move toward the base somewhere between the nodes.
    fn contact_may_turn(&self) -> bool {
        self.may_fall(self.to.point.x - self.from.point.x, |_| DVec2::X)
    }

    /// Returns true if a quantity that grows by `rise` from node to node may fall between them. `by` returns its derivatives by `(tau, load)` at
    /// a node. Chords from first touch are left out: that state lies on the shape at rest, and misses the curve by the error of the integration.
    ///
    /// The slope of a cubic along the chord is `from (1 - t) + to t + bulge t (1 - t)`; `t` runs from 0 to 1. The slopes at the nodes and the
    /// rise determine it. The slope of the quantity is lower by at most `off t (1 - t)`. So it is positive between the nodes if
    /// `off - bulge < (sqrt(from) + sqrt(to))^2`.
    fn may_fall(&self, rise: f64, by: impl Fn(&CurveNode) -> DVec2) -> bool {
        let scale = self.level.scale(self.from.point);
        let chord = (self.to.point - self.from.point) / scale;
        let slope = |node: &CurveNode| {
            let velocity = self.level.velocity(node);
            by(node).dot(velocity) * chord.length_squared() / (velocity / scale).dot(chord)
        };
        let [from, to] = [slope(&self.from), slope(&self.to)];
        let bulge = 6.0 * rise - 3.0 * (from + to);
        let change_off = if self.spans_kink() { KINK_OFF } else { CHANGE_OFF };
        let off = BULGE_OFF * bulge.abs() + change_off * (to - from).abs();
        let least = from.max(0.0).sqrt() + to.max(0.0).sqrt();
        let ends_growing = to >= -FLAT_END * rise.abs();
        let is_positive = ends_growing && off - bulge < least * least;
        !is_positive && self.length() > SHORTEST_TURN && !self.from.is_first_touch()
    }

    /// Returns true if the contact moves past a measured radius, where the slope of the radius jumps: there `det` has a kink.
    fn spans_kink(&self) -> bool {
        let rod = &self.level.rod;
        let [from, to] = [&self.from, &self.to].map(|node| rod.piece(arclength(rod, node.point.x)));
        from != to
    }

    /// Returns the tip and the fold, each if the chord has crossed it.
    fn crossed(&self) -> [Option<(&Self, Edge)>; 2] {
        let is_beyond = self.to.point.x > self.level.rod.tau_tip();
        [is_beyond.then_some((self, Edge::Tip)), self.turns_over().then_some((self, Edge::Fold))]
    }

    /// Returns the Newton problem for the point of `edge` on the chord.
    fn problem(&self, edge: Edge) -> EdgeProblem<'_> {
        let Self { level, from, to, .. } = self;
        let tip = level.rod.tau_tip();
        let height = |node: &CurveNode| match edge {
            Edge::Fold => node.full.map.det(),
            Edge::Tip => node.point.x - tip,
        };
        let part = height(from) / (height(from) - height(to));
        let start = from.point.lerp(to.point, part.clamp(0.0, 1.0));
        EdgeProblem {
            rod: &level.rod,
            edge,
            pole_distance: level.row.pole_distance,
            start: match edge {
                Edge::Fold => start,
                Edge::Tip => DVec2::new(tip, start.y),
            },
            second: None,
        }
    }

    /// Returns the part of the chord up to `node`.
    const fn up_to(&self, node: CurveNode) -> Self {
        Self { to: node, ..*self }
    }

    /// Returns true if `node` lies near the chord, and the curve leads through it in the direction of the chord. Next to a saddle of `D`,
    /// Newton's method can find a node of another level curve, which leads back.
    fn has_near(&self, node: &CurveNode) -> bool {
        let length = |from, to| self.level.length(from, to);
        let reach = 2.0 * self.length() + f64::EPSILON;
        length(&self.from, node).max(length(&self.to, node)) <= reach
            && self.up_to(*node).turn() < MOST_TURN
    }

    /// Returns the angle between the directions of the curve at both nodes, in radians; 0 for a chord that begins at first touch.
    pub fn turn(&self) -> f64 {
        let [from, to] = [&self.from, &self.to].map(|node| self.level.direction(node));
        if self.from.is_first_touch() { 0.0 } else { from.angle_to(to).abs() }
    }
}

/// Returns the first edge that each of the `chords` meets: `[chord]`.
pub fn meet(chords: &[Chord]) -> Vec<Meeting> {
    let crossed: Vec<_> = chords.iter().map(Chord::crossed).collect();
    let looked_for: Vec<(&Chord, Edge)> = crossed.iter().flatten().flatten().copied().collect();
    let mut found = edges(&looked_for).into_iter();
    crossed
        .iter()
        .map(|edges| {
            let [tip, fold] = edges.map(|edge| edge.and_then(|edge| Some((edge, found.next()?))));
            let tip = match tip {
                Some((_, None)) => return Meeting::Unclear,
                Some(((chord, _), Some(tip))) if chord.up_to(tip).contact_may_turn() => {
                    return Meeting::Unclear;
                }
                Some((_, Some(tip))) => Meeting::Edge(Edge::Tip, tip),
                None => Meeting::None,
            };
            match fold {
                Some((_, None)) => Meeting::Unclear,
                Some(((chord, _), Some(fold))) if chord.up_to(fold).push_may_turn() => {
                    Meeting::Unclear
                }
                Some(((chord, _), Some(fold))) if fold.point.x <= chord.level.rod.tau_tip() => {
                    Meeting::Edge(Edge::Fold, fold)
                }
                _ => tip,
            }
        })
        .collect()
}

/// Returns the point of each edge on its chord, or `None` if Newton's method has found none, or one that is not near the chord.
fn edges(chords: &[(&Chord, Edge)]) -> Vec<Option<CurveNode>> {
    let Some((first, _)) = chords.first() else {
        return Vec::new();
    };
    let problems: Vec<EdgeProblem> =
        chords.iter().map(|(chord, edge)| chord.problem(*edge)).collect();
    let iterates = edge_newton(first.level.method, LaneSharing::EqualSteps, &problems);
    // At a fold, rounding can leave Newton's method slightly off the curve; at the tip its result is on the curve.
    let points = chords.iter().zip(&iterates);
    let points = points.map(|((chord, edge), iterate)| {
        let tolerance = match edge {
            Edge::Fold => ON_CURVE,
            Edge::Tip => TIP_MISS,
        };
        (chord.level, iterate.point, tolerance)
    });
    let corrected = correct(&points.collect::<Vec<_>>());
    chords
        .iter()
        .zip(iterates.iter().zip(corrected))
        .map(|((chord, _), (iterate, corrected))| {
            let (point, full) = corrected?;
            let Chord { level, from, .. } = chord;
            let node = level.node(point, &full, from.signed_push, from.angle);
            (iterate.has_converged && chord.has_near(&node)).then_some(node)
        })
        .collect()
}
