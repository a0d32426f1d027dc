//! From the whisker of a scene to the rod without dimensions, and back to its units.

use super::{Pole, Swept, Whisker};
use crate::rod::{RadiusProfile, Rod, Side, Units};
use std::sync::Arc;

impl Whisker {
    /// This whisker with `pole` on `side`.
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
            spiral: self.euler_spiral.map(|spiral| {
                let length = self.length_mm;
                [spiral.per_mm * length, spiral.per_mm2 * length * length]
            }),
            profile: self
                .profile
                .as_ref()
                .map(|rows| Arc::new(RadiusProfile::new(rows, self.arc_stretch))),
        }
    }

    /// Its units of length, force and moment.
    #[must_use]
    pub fn units(&self) -> Units {
        Units::new(self.length_mm, self.base_radius_um, self.youngs_modulus_gpa)
    }
}

impl Swept {
    /// The rod of the whisker with its pole on `side`.
    #[must_use]
    pub fn rod(&self, side: Side) -> Rod {
        self.whisker.rod(&self.pole, side)
    }
}
