//! A state of the whisker in the units of people.

use super::FullState;
use crate::numerics::nearest_turn;
use crate::rod::{Rest, Rod, Units, arclength_at};
use glam::DVec2;

/// What a person reads off a state. The base frame has its first axis along the base's tangent; force and moment
/// are those that the pole puts on the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// From the base to the contact, along the whisker.
    pub arc_length_mm: f64,
    /// Of the whisker's tangent at the contact, from the base's tangent.
    pub contact_angle_deg: f64,
    /// Between pole and whisker, normal to both.
    pub force_un: f64,
    /// In the base frame.
    pub base_force_un: DVec2,
    /// Positive where it turns the base's tangent toward its normal.
    pub base_moment_nnm: f64,
    /// The push angle of the paper's Fig. 1D, between base-contact and the point of the resting whisker that is as
    /// far from the base.
    pub push_chord_deg: f64,
    /// From the base to the contact, as the crow flies.
    pub contact_distance_mm: f64,
    /// Of bending.
    pub energy_nj: f64,
}

/// What of a rod is the same in all its states.
#[derive(Clone, Copy, Debug)]
pub struct Reader {
    units: Units,
    taper: f64,
    rest: Rest,
    to_pole: DVec2,
    /// Of the contact's tangent from the normal of the force.
    tilt: f64,
    /// The part of the force that is normal to the whisker.
    normal: f64,
}

impl Reader {
    /// What reads the states of `rod` in `units`.
    #[must_use]
    pub fn new(units: Units, rod: &Rod) -> Self {
        let tangent = rod.contact_tangent();
        Self {
            units,
            taper: rod.taper,
            rest: Rest::new(rod),
            to_pole: rod.to_pole(),
            tilt: tangent.to_angle(),
            normal: tangent.x,
        }
    }

    /// What a difference of one in each number of a state, as seen without units, is in a reading: lengths in whisker lengths, angles
    /// in radians, forces signed with `side` and whole.
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

    /// The state at first touch: the resting whisker, without a load. The contact is at arclength `contact`, in whisker lengths, and the
    /// pole in the direction `touch`.
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

    /// The state `full`, in contact at `tau`, after the signed `push` (radians) since the pole was first touched in the
    /// direction `touch`.
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
