//! Position of the tip: the whisker beyond the contact is not bent, so that it has its shape at rest.

use crate::numerics::Bracket;
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
    /// Largest curvature of the whisker at rest, in radians per mm.
    sharpest_per_mm: f64,
    /// Direction of the base's tangent at the angle 0 of the base, in radians from the line of the surface.
    pub tangent: f64,
}

/// Position of the tip of a whisker over a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipPlace {
    /// Position of the tip along the surface, in mm from the point nearest to the base.
    pub x_mm: f64,
    /// Height of the tip beyond the line of the asperities, in mm.
    pub height_mm: f64,
}

/// Clearance of the free part of the whisker, which lies beyond its contact.
#[derive(Clone, Copy, Debug)]
pub struct Clearance {
    /// Least height above the contact of a point of the free part, in parts of its arclength from there. It is negative if the whisker meets the line of the asperities again.
    pub least: f64,
    /// Direction of the tangent at the contact, in radians from the line of the surface.
    direction: f64,
    /// Largest turn of a chord from the contact, against its tangent, by a change of the contact along the whisker: the arclength of the contact times the largest curvature.
    bend: f64,
}

impl Clearance {
    /// Returns the largest change of the clearance to that of another state if direction and contact change monotonically in between. A chord
    /// from the contact changes by at most half the largest curvature, and the tangent there by the largest curvature.
    pub fn variation(&self, to: &Self) -> f64 {
        (to.direction - self.direction).abs() + 1.5 * (to.bend - self.bend).abs()
    }
}

/// Number of parts of the free part between which its lowest chord is looked for.
const PARTS: u32 = 64;

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
            sharpest_per_mm: whisker.sharpest_bend_per_mm(),
        }
    }

    /// Returns the position of the tip of the free whisker with the base at `angle`, in radians.
    pub fn free(&self, angle: f64) -> TipPlace {
        self.place(self.resting(self.rest.end(), angle))
    }

    /// Returns the point at arclength `s`, in whisker lengths, of the free whisker with the base at `angle`, in radians. The point is in mm: along
    /// the surface, and toward it.
    pub fn resting(&self, s: f64, angle: f64) -> DVec2 {
        let (at, _) = self.rest.at_arclength(s);
        DVec2::from_angle(self.tangent - angle).rotate(at) * self.length_mm
    }

    /// Returns the position of the tip of the whisker in the state `reading` against an asperity at `x_mm`, with the base at `angle`, in radians.
    pub fn held(&self, x_mm: f64, side: Side, angle: f64, reading: &Reading) -> TipPlace {
        let tangent = DVec2::from_angle(self.direction(angle, reading));
        let centre = DVec2::new(x_mm, self.distance_mm);
        let contact = centre + side.sign() * self.radius_mm * tangent.perp();
        let (s, end) = (self.contact(reading), self.rest.end());
        let (at, at_rest) = self.rest.at_arclength(s);
        let (tip, _) = self.rest.at_arclength(end);
        let turn = tangent.rotate(DVec2::new(at_rest.x, -at_rest.y));
        self.place(contact + turn.rotate(tip - at) * self.length_mm)
    }

    /// Returns the clearance of the free part in the state `reading`, with the base at `angle`, in radians.
    pub fn clearance(&self, angle: f64, reading: &Reading) -> Clearance {
        let direction = self.direction(angle, reading);
        let tangent = DVec2::from_angle(direction);
        let (s, end) = (self.contact(reading), self.rest.end());
        let (at, at_rest) = self.rest.at_arclength(s);
        let turn = tangent.rotate(DVec2::new(at_rest.x, -at_rest.y));
        let slope = |to: f64| {
            let (point, _) = self.rest.at_arclength(to);
            turn.rotate(point - at).y / (to - s)
        };
        // The slope of a chord falls while the tangent at its end is below it.
        let rise = |to: f64| {
            let (point, tangent) = self.rest.at_arclength(to);
            turn.rotate(tangent * (to - s) - (point - at)).y
        };
        let to = |part: u32| (end - s).mul_add(f64::from(part) / f64::from(PARTS), s);
        let slopes = (1..=PARTS).map(|part| (part, slope(to(part))));
        let contact = (0, tangent.y);
        let (lowest, least) = match s < end {
            true => slopes.fold(contact, |a, b| if b.1 < a.1 { b } else { a }),
            false => contact,
        };
        let around = [lowest.saturating_sub(1), (lowest + 1).min(PARTS)].map(to);
        let turns = Bracket::new(around, around.map(rise)).bisect(rise);
        Clearance {
            least: match turns > s {
                true => least.min(slope(turns)),
                false => least,
            },
            direction,
            bend: self.sharpest_per_mm * self.length_mm * s,
        }
    }

    /// Returns the direction of the tangent at the contact, in radians from the line of the surface.
    fn direction(&self, angle: f64, reading: &Reading) -> f64 {
        self.tangent - angle + reading.contact_angle_deg.to_radians()
    }

    /// Returns the arclength of the contact, in whisker lengths.
    fn contact(&self, reading: &Reading) -> f64 {
        (reading.arc_length_mm / self.length_mm).min(self.rest.end())
    }

    fn place(&self, tip: DVec2) -> TipPlace {
        TipPlace {
            x_mm: tip.x,
            height_mm: tip.y - self.distance_mm,
        }
    }
}
