//! The contact of one rod, for what is not computed in batches; `contact` is the same for lanes.

use crate::rod::rod::arclength_at;
use crate::rod::{Rest, Rod};
use glam::DVec2;

/// Where a trajectory starts.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// `tau` of the contact: the length of the trajectory.
    pub tau: f64,
    /// Radius at the contact over the base radius.
    pub radius: f64,
    /// The whole force `F L_w^2/(E I_base)`, signed; without friction it is the normal force.
    pub force: f64,
    /// The whisker's tangent there, see [`Rod::contact_tangent`].
    pub tangent: DVec2,
    /// Arclength of the contact from the base.
    pub arclength: f64,
    /// cos and sin of the intrinsic tangent in the frame of a parabola.
    pub rest: DVec2,
}

impl Start {
    /// The contact of `rod` at `tau` with `load = f/radius^2`.
    #[must_use]
    pub fn new(rod: &Rod, tau: f64, load: f64) -> Self {
        let radius = rod.radius(tau);
        let s = arclength(rod, tau);
        Self {
            tau,
            radius,
            force: load * radius * radius,
            tangent: rod.contact_tangent(),
            arclength: s,
            rest: Rest::parabola_tangent(rod, s),
        }
    }
}

/// Arclength at `tau`: `(1 - exp(-beta tau))/beta`, without cancellation.
#[must_use]
pub fn arclength(rod: &Rod, tau: f64) -> f64 {
    arclength_at(rod.taper, tau)
}
