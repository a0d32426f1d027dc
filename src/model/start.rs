//! The contact, where every trajectory starts.

use super::rod::arclength_at;
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
    /// Arclength of the contact from the base.
    pub arclength: f64,
    /// cos and sin of the intrinsic tangent in the frame of a parabola.
    pub rest: DVec2,
    /// Curvature at rest.
    pub curvature: f64,
    /// Its derivative by the arclength.
    pub curvature_slope: f64,
}

impl Start {
    /// The contact of `rod` at `tau` with `load = f/radius^2`.
    #[must_use]
    #[inline(always)]
    pub fn new(rod: &Rod, tau: f64, load: f64) -> Self {
        let radius = rod.radius(tau);
        let s = arclength(rod, tau);
        let (rest, curvature, curvature_slope) = match rod.spiral {
            Some([k0, k1]) => (DVec2::X, k1.mul_add(s, k0), k1),
            None => parabola(rod, s),
        };
        let stiffness = if rod.profile.is_some() {
            rod.stiffness(s)
        } else {
            radius.powi(4) * rod.modulus(s)
        };
        Self {
            tau,
            radius,
            stiffness,
            force: load * radius * radius,
            tangent: rod.contact_tangent(),
            arclength: s,
            rest,
            curvature,
            curvature_slope,
        }
    }
}

/// cos and sin of the tangent of a parabola at arclength `s`, `kappa_i = 2 A cos^3` and
/// `dkappa_i/ds = -12 A^2 sin cos^5`.
#[inline(always)]
fn parabola(rod: &Rod, s: f64) -> (DVec2, f64, f64) {
    let tangent = Rest::parabola_tangent(rod, s);
    let DVec2 { x: cos, y: sin } = tangent;
    (
        tangent,
        2.0 * rod.bend * cos.powi(3),
        -12.0 * rod.bend * rod.bend * sin * cos.powi(5),
    )
}

/// Arclength at `tau`: `(1 - exp(-beta tau))/beta`, without cancellation.
#[must_use]
pub fn arclength(rod: &Rod, tau: f64) -> f64 {
    arclength_at(rod.taper, tau)
}
