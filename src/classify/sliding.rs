//! Which way the contact slides along the whisker. Friction is computed as of a contact that slides toward the tip; where
//! it slides toward the base, friction points the other way, and where it sticks, friction is less: force and moment are not those of
//! the state.

use crate::rod::{Rod, arclength};
use crate::sheet::LevelCurve;
use crate::shooting::FirstVariation;
use crate::shooting::batch::{Batch, InitialCondition};
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
    /// Not at all: between the two it sticks, and friction is less than it can be.
    Sticks,
}

impl Sliding {
    /// Of the state of `rod` with its contact at `tau`, if the contact slides there; `None` without friction.
    #[must_use]
    pub fn of(variation: &FirstVariation, rod: &Rod, tau: f64) -> Option<Self> {
        // The coefficient has the sign of the side, and so has the growing direction of the pole.
        let slid = slid(variation, rod, tau) * rod.friction;
        (rod.friction != 0.0).then_some(if slid < 0.0 { Self::Base } else { Self::Tip })
    }
}

/// How far the contact slides where the pole's direction `phi` changes by `det J`, which holds at the fold, too.
///
/// The contact moves along the whisker by `ds`, and along the pole's rim by `-pole dpsi`, where `psi` is the whisker's
/// tangent at the contact, seen by the pole. It slides by the difference, and rolls otherwise. Along `D = const`,
/// with `J` the Jacobian of `(ln D, phi)`, `det J d(tau, load)/dphi = (-dlnD/dload, dlnD/dtau)`.
fn slid(variation: &FirstVariation, rod: &Rod, tau: f64) -> f64 {
    let map = &variation.full.map;
    let along = DVec2::new(-map.by_load.x, map.by_tau.x);
    // The base turns by -dphi in front of the pole, and the contact's tangent by minus the base's angle from the base.
    let base_angle = DVec2::new(variation.by_tau.angle, variation.by_load.angle);
    let turned = -map.det() - base_angle.dot(along);
    rod.radius(tau) * along.x + rod.pole * turned
}

/// A state of a row, as far as sliding goes.
#[derive(Clone, Copy, Debug)]
pub struct SlidingState {
    /// Push angle since first touch, a magnitude in radians.
    pub push: f64,
    /// Arclength of the contact, in whisker lengths.
    arclength: f64,
    /// `psi`, the tangent at the contact, seen by the pole: up to whole turns.
    pub turned: f64,
    /// How the place of the contact changes with the push; infinite at the fold.
    pub by_push: f64,
    /// Which way that is, also where states are unstable.
    pub toward: Option<Sliding>,
}

impl SlidingState {
    /// Those of `level` at some points `(tau, load)`, each with its signed push angle; one trajectory each.
    #[must_use]
    pub fn at(level: &LevelCurve, points: &[(DVec2, f64)]) -> Vec<Self> {
        let rod = &level.rod;
        let conditions = points.iter().map(|(point, _)| InitialCondition {
            rod,
            tau: point.x,
            load: point.y,
        });
        let conditions: Vec<InitialCondition> = conditions.collect();
        let shot = Batch::new(level.method).shoot::<FirstVariation>(&conditions);
        let states = shot.iter().zip(points);
        let state = |(variation, (point, push)): (&FirstVariation, &(DVec2, f64))| {
            let node = level.node(*point, &variation.full, *push, 0.0);
            let by_push = slid(variation, rod, point.x) / variation.full.map.det();
            Self {
                push: push.abs(),
                arclength: arclength(rod, point.x),
                turned: node.angle - push,
                by_push: level.side.sign() * by_push,
                toward: Sliding::of(variation, rod, point.x),
            }
        };
        states.map(state).collect()
    }

    /// The place of the contact, in whisker lengths: arclength less what it has rolled around a `pole`, from `psi` near to `turned`.
    #[must_use]
    pub fn place(&self, pole: f64, turned: f64) -> f64 {
        let turned = crate::numerics::nearest_turn(self.turned, turned);
        pole.mul_add(turned, self.arclength)
    }
}
