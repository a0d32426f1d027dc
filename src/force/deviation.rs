//! Standard deviations of forces, to first order in the standard deviations of the measured numbers of a frame.

use super::FrameForce;
use crate::scene::FrameDeviations;

/// Force between pole and whisker, its parts on the base, and the moment on the base; or their derivatives by a measured number.
pub type Loads = [f64; 4];

/// Derivatives of the loads by what a frame measures: force in uN and moment in nN m.
#[derive(Clone, Copy, Debug)]
pub struct LoadDerivatives {
    /// Derivatives by the curvature, per 1/mm.
    pub by_curvature: Loads,
    /// Derivatives by both coordinates of the contact, per mm.
    pub by_contact: [Loads; 2],
    /// Derivatives by the angle of the contact, per degree.
    pub by_angle: Loads,
}

impl LoadDerivatives {
    /// Returns the `force` with the standard deviations of its loads. What has no standard deviation in `sd` is exact; without any there are
    /// none. So are there none where the derivatives do not exist.
    pub fn deviate(&self, force: FrameForce, sd: &FrameDeviations) -> FrameForce {
        if *sd == FrameDeviations::default() {
            return force;
        }
        let [by_x, by_y] = &self.by_contact;
        let terms = [
            (&self.by_curvature, sd.curvature_per_mm),
            (by_x, sd.contact_mm),
            (by_y, sd.contact_mm),
            (&self.by_angle, sd.angle_deg),
        ];
        let deviation = |load: usize| {
            let parts = terms.map(|(by, sd)| by[load] * sd.unwrap_or_default());
            let squares: f64 = parts.iter().map(|part| part * part).sum();
            Some(squares.sqrt()).filter(|total| total.is_finite())
        };
        FrameForce {
            force_sd_un: deviation(0),
            base_force_x_sd_un: deviation(1),
            base_force_y_sd_un: deviation(2),
            base_moment_sd_nnm: deviation(3),
            ..force
        }
    }
}
