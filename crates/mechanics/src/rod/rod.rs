//! A whisker and its pole without dimensions.

use crate::rod::RadiusProfile;
use glam::DVec2;
use serde_core::{Serialize, Serializer};
use std::sync::Arc;

/// The side of the whisker that the pole is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Concave backward: the pole is on the convex side, the force bends the whisker further.
    Cb,
    /// Concave forward: the pole is on the concave side.
    Cf,
}

impl Side {
    /// Both sides, in the order of growing push angle.
    pub const BOTH: [Self; 2] = [Self::Cf, Self::Cb];

    /// The side that a push angle belongs to; first touch itself belongs to CB.
    #[must_use]
    pub fn of_push(push: f64) -> Self {
        if push < 0.0 { Self::Cf } else { Self::Cb }
    }

    /// The sign of push angles, loads and the pole's offset: + CB, - CF.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Cb => 1.0,
            Self::Cf => -1.0,
        }
    }
}

/// `cb` or `cf`. Written out, because a derive macro would delay the compilation of this crate.
impl Serialize for Side {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (index, name) = match self {
            Self::Cb => (0, "cb"),
            Self::Cf => (1, "cf"),
        };
        serializer.serialize_unit_variant("Side", index, name)
    }
}

/// One whisker on one side of one pole; lengths in whisker lengths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rod {
    /// `beta = 1 - r_tip/r_base`, times the arc stretch; in `[0, 1]`.
    pub taper: f64,
    /// Parabola coefficient `A* = A L_w`, at least 0.
    pub bend: f64,
    /// Slope `t0 = -2 A x0` of the parabola at the base.
    pub slope: f64,
    /// Pole radius with the sign of the side: the pole's centre is at `-pole e2` from the contact.
    pub pole: f64,
    /// `g` of the modulus `E_base (1 + g s)`; more than -1.
    pub gradient: f64,
    /// Coulomb's coefficient with the sign of the side: friction over normal force.
    pub friction: f64,
    /// `[k0, k1]` of an Euler spiral, whose curvature at rest is `k0 + k1 s`, in place of the parabola.
    pub spiral: Option<[f64; 2]>,
    /// Radii in place of those that fall linearly; `taper` is then only the scale of the coordinates.
    pub profile: Option<Arc<RadiusProfile>>,
}

/// A perfect cone is cut where its radius is this part of the base radius: below, the contact is closer to
/// the tip than any length that `f64` millimetres of a whisker can tell apart from it in practice.
pub const PERFECT_CONE_CUT: f64 = 1e-9;

/// Arclength at the tip, in whisker lengths, of a whisker of this taper: 1, but for a perfect cone.
pub(crate) fn pointed(taper: f64) -> f64 {
    ((1.0 - PERFECT_CONE_CUT) / taper).min(1.0)
}

/// See [`Rod::tau`].
pub(crate) fn tau_at(taper: f64, s: f64) -> f64 {
    if taper == 0.0 {
        s
    } else {
        -libm::log1p(-taper * s) / taper
    }
}

/// Arclength at `tau`: `(1 - exp(-beta tau))/beta`, without cancellation.
#[must_use]
pub fn arclength(rod: &Rod, tau: f64) -> f64 {
    arclength_at(rod.taper, tau)
}

/// The same on any rod of this taper.
pub(crate) fn arclength_at(taper: f64, tau: f64) -> f64 {
    if taper == 0.0 {
        tau
    } else {
        -libm::expm1(-taper * tau) / taper
    }
}

impl Rod {
    /// Bending stiffness at arclength `s` over that at the base.
    #[must_use]
    pub fn stiffness(&self, s: f64) -> f64 {
        let radius = match &self.profile {
            Some(profile) => profile.radius(s),
            None => 1.0 - self.taper * s,
        };
        radius.powi(4) * self.modulus(s)
    }

    /// Whether the radius falls linearly, or not at all, and the modulus is the same everywhere.
    #[must_use]
    #[inline]
    pub fn is_uniform_cone(&self) -> bool {
        self.profile.is_none() && self.gradient == 0.0
    }

    /// Index of the piece of its profile on which the arclength `s` lies; 0 without one.
    #[must_use]
    #[inline]
    pub fn piece(&self, s: f64) -> usize {
        self.profile.as_ref().map_or(0, |profile| profile.piece(s))
    }

    /// The sharpest bend of the whisker at rest, in radians per whisker length.
    #[must_use]
    pub fn sharpest_bend(&self) -> f64 {
        match self.spiral {
            Some([k0, k1]) => k0.abs().max((k0 + k1).abs()),
            None => 2.0 * self.bend,
        }
    }

    /// Modulus at arclength `s` over that at the base.
    #[must_use]
    pub fn modulus(&self, s: f64) -> f64 {
        1.0 + self.gradient * s
    }

    /// The whisker's unit tangent at the contact, in axes whose second one is along the force.
    ///
    /// Friction tilts the force from the normal by the angle whose tangent is its coefficient. In axes turned with the
    /// force the equations are those without friction: the lever `X - friction Y` is the new `X`, but for a factor
    /// that the force takes up. So friction costs nothing along the trajectory.
    #[must_use]
    pub fn contact_tangent(&self) -> DVec2 {
        DVec2::new(1.0, self.friction).normalize()
    }

    /// From the contact to the pole's centre, in the same axes.
    #[must_use]
    pub fn to_pole(&self) -> DVec2 {
        -self.pole * self.contact_tangent().perp()
    }

    /// `tau` at arclength `s`: `-ln(1 - beta s)/beta`, the variable in which a tapered rod is smooth.
    #[must_use]
    pub fn tau(&self, s: f64) -> f64 {
        tau_at(self.taper, s)
    }

    /// `tau` at the tip; a perfect cone ends at [`PERFECT_CONE_CUT`].
    #[must_use]
    pub fn tau_tip(&self) -> f64 {
        self.tau(pointed(self.taper))
    }

    /// How far a small load at `tau` turns the whisker there, over what it does on the cone with the same base and tip: 1
    /// without a profile. Folds of all whiskers lie at similar `|load| s^2 softness`.
    #[must_use]
    pub fn softness(&self, tau: f64) -> f64 {
        self.profile.as_ref().map_or(1.0, |profile| {
            let s = arclength(self, tau);
            let scale = self.radius(tau);
            let cone = s * s * (1.0 + 2.0 * scale) / (6.0 * scale * scale);
            profile.compliance(s) / cone
        })
    }

    /// The scale of the coordinates at `tau`: without a profile the radius over the base radius.
    #[must_use]
    pub fn radius(&self, tau: f64) -> f64 {
        libm::exp(-self.taper * tau)
    }
}
