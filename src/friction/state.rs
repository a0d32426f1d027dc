//! State of a contact with friction.

use super::sliding::Sliding;
use crate::sheet::{CurveNode, LevelCurve};
use glam::DVec2;
use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::FirstVariation;

/// Contact, load and force ratio of a state with friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionPoint {
    /// Contact coordinate and signed load of the state, `(tau, load)`, dimensionless.
    pub point: DVec2,
    /// Force ratio of the state: tangential over normal force, with the sign of the side; positive on CB if it pulls the whisker toward
    /// its tip.
    pub ratio: f64,
    /// Tangent angle at the contact, in radians from the base's tangent, continuous along the push.
    pub angle: f64,
}

impl FrictionPoint {
    /// Returns the point of a node of `level`, which has the force ratio of its rod.
    pub(super) fn of(level: &LevelCurve, node: &CurveNode) -> Self {
        Self { point: node.point, ratio: level.rod.friction, angle: node.angle }
    }

    /// Returns the point between `self` (`part` 0) and `to` (`part` 1).
    pub(super) fn lerp(&self, to: &Self, part: f64) -> Self {
        let between = |from: f64, to: f64| (to - from).mul_add(part, from);
        Self {
            point: self.point.lerp(to.point, part),
            ratio: between(self.ratio, to.ratio),
            angle: between(self.angle, to.angle),
        }
    }
}

/// State of the whisker at a contact with friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionState {
    /// Contact, load and force ratio of the state.
    pub at: FrictionPoint,
    /// Sliding direction of the contact.
    pub sliding: Sliding,
    /// State with its first derivatives by contact and load, in the axes of the force ratio.
    pub variation: FirstVariation,
    /// Slid distance of the contact, in whisker lengths.
    pub slid: f64,
    /// Distance of the pole from its target, in whisker lengths.
    pub residual: f64,
    /// Number of Newton steps that led to the state.
    pub steps: u32,
}

impl FrictionState {
    /// Returns the state as a node of a level curve at `signed_push`, in radians.
    #[must_use]
    pub fn node(&self, signed_push: f64) -> CurveNode {
        CurveNode {
            point: self.at.point,
            full: self.variation.full,
            signed_push,
            angle: self.at.angle,
        }
    }

    /// Returns `rod` with the force ratio of this state as its friction.
    #[must_use]
    pub fn rod(&self, rod: &Rod) -> Rod {
        rod.with_friction(self.at.ratio)
    }
}
