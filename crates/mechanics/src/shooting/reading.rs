//! Readings: states of the whisker in physical units.

use super::FullState;
use crate::numerics::nearest_turn;
use crate::rod::{Rest, Rod, Units, arclength_at};
use glam::DVec2;

/// A reading: a state of the whisker in physical units. The first axis of the base frame is the base's tangent. Force and moment are
/// those that the pole exerts at the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Arc length from the base to the contact, in millimetres.
    pub arc_length_mm: f64,
    /// Angle of the whisker's tangent at the contact from the base's tangent, in degrees.
    pub contact_angle_deg: f64,
    /// Normal force between pole and whisker, in micronewtons.
    pub force_un: f64,
    /// Force `[x, y]` on the base, in the base frame, in micronewtons.
    pub base_force_un: DVec2,
    /// Moment on the base, in nanonewton metres, positive if it turns the base's tangent toward its normal.
    pub base_moment_nnm: f64,
    /// Chord angle of the paper's Fig. 1D, in degrees: between the directions from the base to the contact and to the point of the
    /// resting whisker at the same distance.
    pub push_chord_deg: f64,
    /// Straight distance from the base to the contact, in millimetres.
    pub contact_distance_mm: f64,
    /// Bending energy of the whisker, in nanojoules.
    pub energy_nj: f64,
}

/// Converter of the states of one rod to physical units.
#[derive(Clone, Debug)]
pub struct Reader {
    units: Units,
    taper: f64,
    rest: Rest,
    to_pole: DVec2,
    /// Angle of the contact's tangent from the normal of the force, in radians.
    tilt: f64,
    /// Normal force over the whole force.
    normal: f64,
}

impl Reader {
    /// Creates the converter from states of `rod` to `units`.
    #[must_use]
    pub fn new(units: Units, rod: &Rod) -> Self {
        Self {
            units,
            taper: rod.taper,
            rest: Rest::new(rod),
            to_pole: DVec2::ZERO,
            tilt: 0.0,
            normal: 1.0,
        }
        .with_contact(rod)
    }

    /// Returns this converter with the pole and the friction of `rod`, which is the same rod otherwise.
    #[must_use]
    pub fn with_contact(&self, rod: &Rod) -> Self {
        let tangent = rod.contact_tangent();
        Self {
            to_pole: rod.to_pole(),
            tilt: tangent.to_angle(),
            normal: tangent.x,
            rest: self.rest.clone(),
            ..*self
        }
    }

    /// Returns the change of a reading for a change of 1 in each dimensionless number of a state: lengths in whisker lengths, angles in
    /// radians, whole forces with the sign `side`.
    #[must_use]
    pub fn of_one(&self, side: f64) -> Reading {
        let units = &self.units;
        let degrees = 1f64.to_degrees();
        Reading {
            arc_length_mm: units.length_mm,
            contact_angle_deg: degrees,
            force_un: side * self.normal * units.force_un,
            base_force_un: DVec2::splat(units.force_un),
            base_moment_nnm: units.moment_nnm,
            push_chord_deg: degrees,
            contact_distance_mm: units.length_mm,
            energy_nj: units.moment_nnm,
        }
    }

    /// Returns the reading at first touch: the resting whisker without a load. The contact is at arclength `contact`, in whisker lengths,
    /// and the pole in the direction `touch`, in radians.
    #[must_use]
    pub fn at_first_touch(&self, contact: f64, touch: f64) -> Reading {
        let (point, tangent) = self.rest.at_arclength(contact);
        Reading {
            arc_length_mm: contact * self.units.length_mm,
            contact_angle_deg: nearest_turn(tangent.to_angle(), touch).to_degrees(),
            force_un: 0.0,
            base_force_un: DVec2::ZERO,
            base_moment_nnm: 0.0,
            push_chord_deg: 0.0,
            contact_distance_mm: point.length() * self.units.length_mm,
            energy_nj: 0.0,
        }
    }

    /// Returns the reading of the state `full` with the contact at `tau`, at the signed push angle `push` from first touch in the
    /// direction `touch`. Both angles are in radians.
    #[must_use]
    pub fn read(&self, tau: f64, full: &FullState, touch: f64, push: f64) -> Reading {
        let units = &self.units;
        let to_base = DVec2::new(full.tangent.x, -full.tangent.y);
        let contact = to_base.rotate(-full.position);
        let to_pole = self.to_pole - full.position;
        let distance = contact.length();
        let resting = self.rest.point_at_distance(distance);
        let chord = DVec2::new(resting.x, -resting.y).rotate(contact).to_angle();
        Reading {
            arc_length_mm: arclength_at(self.taper, tau) * units.length_mm,
            contact_angle_deg: (touch + push - to_pole.to_angle() + self.tilt).to_degrees(),
            force_un: full.force.abs() * self.normal * units.force_un,
            base_force_un: full.force * DVec2::new(full.tangent.y, full.tangent.x) * units.force_un,
            base_moment_nnm: -full.force * full.position.x * units.moment_nnm,
            push_chord_deg: nearest_turn(chord, push).to_degrees(),
            contact_distance_mm: distance * units.length_mm,
            energy_nj: full.energy * units.moment_nnm,
        }
    }
}
