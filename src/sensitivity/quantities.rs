//! Derivatives of the quantities of a state in physical units.

use super::linearised::{Linearised, Moved};
use super::whisker::WhiskerDerivative;
use glam::DVec2;
use serde::Serialize;
use whiskmap_mechanics::rod::{Rest, Side, Units, arclength};

/// Derivatives of the quantities of a detachment or a state by one variable: each in the unit of its name, per unit of the variable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Derivatives {
    /// Derivative of the push angle, in degrees per unit of the variable. At a state it is 1 by the push angle and 0 by any other variable.
    pub push_angle_deg: f64,
    /// Derivative of the chord angle, in degrees per unit of the variable.
    pub push_chord_deg: f64,
    /// Derivative of the straight distance from the base to the contact, in mm per unit of the variable.
    pub contact_distance_mm: f64,
    /// Derivative of the arclength from the base to the contact, in mm per unit of the variable.
    pub arc_length_mm: f64,
    /// Derivative of the magnitude of the normal force, in uN per unit of the variable.
    pub force_un: f64,
    /// Derivative of the size of the whole contact force, with friction, in uN per unit of the variable.
    pub contact_force_un: f64,
    /// Derivative of the force on the base along its tangent, in uN per unit of the variable.
    pub base_force_x_un: f64,
    /// Derivative of the force on the base to the left of its tangent, in uN per unit of the variable.
    pub base_force_y_un: f64,
    /// Derivative of the moment on the base, in nN m per unit of the variable.
    pub base_moment_nnm: f64,
    /// Derivative of the bending energy, in nJ per unit of the variable.
    pub energy_nj: f64,
    /// Derivative of the contact angle, in degrees per unit of the variable.
    pub contact_angle_deg: f64,
}

impl Derivatives {
    /// Returns the derivatives of the push angle (deg), the force (uN), the moment (nN m) and the energy (nJ), the arclength (mm) and the
    /// angle (deg) of the contact, in the order of [`Variable::columns`](super::Variable::columns).
    #[must_use]
    pub const fn columns(&self) -> [f64; 6] {
        [
            self.push_angle_deg,
            self.force_un,
            self.base_moment_nnm,
            self.energy_nj,
            self.arc_length_mm,
            self.contact_angle_deg,
        ]
    }

    /// Returns these derivatives plus `factor` times `other`.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let sum = |derivative: f64, other: f64| derivative + factor * other;
        Self {
            push_angle_deg: sum(self.push_angle_deg, other.push_angle_deg),
            push_chord_deg: sum(self.push_chord_deg, other.push_chord_deg),
            contact_distance_mm: sum(self.contact_distance_mm, other.contact_distance_mm),
            arc_length_mm: sum(self.arc_length_mm, other.arc_length_mm),
            force_un: sum(self.force_un, other.force_un),
            contact_force_un: sum(self.contact_force_un, other.contact_force_un),
            base_force_x_un: sum(self.base_force_x_un, other.base_force_x_un),
            base_force_y_un: sum(self.base_force_y_un, other.base_force_y_un),
            base_moment_nnm: sum(self.base_moment_nnm, other.base_moment_nnm),
            energy_nj: sum(self.energy_nj, other.energy_nj),
            contact_angle_deg: sum(self.contact_angle_deg, other.contact_angle_deg),
        }
    }

    /// Converts the derivative of a state to physical units. `phi` at first touch changes by `by_touch`.
    pub(super) fn new(
        at: &Linearised,
        moved: &Moved,
        (rest, units, side): (&Rest, Units, Side),
        by: &WhiskerDerivative,
        by_touch: f64,
    ) -> Self {
        let (rod, full, state) = (at.rod, &at.full, &moved.state);
        let (position, tangent) = (full.position, full.tangent);
        let length =
            |value: f64, derivative: f64| units.length_mm * derivative + by.length_mm * value;
        let force =
            |value: f64, derivative: f64| units.force_un * (derivative + by.ln_force * value);
        let moment =
            |value: f64, derivative: f64| units.moment_nnm * (derivative + by.ln_moment * value);

        let normal = rod.contact_tangent();
        let by_tilt = by.rod.friction / (1.0 + rod.friction * rod.friction);
        let (size, by_size) = (full.force.abs(), side.sign() * state.force);

        let distance = position.length();
        let by_distance = position.dot(state.position) / distance;
        let resting = rest.point_at_distance(distance);
        let by_resting = rest.point_derivative(distance, by_distance, &by.rod);
        let turn = |of: DVec2, by: DVec2| of.perp_dot(by) / of.length_squared();
        let chord = turn(position, state.position) - state.angle - turn(resting, by_resting);

        // The force lies along the second axis of the contact's frame.
        let axes = DVec2::new(tangent.y, tangent.x);
        let turned = state.angle * DVec2::new(tangent.x, -tangent.y);
        let base_force = full.force * axes;
        let by_base_force = state.force * axes + full.force * turned;
        let by_moment = -(state.force * position.x + full.force * state.position.x);
        Self {
            push_angle_deg: (moved.phi - by_touch).to_degrees(),
            push_chord_deg: chord.to_degrees(),
            contact_distance_mm: length(distance, by_distance),
            arc_length_mm: length(
                arclength(rod, at.tau),
                rod.arclength_derivative(at.tau, moved.tau, by.rod.taper),
            ),
            force_un: force(size * normal.x, by_size * normal.x - size * normal.y * by_tilt),
            contact_force_un: force(size, by_size),
            base_force_x_un: force(base_force.x, by_base_force.x),
            base_force_y_un: force(base_force.y, by_base_force.y),
            base_moment_nnm: moment(-full.force * position.x, by_moment),
            energy_nj: moment(full.energy, state.energy),
            contact_angle_deg: (by_tilt - state.angle).to_degrees(),
        }
    }
}
