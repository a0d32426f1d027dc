//! A whisker and its pole in dimensionless form.

use crate::numerics::{Dual, Real};
use crate::rod::{CurvaturePolynomial, RadiusProfile, radius_and_arclength};
use glam::DVec2;
use serde_core::{Serialize, Serializer};
use std::fmt;
use std::sync::Arc;

/// The side of the whisker that the pole is on. The default is the side of the push angle 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Side {
    /// Concave backward: the pole is on the convex side, the force bends the whisker further.
    #[default]
    Cb,
    /// Concave forward: the pole is on the concave side.
    Cf,
}

impl Side {
    /// Both whisker sides, in the order of growing push angle.
    pub const BOTH: [Self; 2] = [Self::Cf, Self::Cb];

    /// Returns the whisker side of a push angle. First touch, the angle 0, belongs to CB.
    #[must_use]
    pub fn of_push(push: f64) -> Self {
        if push < 0.0 { Self::Cf } else { Self::Cb }
    }

    /// Returns the sign of push angles, loads and the pole's offset on a whisker side: +1 for CB, -1 for CF.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Cb => 1.0,
            Self::Cf => -1.0,
        }
    }
}

/// `CB` or `CF`.
impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Cb => "CB",
            Self::Cf => "CF",
        })
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

/// One whisker with a pole on one side, in dimensionless form. Lengths are in whisker lengths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rod {
    /// Taper of the rod, `beta = 1 - r_tip/r_base` times the arc stretch, in `[0, 1]`: 0 is a cylinder, 1 a perfect cone.
    pub taper: f64,
    /// Coefficient `A* = A L_w` of the parabola at rest, dimensionless, at least 0.
    pub bend: f64,
    /// Slope `t0 = -2 A x0` of the parabola at rest at the base, dimensionless.
    pub slope: f64,
    /// Pole radius in whisker lengths, with the sign of the side: the pole's centre is at `-pole e2` from the contact.
    pub pole: f64,
    /// Gradient `g` of Young's modulus `E_base (1 + g s)`, per whisker length, larger than -1.
    pub gradient: f64,
    /// Coulomb's friction coefficient of the contact, friction over normal force, with the sign of the side.
    pub friction: f64,
    /// Compliance of the mount that holds the base: radians by which it turns for a moment of `E I_base/L_w`, at least 0. A clamp does
    /// not turn: 0.
    pub mount: f64,
    /// Coefficients `[k0, k1]` of an Euler spiral at rest with curvature `k0 + k1 s`, in radians per whisker length. The spiral replaces the
    /// parabola; `s` is in whisker lengths. `None` without a spiral.
    pub spiral: Option<[f64; 2]>,
    /// Curvature at rest as a polynomial of the arclength, instead of parabola and spiral; `None` without one.
    pub polynomial: Option<Arc<CurvaturePolynomial>>,
    /// Measured radii instead of a linear taper. `taper` is then only the scale of the coordinates. `None` for a cone or cylinder.
    pub profile: Option<Arc<RadiusProfile>>,
}

/// Radius over the base radius at which a perfect cone is cut. Contacts beyond it are indistinguishable from the tip.
pub const PERFECT_CONE_CUT: f64 = 1e-9;

/// Returns the arclength of the tip for this taper, in whisker lengths: 1, or slightly less for a perfect cone, which is cut.
pub(crate) fn pointed(taper: f64) -> f64 {
    ((1.0 - PERFECT_CONE_CUT) / taper).min(1.0)
}

/// Returns `tau` at arclength `s`, in whisker lengths, on a rod of this taper: see [`Rod::tau`].
pub(crate) fn tau_at(taper: f64, s: f64) -> f64 {
    if taper == 0.0 { s } else { -libm::log1p(-taper * s) / taper }
}

/// Returns the derivative of [`tau_at`] by the variable of the dual numbers.
pub(crate) fn tau_derivative(taper: Dual<f64>, s: Dual<f64>) -> f64 {
    let tau = tau_at(taper.value, s.value);
    let [radius, at_tau] = radius_and_arclength(taper, Dual::of(tau));
    (s.derivative - at_tau.derivative) / radius.value
}

/// Returns the arclength of a rod at `tau`, `(1 - exp(-beta tau))/beta`, in whisker lengths, without cancellation.
#[must_use]
pub fn arclength(rod: &Rod, tau: f64) -> f64 {
    arclength_at(rod.taper, tau)
}

/// Returns the arclength at `tau` on a rod of this taper, in whisker lengths: see [`arclength`].
pub(crate) fn arclength_at(taper: f64, tau: f64) -> f64 {
    if taper == 0.0 { tau } else { -libm::expm1(-taper * tau) / taper }
}

impl Rod {
    /// Returns the bending stiffness at arclength `s`, in whisker lengths, over the bending stiffness at the base.
    #[must_use]
    pub fn stiffness(&self, s: f64) -> f64 {
        let radius = match &self.profile {
            Some(profile) => profile.radius(s),
            None => 1.0 - self.taper * s,
        };
        radius.powi(4) * self.modulus(s)
    }

    /// Returns true if the radius falls linearly or is constant, and the modulus is constant.
    #[must_use]
    #[inline]
    pub fn is_uniform_cone(&self) -> bool {
        self.profile.is_none() && self.gradient == 0.0
    }

    /// Returns the index of the piece of the profile on which the arclength `s`, in whisker lengths, lies; 0 without a profile.
    #[must_use]
    #[inline]
    pub fn piece(&self, s: f64) -> usize {
        self.profile.as_ref().map_or(0, |profile| profile.piece(s))
    }

    /// Returns the largest curvature of the whisker at rest, in radians per whisker length.
    #[must_use]
    pub fn sharpest_bend(&self) -> f64 {
        if let Some(polynomial) = &self.polynomial {
            return polynomial.sharpest();
        }
        match self.spiral {
            Some([k0, k1]) => k0.abs().max((k0 + k1).abs()),
            None => 2.0 * self.bend,
        }
    }

    /// Returns Young's modulus at arclength `s`, in whisker lengths, over the modulus at the base.
    #[must_use]
    pub fn modulus(&self, s: f64) -> f64 {
        1.0 + self.gradient * s
    }

    /// Returns this rod with another `friction` coefficient.
    #[must_use]
    pub fn with_friction(&self, friction: f64) -> Self {
        Self { friction, ..self.clone() }
    }

    /// Returns the whisker's unit tangent at the contact, in axes whose second one is along the force.
    ///
    /// Friction tilts the force from the normal by the angle whose tangent is the friction coefficient. In axes turned with the
    /// force, the equations are those without friction: the lever `X - friction Y` is the new `X` but for a factor, which the
    /// force absorbs. Friction therefore adds no work to the integration.
    #[must_use]
    pub fn contact_tangent(&self) -> DVec2 {
        DVec2::new(1.0, self.friction).normalize()
    }

    /// Returns the vector from the contact to the pole's centre, in whisker lengths and in the axes of [`Rod::contact_tangent`].
    #[must_use]
    pub fn to_pole(&self) -> DVec2 {
        -self.pole * self.contact_tangent().perp()
    }

    /// Returns `tau` at arclength `s` (whisker lengths): `-ln(1 - beta s)/beta`, the dimensionless coordinate in which a tapered rod is
    /// smooth.
    #[must_use]
    pub fn tau(&self, s: f64) -> f64 {
        tau_at(self.taper, s)
    }

    /// Returns `tau` at the tip, dimensionless. A perfect cone ends at [`PERFECT_CONE_CUT`].
    #[must_use]
    pub fn tau_tip(&self) -> f64 {
        self.tau(pointed(self.taper))
    }

    /// Returns the derivative of [`Rod::tau_tip`] by a variable that changes the taper by `by_taper`, dimensionless per unit of the variable.
    #[must_use]
    pub fn tau_tip_derivative(&self, by_taper: f64) -> f64 {
        let s = pointed(self.taper);
        // The cut of a perfect cone moves with the taper.
        let by_s = if s < 1.0 { -s / self.taper * by_taper } else { 0.0 };
        let dual = |value, derivative| Dual { value, derivative };
        tau_derivative(dual(self.taper, by_taper), dual(s, by_s))
    }

    /// Returns the derivative of [`arclength`] by a variable, in whisker lengths per unit of the variable. The variable changes `tau` by `by_tau`
    /// and the taper by `by_taper`.
    #[must_use]
    pub fn arclength_derivative(&self, tau: f64, by_tau: f64, by_taper: f64) -> f64 {
        let dual = |value, derivative| Dual { value, derivative };
        let [_, s] = radius_and_arclength(dual(self.taper, by_taper), dual(tau, by_tau));
        s.derivative
    }

    /// Returns the softness at `tau`, dimensionless: the whisker's rotation there under a small load, over the rotation of the clamped cone
    /// with the same base and tip. It is 1 without a profile and a mount that turns. Folds of all whiskers lie at similar `|load| s^2 softness`.
    #[must_use]
    pub fn softness(&self, tau: f64) -> f64 {
        if self.profile.is_none() && self.mount == 0.0 {
            return 1.0;
        }
        let s = arclength(self, tau);
        let scale = self.radius(tau);
        let cone = s * s * (1.0 + 2.0 * scale) / (6.0 * scale * scale);
        let bending = self.profile.as_ref().map_or(cone, |profile| profile.compliance(s));
        (bending + self.mount * s) / cone
    }

    /// Returns the scale of the coordinates at `tau`: the radius of the cone over the base radius.
    #[must_use]
    pub fn radius(&self, tau: f64) -> f64 {
        libm::exp(-self.taper * tau)
    }
}
