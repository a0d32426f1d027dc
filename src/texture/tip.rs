//! Position of the tip: the whisker beyond the contact is not bent, so that it has its shape at rest.

use crate::scene::{Pole, Surface, Whisker};
use glam::DVec2;
use std::f64::consts::FRAC_PI_2;
use whiskmap_mechanics::rod::{Rest, Side};
use whiskmap_mechanics::shooting::Reading;

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
    /// Position of the contact along the surface and toward it, in mm from the base; `None` for a free whisker.
    pub contact_mm: Option<DVec2>,
    /// True if another part of the whisker than that next to the contact meets the line of the asperities.
    pub crosses: bool,
}

/// Point of the whisker beyond the contact.
struct FreePoint {
    /// Arclength, in mm.
    s_mm: f64,
    /// Position from the contact: along the surface, and toward it, in mm.
    from_contact: DVec2,
    /// Second coordinate of the unit tangent.
    slope: f64,
}

/// Height, in mm, by which a point beyond the contact may lie below it: rounding, many times over.
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
            sharpest_per_mm: whisker.sharpest_bend_per_mm(),
        }
    }

    /// Returns the position of the tip of the free whisker with the base at `angle`, in radians.
    pub fn free(&self, angle: f64) -> TipPlace {
        self.place(self.resting(self.rest.end(), angle), None, false)
    }

    /// Returns the point at arclength `s`, in whisker lengths, of the free whisker with the base at `angle`, in radians. The point is in mm: along
    /// the surface, and toward it.
    pub fn resting(&self, s: f64, angle: f64) -> DVec2 {
        let (at, _) = self.rest.at_arclength(s);
        DVec2::from_angle(self.tangent - angle).rotate(at) * self.length_mm
    }

    /// Returns the position of the tip of the whisker in the state `reading` against an asperity at `x_mm`, with the base at `angle`, in radians.
    pub fn held(&self, x_mm: f64, side: Side, angle: f64, reading: &Reading) -> TipPlace {
        let direction = self.tangent - angle + reading.contact_angle_deg.to_radians();
        let tangent = DVec2::from_angle(direction);
        let centre = DVec2::new(x_mm, self.distance_mm);
        let contact = centre + side.sign() * self.radius_mm * tangent.perp();
        let end = self.rest.end();
        let s = (reading.arc_length_mm / self.length_mm).min(end);
        let (at, at_rest) = self.rest.at_arclength(s);
        let turn = tangent.rotate(DVec2::new(at_rest.x, -at_rest.y));
        let free = |s: f64| {
            let (point, tangent) = self.rest.at_arclength(s);
            let from_contact = turn.rotate(point - at) * self.length_mm;
            FreePoint { s_mm: s * self.length_mm, from_contact, slope: turn.rotate(tangent).y }
        };
        let (begin, tip) = (free(s), free(end));
        let at_mm = |s_mm: f64| free(s_mm / self.length_mm);
        let crosses = tangent.y <= 0.0 || self.descends(&begin, &tip, &at_mm);
        self.place(contact + tip.from_contact, Some(contact), crosses)
    }

    /// Returns true if a point between two points of the free part lies below the contact. The second derivative of the height by the
    /// arclength is at most the largest curvature. So parts that cannot be lower than the contact need no further points.
    fn descends(
        &self,
        from: &FreePoint,
        to: &FreePoint,
        between: &impl Fn(f64) -> FreePoint,
    ) -> bool {
        let heights = [from, to].map(|point| point.from_contact.y);
        let lowest = heights[0].min(heights[1]);
        if lowest < -ROUNDING_MM {
            return true;
        }
        let length = to.s_mm - from.s_mm;
        let bend = self.sharpest_per_mm * length;
        // Above the chord less the largest sag, or above the parabola that the first point begins.
        let above_chord = lowest - 0.125 * bend * length;
        let above_parabola = heights[0].min(heights[0] + length * (from.slope - 0.5 * bend));
        if above_chord.max(above_parabola) >= -2.0 * ROUNDING_MM {
            return false;
        }
        let middle = between(from.s_mm + 0.5 * length);
        self.descends(from, &middle, between) || self.descends(&middle, to, between)
    }

    fn place(&self, tip: DVec2, contact_mm: Option<DVec2>, crosses: bool) -> TipPlace {
        TipPlace { x_mm: tip.x, height_mm: tip.y - self.distance_mm, contact_mm, crosses }
    }
}
