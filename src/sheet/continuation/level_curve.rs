//! The level curve of `D`: every state of the whisker in front of one pole.
//!
//! Neither the load nor the push angle can be stepped: the load peaks, the push angle turns at the fold. In the plane of contact and
//! load the curve is the level set of one smooth function, whose gradient every trajectory brings along. So a step of pseudo-arclength
//! continuation has its predictor along the tangent, bent as the curve was before, its corrector along the gradient. Lengths are measured
//! where people look at the curve: in push angle, contact angle (both in radians) and arclength of the contact (in whisker lengths).

use crate::numerics::nearest_turn;
use crate::rod::{Rod, Side, arclength};
use crate::sheet::row::Row;
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

    /// The same in twice the steps.
    #[must_use]
    pub(super) fn finer(&self) -> Self {
        Self {
            method: self.method.doubled(),
            ..self.clone()
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
