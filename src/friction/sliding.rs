//! Sliding direction of the contact along the whisker.

use crate::rod::{Rod, arclength};
use crate::sheet::CurveNode;
use crate::shooting::FirstVariation;
use crate::shooting::batch::{Batch, Method};
use glam::DVec2;
use serde::Serialize;

/// Sliding direction of the contact along the whisker as the push grows; on unstable states, in the direction of continuation.
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
        // The sign of the side is that of the friction coefficient and of the change of the pole's direction.
        let rate = rate(variation, rod, tau) * rod.friction;
        (rod.friction != 0.0).then_some(if rate < 0.0 { Self::Base } else { Self::Tip })
    }

    /// Returns whether the contact slides to the tip or the base at `points` `(tau, load)` of `rod`, `[point]`; `None` without friction.
    /// Integrates one trajectory for each point.
    #[must_use]
    pub fn at(method: Method, rod: &Rod, points: &[DVec2]) -> Vec<Option<Self>> {
        let shot = Batch::new(method).shoot_at(rod, points.iter().copied());
        let states = shot.iter().zip(points);
        let states = states.map(|(variation, point)| Self::of(variation, rod, point.x));
        states.collect()
    }
}

/// Returns the sliding rate of the contact: derivative of the slid distance, in whisker lengths, by the direction `phi` of the pole,
/// times `det J`. The rate is finite at the fold.
///
/// The contact moves along the whisker by `ds` and along the pole's rim by `-pole dpsi`. Here, `psi` is the angle of the whisker's
/// tangent at the contact in the frame of the pole. The difference is sliding; the rest is rolling. Along `D = const`, with `J` the
/// Jacobian of `(ln D, phi)`, `det J d(tau, load)/dphi = (-dlnD/dload, dlnD/dtau)`.
pub(super) fn rate(variation: &FirstVariation, rod: &Rod, tau: f64) -> f64 {
    let map = &variation.full.map;
    let along = DVec2::new(-map.by_load.x, map.by_tau.x);
    // The base rotates by -dphi in the frame of the pole. From the base, the tangent at the contact rotates by minus the base angle.
    let base_angle = DVec2::new(variation.by_tau.angle, variation.by_load.angle);
    let turned = -map.det() - base_angle.dot(along);
    rod.radius(tau) * along.x + rod.pole * turned
}

/// Returns the slid distance of the contact at `node`: its arclength minus the distance rolled around the pole, in whisker lengths.
pub(super) fn slid(rod: &Rod, node: &CurveNode) -> f64 {
    rod.pole
        .mul_add(node.angle - node.push, arclength(rod, node.point.x))
}
