//! Bending of a frame, and the force by its lever: moment over distance.

use super::deviation::LoadDerivatives;
use super::{CurvatureFrame, FrameContact, FrameForce, NoForce};
use crate::scene::{FrameDeviations, Pole, Whisker};
use crate::trace::StateRow;
use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Side};

/// Bending of the whisker at the measured point of a film's frame.
#[derive(Clone, Copy, Debug)]
pub struct Bending {
    /// Position of the measured point in the frame of the base, in mm.
    at: DVec2,
    /// Change of the curvature from that at rest, less the baseline, in 1/mm.
    pub change_per_mm: f64,
    /// Bending moment over the change of the curvature, in nN m per 1/mm.
    stiffness: f64,
    /// Length of the whisker, in mm.
    length_mm: f64,
}

/// Returns a number that is not NaN.
fn known(number: f64) -> Option<f64> {
    Some(number).filter(|number| !number.is_nan())
}

impl Bending {
    pub fn new(whisker: &Whisker, frame: &CurvatureFrame) -> Self {
        // The side only gives the signs of the pole and of friction, which do not enter.
        let rod = whisker.rod(&Pole::smooth(0.0), Side::Cb);
        let (rest, length) = (Rest::new(&rod), whisker.length_mm);
        let s = frame.at_arc_length_mm / length;
        let change_per_mm = frame.curvature_per_mm - rest.curvature(s) / length;
        Self {
            at: frame.at_mm.map_or_else(|| rest.at_arclength(s).0 * length, DVec2::from),
            change_per_mm,
            stiffness: length * rod.stiffness(s) * whisker.units().moment_nnm,
            length_mm: length,
        }
    }

    /// Returns the bending with a change of the curvature that is less by a baseline, in 1/mm.
    pub fn less(self, baseline_per_mm: f64) -> Self {
        let change_per_mm = self.change_per_mm - baseline_per_mm;
        Self { change_per_mm, ..self }
    }

    /// Returns the bending moment, in nN m.
    fn moment_nnm(&self) -> f64 {
        self.change_per_mm * self.stiffness
    }

    /// Returns the row of a frame without contact at `time_s`, in s: all loads are 0.
    pub fn free(&self, time_s: f64) -> FrameForce {
        FrameForce { reason: None, ..self.none(time_s, NoForce::NoLever).unloaded() }
    }

    /// Returns the row of a frame at `time_s`, in s, without a force for this reason.
    pub fn none(&self, time_s: f64, reason: NoForce) -> FrameForce {
        FrameForce {
            time_s,
            curvature_change_per_mm: known(self.change_per_mm),
            moment_nnm: known(self.moment_nnm()),
            reason: Some(reason),
            ..FrameForce::default()
        }
    }

    /// Returns the force as the moment at the measured point over the lever of the contact: the distance between them along the tangent
    /// at the contact.
    pub fn force(
        &self,
        frame: &CurvatureFrame,
        contact: &FrameContact,
        sd: &FrameDeviations,
    ) -> FrameForce {
        let none = self.none(frame.time_s, NoForce::NoLever);
        let Some(angle) = contact.contact_angle_deg else {
            return none;
        };
        let tangent = DVec2::new(libm::cos(angle.to_radians()), libm::sin(angle.to_radians()));
        let position = DVec2::from(contact.contact_mm);
        if position.length() > self.length_mm {
            return self.none(frame.time_s, NoForce::OutOfReach);
        }
        let lever = (position - self.at).dot(tangent);
        // A shorter lever is a rounding error of the two positions.
        if lever <= f64::EPSILON * self.length_mm {
            return none;
        }
        let force = self.moment_nnm() / lever;
        let normal = tangent.perp();
        let on_base = force * normal;
        // Derivatives of the loads, from the derivatives of the force, of the normal and of the position.
        let loads = |force_by: f64, normal_by: DVec2, position_by: DVec2| {
            let by = force_by * normal + force * normal_by;
            let moment = position_by.perp_dot(on_base) + position.perp_dot(by);
            [force_by, by.x, by.y, moment]
        };
        let by_coordinate = |along: DVec2| {
            let lever_by = along.dot(tangent);
            loads(-force * lever_by / lever, DVec2::ZERO, along)
        };
        let lever_by_angle = (position - self.at).dot(normal);
        let by_angle = loads(-force * lever_by_angle / lever, -tangent, DVec2::ZERO);
        let derivatives = LoadDerivatives {
            by_curvature: loads(self.stiffness / lever, DVec2::ZERO, DVec2::ZERO),
            by_contact: [DVec2::X, DVec2::Y].map(by_coordinate),
            by_angle: by_angle.map(|by| by * 1.0_f64.to_radians()),
        };
        let found = FrameForce {
            force_un: Some(force.abs()),
            base_force_x_un: Some(on_base.x),
            base_force_y_un: Some(on_base.y),
            base_moment_nnm: Some(position.perp_dot(on_base)),
            contact_angle_deg: Some(angle),
            reason: None,
            ..none
        };
        derivatives.deviate(found, sd)
    }
}
