//! A state of the whisker in the units of people.

use super::rod::arclength_at;
use super::{Full, Rest, Rod, nearest_turn};
use crate::scene::Whisker;
use glam::DVec2;
use std::f64::consts::FRAC_PI_4;

/// The units of one whisker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Of lengths: the whisker's own.
    pub length_mm: f64,
    /// Of forces: `E I_base/L^2`.
    pub force_un: f64,
    /// Of moments and, in nJ, of energies: `E I_base/L`.
    pub moment_nnm: f64,
}

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

impl Units {
    /// The units of `whisker`.
    #[must_use]
    pub fn new(whisker: &Whisker) -> Self {
        let stiffness =
            whisker.youngs_modulus_gpa * 1e9 * FRAC_PI_4 * (whisker.base_radius_um * 1e-6).powi(4);
        let length = whisker.length_mm * 1e-3;
        Self {
            length_mm: whisker.length_mm,
            force_un: stiffness / (length * length) * 1e6,
            moment_nnm: stiffness / length * 1e9,
        }
    }

    /// What reads the states of `rod` in these units.
    #[must_use]
    pub fn reader(&self, rod: &Rod) -> Reader {
        let tangent = rod.contact_tangent();
        Reader {
            units: *self,
            taper: rod.taper,
            rest: Rest::new(rod),
            to_pole: rod.to_pole(),
            tilt: tangent.to_angle(),
            normal: tangent.x,
        }
    }
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
    /// The state `full`, in contact at `tau`, after the signed `push` (radians) since the pole was first touched in the
    /// direction `touch`.
    #[must_use]
    pub fn read(&self, tau: f64, full: &Full, touch: f64, push: f64) -> Reading {
        let (base, units) = (&full.base, &self.units);
        let to_base = DVec2::new(base.tangent.x, -base.tangent.y);
        let contact = to_base.rotate(-base.position);
        let to_pole = self.to_pole - base.position;
        let distance = contact.length();
        let resting = self.rest.point_at_distance(distance);
        let chord = DVec2::new(resting.x, -resting.y).rotate(contact).to_angle();
        Reading {
            arc_length_mm: arclength_at(self.taper, tau) * units.length_mm,
            contact_angle_deg: (touch + push - to_pole.to_angle() + self.tilt).to_degrees(),
            force_un: base.force.abs() * self.normal * units.force_un,
            base_force_un: base.force * DVec2::new(base.tangent.y, base.tangent.x) * units.force_un,
            base_moment_nnm: -base.force * base.position.x * units.moment_nnm,
            push_chord_deg: nearest_turn(chord, push).to_degrees(),
            contact_distance_mm: distance * units.length_mm,
            energy_nj: full.energy * units.moment_nnm,
        }
    }
}
