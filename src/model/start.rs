//! The contact, where every trajectory starts.

use super::{Rest, Rod};
use glam::DVec2;

/// What the integration needs to know of the contact.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// `tau` of the contact: the length of the trajectory.
    pub tau: f64,
    /// Radius at the contact over the base radius.
    pub radius: f64,
    /// Stiffness at the contact over that at the base.
    pub stiffness: f64,
    /// The whole force `F L_w^2/(E I_base)`, signed; without friction it is the normal force.
    pub force: f64,
    /// The whisker's tangent there, see [`Rod::contact_tangent`].
    pub tangent: DVec2,
    /// cos of the intrinsic tangent in the frame of the parabola.
    pub cos: f64,
    /// sin of the same.
    pub sin: f64,
}

impl Start {
    /// The contact of `rod` at `tau` with `load = f/radius^2`.
    #[must_use]
    pub fn new(rod: &Rod, tau: f64, load: f64) -> Self {
        let radius = rod.radius(tau);
        let slope = if rod.bend == 0.0 {
            rod.slope
        } else {
            Rest::new(rod).slope_at(arclength(rod, tau))
        };
        let cos = 1.0 / slope.hypot(1.0);
        let modulus = if rod.gradient == 0.0 {
            1.0
        } else {
            rod.modulus(arclength(rod, tau))
        };
        Self {
            tau,
            radius,
            stiffness: radius.powi(4) * modulus,
            force: load * radius * radius,
            tangent: rod.contact_tangent(),
            cos,
            sin: slope * cos,
        }
    }

    /// Curvature at rest, `kappa_i = 2 A cos^3`.
    #[must_use]
    pub fn curvature(&self, rod: &Rod) -> f64 {
        2.0 * rod.bend * self.cos.powi(3)
    }

    /// `dkappa_i/ds = -12 A^2 sin cos^5`.
    #[must_use]
    pub fn curvature_slope(&self, rod: &Rod) -> f64 {
        -12.0 * rod.bend * rod.bend * self.sin * self.cos.powi(5)
    }
}

/// Arclength at `tau`: `(1 - exp(-beta tau))/beta`, without cancellation.
#[must_use]
pub fn arclength(rod: &Rod, tau: f64) -> f64 {
    if rod.taper == 0.0 {
        tau
    } else {
        -(-rod.taper * tau).exp_m1() / rod.taper
    }
}
