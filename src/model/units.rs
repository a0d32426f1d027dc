//! A state of the whisker in the units of people.

use super::{Full, Rest, Rod, arclength, nearest_turn};
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

    /// The state `full` of `rod`, in contact at `tau`, after the signed `push` (radians) since the pole was first
    /// touched in the direction `touch`.
    #[must_use]
    pub fn read(&self, rod: &Rod, tau: f64, full: &Full, touch: f64, push: f64) -> Reading {
        let base = &full.base;
        let to_base = DVec2::new(base.tangent.x, -base.tangent.y);
        let contact = to_base.rotate(-base.position);
        let to_pole = rod.to_pole() - base.position;
        let tangent = rod.contact_tangent();
        let distance = contact.length();
        let resting = Rest::new(rod).point_at_distance(distance);
        let chord = DVec2::new(resting.x, -resting.y).rotate(contact).to_angle();
        Reading {
            arc_length_mm: arclength(rod, tau) * self.length_mm,
            contact_angle_deg: (touch + push - to_pole.to_angle() + tangent.to_angle())
                .to_degrees(),
            force_un: base.force.abs() * tangent.x * self.force_un,
            base_force_un: base.force * DVec2::new(base.tangent.y, base.tangent.x) * self.force_un,
            base_moment_nnm: -base.force * base.position.x * self.moment_nnm,
            push_chord_deg: nearest_turn(chord, push).to_degrees(),
            contact_distance_mm: distance * self.length_mm,
            energy_nj: full.energy * self.moment_nnm,
        }
    }
}
