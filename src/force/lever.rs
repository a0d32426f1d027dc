//! Moment over lever.

use super::{CurvatureFrame, FrameContact, FrameForce, NoForce};
use crate::scene::{Pole, Whisker};
use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Side};

/// Bending of the whisker at the measured point of a film's frame.
#[derive(Clone, Copy, Debug)]
pub struct Bending {
    /// Position of the measured point in the frame of the base, in mm.
    at: DVec2,
    /// Change of the curvature from that at rest, in 1/mm.
    pub change_per_mm: f64,
    /// Bending moment, in nN m.
    moment_nnm: f64,
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
            at: frame
                .at_mm
                .map_or_else(|| rest.at_arclength(s).0 * length, DVec2::from),
            change_per_mm,
            moment_nnm: change_per_mm * length * rod.stiffness(s) * whisker.units().moment_nnm,
            length_mm: length,
        }
    }

    /// Returns the row of a frame without contact at `time_s`, in s: all loads are 0.
    pub fn free(&self, time_s: f64) -> FrameForce {
        FrameForce {
            force_un: Some(0.0),
            base_force_x_un: Some(0.0),
            base_force_y_un: Some(0.0),
            base_moment_nnm: Some(0.0),
            reason: None,
            ..self.none(time_s, NoForce::NoLever)
        }
    }

    /// Returns the row of a frame at `time_s`, in s, without a force for this reason.
    pub fn none(&self, time_s: f64, reason: NoForce) -> FrameForce {
        FrameForce {
            time_s,
            curvature_change_per_mm: known(self.change_per_mm),
            moment_nnm: known(self.moment_nnm),
            force_un: None,
            base_force_x_un: None,
            base_force_y_un: None,
            base_moment_nnm: None,
            contact_angle_deg: None,
            contact_off_mm: None,
            reason: Some(reason),
        }
    }

    /// Returns the force as the moment at the measured point over the lever of the contact: the distance between them along the tangent
    /// at the contact.
    pub fn force(&self, frame: &CurvatureFrame, contact: &FrameContact) -> FrameForce {
        let none = self.none(frame.time_s, NoForce::NoLever);
        let Some(angle) = contact.contact_angle_deg else {
            return none;
        };
        let tangent = DVec2::new(libm::cos(angle.to_radians()), libm::sin(angle.to_radians()));
        let position = DVec2::from(contact.contact_mm);
        let lever = (position - self.at).dot(tangent);
        // A shorter lever is a rounding error of the two positions.
        if lever <= f64::EPSILON * self.length_mm {
            return none;
        }
        let force = self.moment_nnm / lever;
        let on_base = force * tangent.perp();
        FrameForce {
            force_un: Some(force.abs()),
            base_force_x_un: Some(on_base.x),
            base_force_y_un: Some(on_base.y),
            base_moment_nnm: Some(position.perp_dot(on_base)),
            contact_angle_deg: Some(angle),
            reason: None,
            ..none
        }
    }
}
