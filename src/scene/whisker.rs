//! A whisker at rest and its pole.

use std::sync::Arc;

use whiskmap_mechanics::rod::{CurvaturePolynomial, RadiusProfile, Rod, Side, Units};

/// A whisker at rest: length, radii, moduli and curvature.
#[derive(Clone, Debug, PartialEq)]
pub struct Whisker {
    /// Arclength of the whisker from base to tip, in millimetres.
    pub length_mm: f64,
    /// Radius of the whisker at the base, in micrometres.
    pub base_radius_um: f64,
    /// Radius of the whisker at the tip, in micrometres; 0 is a perfect cone.
    pub tip_radius_um: f64,
    /// Young's modulus at the base, in GPa; it scales forces, moments and energies, and no angle unless the follicle turns.
    pub youngs_modulus_gpa: f64,
    /// Shape of the whisker at rest as a parabola; `None` for a straight whisker.
    pub curvature: Option<Curvature>,
    /// Shape of the whisker at rest as an Euler spiral, instead of the parabola; `None` without one.
    pub euler_spiral: Option<EulerSpiral>,
    /// Curvature at rest over the length, of a curve through traced points, instead of parabola and spiral; `None` without them.
    pub traced: Option<CurvaturePolynomial>,
    /// Measured radii instead of those that fall linearly: `[row][arclength, radius]`, over the whisker's length and base radius. Rows go
    /// from `[0, 1]` to `[1, tip radius]`. `None` without a profile.
    pub profile: Option<Vec<[f64; 2]>>,
    /// Factor by which the measured radii of the profile have been multiplied, in base and tip radius; 1 without a profile.
    pub profile_scale: f64,
    /// Young's modulus at the arclength `length_mm` over that at the base, dimensionless; it is linear in the arclength.
    pub modulus_tip_to_base: f64,
    /// Real arclength over the arclength in the plane of contact, dimensionless: more than 1 if the whisker droops out of the plane.
    /// Radius and modulus are read at the real arclength.
    pub arc_stretch: f64,
    /// Stiffness of the follicle that holds the base, in nN m/rad: the base turns in it by the moment over the stiffness, and a push turns
    /// the follicle. `None` for a clamped base.
    pub follicle_stiffness_nnm_per_rad: Option<f64>,
    /// Largest bending strain at the surface that the whisker bears elastically, dimensionless; `None` if it is not known. It marks states
    /// and changes none.
    pub yield_strain: Option<f64>,
}

impl Whisker {
    /// Creates a straight whisker in a clamp, whose radius falls linearly from base to tip: from its length in millimetres, its radii `[base, tip]`
    /// in micrometres, and its Young's modulus in GPa. Other effects are fields.
    ///
    /// ```
    /// use whiskmap::scene::{Curvature, Whisker};
    ///
    /// let parabola_per_mm = 0.02;
    /// let whisker = Whisker {
    ///     curvature: Some(Curvature { parabola_per_mm, vertex_mm: 0.0 }),
    ///     ..Whisker::cone(20.0, [30.0, 1.5], 3.0)
    /// };
    /// assert_eq!(whisker.taper(), 0.95);
    /// ```
    #[must_use]
    pub const fn cone(
        length_mm: f64,
        [base_radius_um, tip_radius_um]: [f64; 2],
        youngs_modulus_gpa: f64,
    ) -> Self {
        Self {
            length_mm,
            base_radius_um,
            tip_radius_um,
            youngs_modulus_gpa,
            curvature: None,
            euler_spiral: None,
            traced: None,
            profile: None,
            profile_scale: 1.0,
            modulus_tip_to_base: 1.0,
            arc_stretch: 1.0,
            follicle_stiffness_nnm_per_rad: None,
            yield_strain: None,
        }
    }

    /// Returns the dimensionless rod of this whisker with `pole` on `side`.
    #[must_use]
    pub fn rod(&self, pole: &Pole, side: Side) -> Rod {
        let parabola = self.curvature.unwrap_or_default();
        let (a, x0) = (parabola.parabola_per_mm, parabola.vertex_mm);
        Rod {
            taper: self.taper() * self.arc_stretch,
            bend: a * self.length_mm,
            slope: -2.0 * a * x0,
            pole: side.sign() * pole.radius_mm / self.length_mm,
            gradient: (self.modulus_tip_to_base - 1.0) * self.arc_stretch,
            friction: side.sign() * pole.friction,
            mount: self
                .follicle_stiffness_nnm_per_rad
                .map_or(0.0, |stiffness| self.units().moment_nnm / stiffness),
            spiral: self.euler_spiral.map(|spiral| {
                let length = self.length_mm;
                [spiral.per_mm * length, spiral.per_mm2 * length * length]
            }),
            polynomial: self.traced.map(Arc::new),
            profile: self
                .profile
                .as_ref()
                .map(|rows| Arc::new(RadiusProfile::new(rows, self.arc_stretch))),
        }
    }

    /// Returns the units of length, force and moment of this whisker's rod.
    #[must_use]
    pub fn units(&self) -> Units {
        Units::new(self.length_mm, self.base_radius_um, self.youngs_modulus_gpa)
    }

    /// Returns the taper of the whisker, `1 - tip/base radius`: 0 is a cylinder, 1 a perfect cone.
    #[must_use]
    pub fn taper(&self) -> f64 {
        1.0 - self.tip_radius_um / self.base_radius_um
    }

    /// Returns true if a bending `strain` exceeds the yield strain, and false for a strain that is not known; `None` without a yield strain.
    #[must_use]
    pub fn yields(&self, strain: f64) -> Option<bool> {
        self.yield_strain.map(|most| strain > most)
    }

    /// Returns the largest curvature of the whisker at rest, in radians per millimetre.
    #[must_use]
    pub fn sharpest_bend_per_mm(&self) -> f64 {
        let parabola = self.curvature.map_or(0.0, |parabola| 2.0 * parabola.parabola_per_mm);
        let spiral = self.euler_spiral.map_or(0.0, |spiral| {
            let at_tip = spiral.per_mm + spiral.per_mm2 * self.length_mm;
            spiral.per_mm.abs().max(at_tip.abs())
        });
        let traced = self.traced.map_or(0.0, |curvature| curvature.sharpest());
        parabola.max(spiral).max(traced / self.length_mm)
    }
}

/// Parabola of the resting whisker, `y = A (x - vertex)^2` with the base at `x = 0` (paper, Eq. 7); straight by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    /// Coefficient `A` of the parabola, in 1/mm.
    pub parabola_per_mm: f64,
    /// Position of the parabola's vertex along `x`, in millimetres.
    pub vertex_mm: f64,
}

impl Curvature {
    /// Returns true unless the parabola is a straight line with its vertex at the base. On any other line, derivatives by the coefficient
    /// depend on the vertex.
    pub(super) fn is_given(&self) -> bool {
        *self != Self::default()
    }
}

/// Euler spiral of the resting whisker: its curvature is linear in the arclength (Starostin et al. 2020).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EulerSpiral {
    /// Curvature of the spiral at the base, in 1/mm; positive bends toward the CF side, as a parabola does.
    pub per_mm: f64,
    /// Growth of the spiral's curvature along the whisker, in 1/mm2.
    pub per_mm2: f64,
}

/// Pole that the whisker is pushed against.
///
/// The pole touches the whisker's centre line: the whisker's own thickness does not add to the pole's radius. Where it
/// matters, give the sum of both radii at the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// Radius of the pole, in millimetres; 0 is a point contact.
    pub radius_mm: f64,
    /// Coulomb's coefficient of friction between whisker and pole, dimensionless.
    pub friction: f64,
}

impl Pole {
    /// Creates a pole without friction; its radius is in millimetres.
    #[must_use]
    pub const fn smooth(radius_mm: f64) -> Self {
        Self { radius_mm, friction: 0.0 }
    }
}
