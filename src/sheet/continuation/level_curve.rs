//! The level curve of `D`: all states of the whisker in front of one pole.
//!
//! Neither the load nor the push angle can be the continuation parameter: the load has a maximum, and the push angle turns at the fold.
//! In the plane of contact and load, the curve is the level set of one smooth function, and each trajectory provides its gradient. So a
//! step of pseudo-arclength continuation predicts along the tangent, with the curvature of the previous steps, and corrects along the
//! gradient. Lengths are measured in push angle, contact angle (both in radians) and arclength of the contact (in whisker lengths).

use crate::sheet::row::Row;
use glam::{DVec2, DVec3};
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::rod::{Rod, Side, arclength};
use whiskmap_mechanics::shooting::FullState;
use whiskmap_mechanics::shooting::batch::Method;

/// Largest miss in `ln D` of a point on a level curve, due to rounding.
pub const ON_CURVE: f64 = 1e-14;

/// Stretch of a level curve that a continuation follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stretch {
    /// Stable states, up to the fold or the tip.
    Stable,
    /// Stable states, and unstable states past the fold, up to the tip or the second fold.
    PastFold,
    /// Unstable states from a fold, up to the next fold or the tip.
    Unstable,
}

/// Node of a level curve: a state, with its push angle and contact angle.
#[derive(Clone, Copy, Debug)]
pub struct CurveNode {
    /// Contact coordinate and signed load of the node, `(tau, load)`, dimensionless.
    pub point: DVec2,
    /// State of the node: pole with first derivatives, pose of the base, force and energy.
    pub full: FullState,
    /// Push angle of the node with its sign, since first touch, in radians; continuous along the curve.
    pub signed_push: f64,
    /// Tangent angle at the contact of the node, in radians from the base's tangent, continuous along the curve.
    pub angle: f64,
}

impl CurveNode {
    /// Returns true for a first touch: the whisker is at rest.
    pub(super) fn is_first_touch(&self) -> bool {
        self.point.y == 0.0
    }
}

/// Level curve of one row, with the direction in which it is followed.
#[derive(Clone, Debug)]
pub struct LevelCurve {
    /// Integration method of the level curve's trajectories.
    pub method: Method,
    /// Whisker and pole of the level curve.
    pub rod: Rod,
    /// Whisker side of the level curve.
    pub side: Side,
    /// Row of the level curve, with the pole's distance.
    pub row: Row,
    /// True if the curve is followed in the direction of growing push angles.
    forward: bool,
}

impl LevelCurve {
    /// Creates the level curve of `row`, followed in the direction of growing push angles.
    #[must_use]
    pub fn new(method: Method, rod: &Rod, side: Side, row: &Row) -> Self {
        Self { method, rod: rod.clone(), side, row: *row, forward: true }
    }

    /// Returns this level curve with twice the integration steps.
    #[must_use]
    pub(super) fn finer(&self) -> Self {
        Self { method: self.method.doubled(), ..self.clone() }
    }

    /// Returns this level curve, followed in the opposite direction.
    #[must_use]
    pub fn backward(&self) -> Self {
        Self { forward: !self.forward, ..self.clone() }
    }

    /// Returns the node of a level curve with the state `full` at `point`, `(tau, load)`. Its angles are continued from `signed_push` and
    /// `angle`, in radians.
    #[must_use]
    pub fn node(&self, point: DVec2, full: &FullState, signed_push: f64, angle: f64) -> CurveNode {
        let phi = full.map.pole.to_angle();
        let to_pole = self.rod.to_pole() - full.position;
        let tilt = self.rod.contact_tangent().to_angle();
        CurveNode {
            point,
            full: *full,
            signed_push: nearest_turn(phi - self.row.touch, signed_push),
            angle: nearest_turn(phi - to_pole.to_angle() + tilt, angle),
        }
    }

    /// Returns the unit direction of the level curve at a node, in parts of [`LevelCurve::scale`].
    pub(super) fn direction(&self, node: &CurveNode) -> DVec2 {
        let gradient = self.scale(node.point) * gradient(node);
        // Along the curve, the push angle changes by minus `det` times its direction (by_load, -by_tau).
        -self.sense(true) * DVec2::new(gradient.y, -gradient.x).normalize()
    }

    /// Returns the sign of the change of the signed push angle along the level curve, on its stable or its unstable part.
    pub(super) fn sense(&self, is_stable: bool) -> f64 {
        let is_growing = self.forward == is_stable;
        self.side.sign() * if is_growing { 1.0 } else { -1.0 }
    }

    /// Returns the change of `(tau, load)` at a node for each unit of scaled length along the level curve.
    pub(super) fn velocity(&self, node: &CurveNode) -> DVec2 {
        self.scale(node.point) * self.direction(node)
    }

    /// Returns the scale of `(tau, load)` on a level curve: the changes after which the state changes by about its own size.
    pub(super) fn scale(&self, point: DVec2) -> DVec2 {
        let s = arclength(&self.rod, point.x);
        DVec2::new(s, point.y.abs() + 1.0 / (s * s))
    }

    /// Returns the coordinates of a node in which lengths are measured: push angle and contact angle in radians, and arclength in whisker
    /// lengths.
    #[must_use]
    pub fn place(&self, node: &CurveNode) -> DVec3 {
        let s = arclength(&self.rod, node.point.x);
        DVec3::new(node.signed_push, node.angle, s)
    }

    /// Returns the Euclidean distance of two nodes in the coordinates of [`LevelCurve::place`]: radians and whisker lengths count alike.
    #[must_use]
    pub fn length(&self, from: &CurveNode, to: &CurveNode) -> f64 {
        self.place(from).distance(self.place(to))
    }
}

/// Returns `d ln D/d(tau, load)` at a node.
fn gradient(node: &CurveNode) -> DVec2 {
    DVec2::new(node.full.map.by_tau.x, node.full.map.by_load.x)
}
