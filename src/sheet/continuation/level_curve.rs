//! The level curve of `D`: every state of the whisker in front of one pole.
//!
//! Neither the load nor the push angle can be stepped: the load peaks, the push angle turns at the fold. In the plane of contact and
//! load the curve is the level set of one smooth function, whose gradient every trajectory brings along. So a step of pseudo-arclength
//! continuation has its predictor along the tangent, bent as the curve was before, its corrector along the gradient. Lengths are measured
//! where people look at the curve: in push angle, contact angle (both in radians) and arclength of the contact (in whisker lengths).

use crate::numerics::{Root, illinois, nearest_turn};
use crate::rod::{Rod, Side, arclength};
use crate::sheet::continuation::corrector::{Corrector, correct, shoot};
use crate::sheet::row::{Crossing, Row};
use crate::shooting::FullState;
use crate::shooting::batch::Method;
use glam::{DVec2, DVec3};

/// `ln D` at which a point lies on the curve, to rounding.
pub const ON_CURVE: f64 = 1e-14;

/// A state on the level curve.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// `(tau, load)`.
    pub point: DVec2,
    /// Everything else.
    pub full: FullState,
    /// Push angle since first touch, signed, in radians, continuous along the curve.
    pub push: f64,
    /// Tangent angle at the contact from the base's tangent, in radians, continuous along the curve.
    pub angle: f64,
}

/// The level curve of one row.
#[derive(Clone, Debug)]
pub struct LevelCurve {
    /// How trajectories are integrated.
    pub method: Method,
    /// The whisker and its pole.
    pub rod: Rod,
    /// The side.
    pub side: Side,
    /// Where the pole stands.
    pub row: Row,
    /// Whether it is followed in the direction of growing push angles.
    forward: bool,
}

impl LevelCurve {
    /// The curve of `row`, to be followed in the direction of growing push angles.
    #[must_use]
    pub fn new(method: Method, rod: &Rod, side: Side, row: &Row) -> Self {
        Self {
            method,
            rod: rod.clone(),
            side,
            row: *row,
            forward: true,
        }
    }

    /// The same, followed the other way.
    #[must_use]
    pub fn backward(&self) -> Self {
        Self {
            forward: !self.forward,
            ..self.clone()
        }
    }

    /// First touch, from where pushes are counted.
    #[must_use]
    pub fn touch(&self) -> Option<Node> {
        let at_touch = DVec2::new(self.rod.tau(self.row.contact).min(self.rod.tau_tip()), 0.0);
        let full = shoot(&[Corrector::new(self, at_touch, ON_CURVE)])
            .first()?
            .full;
        Some(Node {
            push: 0.0,
            ..self.node(at_touch, &full, 0.0, 0.0)
        })
    }

    /// The state at a crossing.
    #[must_use]
    pub fn at_crossing(&self, crossing: &Crossing) -> Option<Node> {
        let at = DVec2::new(crossing.tau, crossing.load);
        let (point, full) = self.correct(&[at], ON_CURVE).pop()??;
        Some(self.node(point, &full, self.side.sign() * crossing.push, 0.0))
    }

    /// The state at the signed `push` (radians) between two of the `nodes`, along which the push angle grows or falls throughout;
    /// `None` outside, or where the curve is lost.
    #[must_use]
    pub fn state_at_push(&self, nodes: &[Node], push: f64) -> Option<Node> {
        Some(self.bracketed_push(nodes, push)?.0)
    }

    /// The same, and how it was found: without slopes, because that of the push angle is zero at the fold.
    pub(super) fn bracketed_push(&self, nodes: &[Node], push: f64) -> Option<(Node, Root)> {
        let miss = |node: &Node| node.push - push;
        let is_between = |pair: &&[Node]| miss(&pair[0]) * miss(&pair[1]) <= 0.0;
        let [from, to] = nodes.windows(2).find(is_between)? else {
            return None;
        };
        let is_from_closer = miss(from).abs() < miss(to).abs();
        let mut best = if is_from_closer { *from } else { *to };
        let ends = [[0.0, miss(from)], [1.0, miss(to)]];
        // The corrector leaves as much.
        let tolerance = ON_CURVE * push.abs().max(1.0);
        let root = illinois(ends, tolerance, |part| {
            let start = from.point.lerp(to.point, part);
            let (point, full) = self.correct(&[start], ON_CURVE).pop()??;
            let node = self.node(point, &full, from.push, from.angle);
            if miss(&node).abs() < miss(&best).abs() {
                best = node;
            }
            Some(miss(&node))
        })?;
        Some((best, root))
    }

    /// The state `full` at `point`, its angles continued from `push` and `angle`.
    #[must_use]
    pub fn node(&self, point: DVec2, full: &FullState, push: f64, angle: f64) -> Node {
        let phi = full.map.pole.to_angle();
        let to_pole = self.rod.to_pole() - full.position;
        let tilt = self.rod.contact_tangent().to_angle();
        Node {
            point,
            full: *full,
            push: nearest_turn(phi - self.row.touch, push),
            angle: nearest_turn(phi - to_pole.to_angle() + tilt, angle),
        }
    }

    /// The direction of the curve at a node, in parts of the scale, of length 1.
    pub(super) fn direction(&self, node: &Node) -> DVec2 {
        let gradient = self.scale(node.point) * gradient(node);
        // Along the curve the push angle changes by minus `det` times its direction (by_load, -by_tau).
        let heading = if self.forward { 1.0 } else { -1.0 };
        -heading * self.side.sign() * DVec2::new(gradient.y, -gradient.x).normalize()
    }

    /// How fast contact and load change there, a length of 1 in parts of the scale at a time.
    pub(super) fn velocity(&self, node: &Node) -> DVec2 {
        self.scale(node.point) * self.direction(node)
    }

    /// The next node, where the corrector has found the curve again; `None` if that is not the way `along`.
    pub(super) fn next(
        &self,
        from: &Node,
        along: DVec2,
        (point, full): (DVec2, FullState),
    ) -> Option<Node> {
        let turned = (point - from.point) / self.scale(from.point);
        let node = self.node(point, &full, from.push, from.angle);
        (turned.dot(along) > 0.5 * turned.length()).then_some(node)
    }

    /// Brings every point onto the curve, to `tolerance` in `ln D` or to rounding; `None` where that fails.
    #[must_use]
    pub fn correct(&self, points: &[DVec2], tolerance: f64) -> Vec<Option<(DVec2, FullState)>> {
        let corrector = |point: &DVec2| Corrector::new(self, *point, tolerance);
        correct(points.iter().map(corrector).collect())
    }

    /// How much `tau` and load can change before the state changes by about as much as it is.
    pub(super) fn scale(&self, point: DVec2) -> DVec2 {
        let s = arclength(&self.rod, point.x);
        DVec2::new(s, point.y.abs() + 1.0 / (s * s))
    }

    /// Where people see a node.
    #[must_use]
    pub fn place(&self, node: &Node) -> DVec3 {
        let s = arclength(&self.rod, node.point.x);
        DVec3::new(node.push, node.angle, s)
    }

    /// How far apart people see two nodes.
    #[must_use]
    pub fn length(&self, from: &Node, to: &Node) -> f64 {
        self.place(from).distance(self.place(to))
    }
}

/// `d ln D/d(tau, load)`.
fn gradient(node: &Node) -> DVec2 {
    DVec2::new(node.full.map.by_tau.x, node.full.map.by_load.x)
}
