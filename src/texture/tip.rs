//! Position of the tip: the whisker beyond the contact is not bent, so that it has its shape at rest.

use crate::rod::{Rest, Side};
use crate::scene::{Pole, Surface, Whisker};
use crate::shooting::Reading;
use glam::DVec2;
use std::f64::consts::FRAC_PI_2;

/// Whisker over a surface, with its shape at rest. Positions are in mm from the base: along the surface, and toward it.
pub struct TipFrame {
    rest: Rest,
    length_mm: f64,
    distance_mm: f64,
    radius_mm: f64,
    /// Direction of the base's tangent at the angle 0 of the base, in radians from the line of the surface.
    pub tangent: f64,
}

/// Position of the tip of a whisker over a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipPlace {
    /// Position along the surface, in mm.
    pub x_mm: f64,
    /// Height beyond the line of the asperities, in mm.
    pub height_mm: f64,
    /// True if another part of the whisker than that next to the contact meets the line of the asperities.
    pub crosses: bool,
}

/// Height, in mm, by which the tip may lie below its contact: rounding, many times over.
const ROUNDING_MM: f64 = 1e-9;

impl TipFrame {
    pub fn new(whisker: &Whisker, surface: &Surface) -> Self {
        let rest = Rest::new(&whisker.rod(&Pole::smooth(0.0), Side::Cb));
        let (tip, _) = rest.at_arclength(rest.end());
        Self {
            tangent: FRAC_PI_2 - tip.to_angle(),
            rest,
            length_mm: whisker.length_mm,
            distance_mm: surface.distance_mm,
            radius_mm: 1e-3 * surface.asperity_radius_um,
        }
    }

    /// Returns the tip of the free whisker with the base at `angle`, in radians.
    pub fn free(&self, angle: f64) -> TipPlace {
        self.place(self.resting(self.rest.end(), angle), false)
    }

    /// Returns the point at arclength `s`, in whisker lengths, of the free whisker with the base at `angle`, in radians.
    pub fn resting(&self, s: f64, angle: f64) -> DVec2 {
        let (at, _) = self.rest.at_arclength(s);
        DVec2::from_angle(self.tangent - angle).rotate(at) * self.length_mm
    }

    /// Returns the tip of the whisker in the state `reading` against an asperity at `x_mm`, with the base at `angle`, in radians.
    pub fn held(&self, x_mm: f64, side: Side, angle: f64, reading: &Reading) -> TipPlace {
        let direction = self.tangent - angle + reading.contact_angle_deg.to_radians();
        let tangent = DVec2::from_angle(direction);
        let centre = DVec2::new(x_mm, self.distance_mm);
        let contact = centre + side.sign() * self.radius_mm * tangent.perp();
        let end = self.rest.end();
        let s = (reading.arc_length_mm / self.length_mm).min(end);
        let ((at, at_rest), (tip, _)) = (self.rest.at_arclength(s), self.rest.at_arclength(end));
        let turn = tangent.rotate(DVec2::new(at_rest.x, -at_rest.y));
        let tip = contact + turn.rotate(tip - at) * self.length_mm;
        let crosses = tangent.y <= 0.0 || tip.y < contact.y - ROUNDING_MM;
        self.place(tip, crosses)
    }

    fn place(&self, tip: DVec2, crosses: bool) -> TipPlace {
        TipPlace {
            x_mm: tip.x,
            height_mm: tip.y - self.distance_mm,
            crosses,
        }
    }
}
