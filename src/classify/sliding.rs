//! Which way the contact slides along the whisker. Friction is computed as of a contact that slides toward the tip; where
//! it slides toward the base, friction points the other way, and where it sticks, friction is less: force and moment are not those of
//! the state.

use crate::rod::{Rod, arclength};
use crate::sheet::CurveNode;
use crate::shooting::FirstVariation;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use glam::DVec2;
use serde::Serialize;

/// Which way the contact slides along the whisker as the push grows; along unstable states, as their branch goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Sliding {
    /// Toward the tip, as friction is computed for.
    Tip,
    /// Toward the base: friction points the other way.
    Base,
    /// Not at all: where the last of the two has left it, it sticks, and friction is less than it can be.
    Sticks,
}

impl Sliding {
    /// Returns the sliding direction of a state of `rod` with its contact at `tau`; `None` without friction.
    #[must_use]
    pub fn of(variation: &FirstVariation, rod: &Rod, tau: f64) -> Option<Self> {
        // The coefficient has the sign of the side, and so has the growing direction of the pole.
        let rate = rate(variation, rod, tau) * rod.friction;
        (rod.friction != 0.0).then_some(if rate < 0.0 { Self::Base } else { Self::Tip })
    }

    /// Returns the sliding direction at each point `(tau, load)` of `rod`, with one trajectory each.
    #[must_use]
    pub fn at(method: Method, rod: &Rod, points: &[DVec2]) -> Vec<Option<Self>> {
        if rod.friction == 0.0 {
            return vec![None; points.len()];
        }
        let conditions = points.iter().map(|point| InitialCondition {
            rod,
            tau: point.x,
            load: point.y,
        });
        let conditions: Vec<InitialCondition> = conditions.collect();
        let shot = Batch::new(method).shoot::<FirstVariation>(&conditions);
        let states = shot.iter().zip(points);
        let states = states.map(|(variation, point)| Self::of(variation, rod, point.x));
        states.collect()
    }
}

/// How far the contact slides where the pole's direction `phi` changes by `det J`, which holds at the fold, too.
///
/// The contact moves along the whisker by `ds`, and along the pole's rim by `-pole dpsi`, where `psi` is the whisker's
/// tangent at the contact, seen by the pole. It slides by the difference, and rolls otherwise. Along `D = const`,
/// with `J` the Jacobian of `(ln D, phi)`, `det J d(tau, load)/dphi = (-dlnD/dload, dlnD/dtau)`.
pub(super) fn rate(variation: &FirstVariation, rod: &Rod, tau: f64) -> f64 {
    let map = &variation.full.map;
    let along = DVec2::new(-map.by_load.x, map.by_tau.x);
    // The base turns by -dphi in front of the pole, and the contact's tangent by minus the base's angle from the base.
    let base_angle = DVec2::new(variation.by_tau.angle, variation.by_load.angle);
    let turned = -map.det() - base_angle.dot(along);
    rod.radius(tau) * along.x + rod.pole * turned
}

/// How far along the whisker it has slid: the arclength of the contact less what it has rolled, in whisker lengths.
pub(super) fn slid(rod: &Rod, node: &CurveNode) -> f64 {
    rod.pole
        .mul_add(node.angle - node.push, arclength(rod, node.point.x))
}
