//! Sliding direction of the contact along the whisker.

use crate::sheet::CurveNode;
use glam::DVec2;
use serde::Serialize;
use whiskmap_mechanics::rod::{Rod, arclength};
use whiskmap_mechanics::shooting::FirstVariation;

/// Sliding direction of the contact along the whisker as the push grows. Unstable states have the friction of a contact that slides toward the
/// tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Sliding {
    /// The contact slides toward the tip, with the limiting friction.
    Tip,
    /// The contact slides toward the base, with the opposite limiting friction.
    Base,
    /// The contact sticks where its last sliding ended, with less than the limiting friction.
    Sticks,
}

impl Sliding {
    /// Returns the sliding direction of the contact at `tau` in the state of `rod`, if it slides; `None` without friction.
    #[must_use]
    pub fn of(variation: &FirstVariation, rod: &Rod, tau: f64) -> Option<Self> {
        // The side, the friction coefficient and the change of the pole's direction have the same sign.
        let rate = ContactRate::new(variation, rod, tau).slid * rod.friction;
        (rod.friction != 0.0).then_some(if rate < 0.0 { Self::Base } else { Self::Tip })
    }
}

/// Derivatives of a contact along `D = const`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactRate {
    /// Derivative of contact coordinate and load, `(tau, load)`.
    pub point: DVec2,
    /// Derivative of the tangent angle at the contact, from the base's tangent.
    pub angle: f64,
    /// Derivative of the slid distance, in whisker lengths.
    pub slid: f64,
}

impl ContactRate {
    /// Returns the derivatives of the contact at `tau` in the state of `rod`, by the direction `phi` of the pole, times `det J`. They are
    /// finite at the fold.
    ///
    /// The contact moves along the whisker by `ds` and along the pole's rim by `-pole dpsi`. Here, `psi` is the angle of the whisker's
    /// tangent at the contact in the frame of the pole. The difference is sliding; the rest is rolling. With `J` the Jacobian of
    /// `(ln D, phi)`, `det J d(tau, load)/dphi = (-dlnD/dload, dlnD/dtau)`.
    pub fn new(variation: &FirstVariation, rod: &Rod, tau: f64) -> Self {
        let map = &variation.full.map;
        let point = DVec2::new(-map.by_load.x, map.by_tau.x);
        // The base rotates by -dphi in the frame of the pole. From the base, the tangent at the contact rotates by minus the base angle.
        let base_angle = DVec2::new(variation.by_tau.angle, variation.by_load.angle);
        let angle = -base_angle.dot(point);
        let slid = rod.radius(tau) * point.x + rod.pole * (angle - map.det());
        Self { point, angle, slid }
    }

    /// Returns the derivatives times `factor`.
    pub fn times(self, factor: f64) -> Self {
        Self { point: self.point * factor, angle: self.angle * factor, slid: self.slid * factor }
    }
}

/// Returns the slid distance of the contact at `node`: its arclength minus the distance rolled around the pole, in whisker lengths.
pub(super) fn slid(rod: &Rod, node: &CurveNode) -> f64 {
    rod.pole.mul_add(node.angle - node.signed_push, arclength(rod, node.point.x))
}
