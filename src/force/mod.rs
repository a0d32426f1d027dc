//! Forces from the change of curvature at one point of the whisker, as experiments measure them (the paper's Fig. 7B).
//!
//! The bending moment at a point is the bending stiffness there times the change of the curvature from the resting whisker. The moment divided
//! by the lever of the contact is the force, which is normal to the whisker at the contact: friction and inertia are left out.

mod baseline;
mod bending;
mod deviation;
mod frames;
mod model;
mod state_curve;

pub use baseline::CurvatureBaseline;
pub use frames::CurvatureFrames;

use crate::names::names;
use crate::quantile::median;
use crate::scene::{FrameDeviations, Pole, Whisker, digits, rounded};
use crate::trace::row;
use bending::Bending;
use glam::DVec2;
use model::Model;
use rayon::prelude::*;
use serde::Serialize;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::Side;

/// Contact in a frame, in the frame of the base with the first axis [`ForceOptions::axis`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameContact {
    /// False if the whisker may be free: the film does not show whether it is in contact, and the frame has no force.
    pub is_known: bool,
    /// Position of the contact, `[x, y]` in mm; NaN where it is missing.
    pub contact_mm: [f64; 2],
    /// Angle of the whisker's tangent at the contact, in degrees; `None` if it was not measured.
    pub contact_angle_deg: Option<f64>,
}

/// Frame of a film: curvature at one point, and the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureFrame {
    /// Line of the frame in its file.
    pub line: usize,
    /// Time of the frame, in s.
    pub time_s: f64,
    /// Curvature of the whisker at the measured point, in 1/mm; NaN where it is missing.
    pub curvature_per_mm: f64,
    /// Arclength from the base to the measured point, in mm; NaN where it is missing.
    pub at_arc_length_mm: f64,
    /// Position of the measured point, `[x, y]` in mm, NaN where it is missing; `None` for the position on the resting whisker.
    pub at_mm: Option<[f64; 2]>,
    /// Position and tangent of the whisker at the contact in this frame; `None` if the whisker is free.
    pub contact: Option<FrameContact>,
}

impl CurvatureFrame {
    /// Returns true if a number that `method` needs is missing.
    fn is_missing(&self, method: ForceMethod) -> bool {
        let contact = self.contact.as_ref();
        if contact.is_some_and(|contact| !contact.is_known) {
            return true;
        }
        let position = contact.map_or([0.0; 2], |contact| contact.contact_mm);
        let angle = contact
            .and_then(|contact| contact.contact_angle_deg)
            .filter(|_| method == ForceMethod::Lever);
        let at = self.at_mm.filter(|_| method == ForceMethod::Lever && contact.is_some());
        let [at, place] = [at.unwrap_or([0.0; 2]), position];
        let numbers = [self.curvature_per_mm, self.at_arc_length_mm];
        let numbers = numbers.into_iter().chain(at).chain(place).chain(angle);
        numbers.into_iter().any(f64::is_nan)
    }
}

/// Reason why a frame has no force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoForce {
    /// A number of the frame is missing.
    Missing,
    /// The measured point is at the contact or beyond it, where there is no moment; with the model, in all stable states with this contact
    /// distance.
    NoLever,
    /// The contact is farther from the base than the whisker is long.
    OutOfReach,
    /// No stable state of the model has this contact distance and this curvature.
    NoState,
    /// The computation was cancelled before the frame.
    Cancelled,
}

row! {
    /// Force in a frame. All values are 0 without contact.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct FrameForce of a state {
        /// Time of the frame, in s.
        pub time_s: f64,
        /// Change of the curvature at the measured point from that at rest, less the baseline if there is one, in 1/mm.
        pub curvature_change_per_mm: Option<f64>,
        /// Bending moment at the measured point, in nN m: positive turns the tip to the left.
        pub moment_nnm: Option<f64>,
        /// Size of the force between pole and whisker, normal to both, in uN.
        pub force_un: Option<f64> = load,
        pub base_force_x_un: Option<f64> = load,
        pub base_force_y_un: Option<f64> = load,
        pub base_moment_nnm: Option<f64> = load,
        pub contact_angle_deg: Option<f64> = place,
        /// Distance of the measured contact from that of the model, in mm; with --model.
        pub contact_off_mm: Option<f64>,
        /// Standard deviation of the size of the force, in uN; with a baseline or standard deviations of frames.
        pub force_sd_un: Option<f64>,
        /// Standard deviation of the force on the base along the base's tangent, in uN.
        pub base_force_x_sd_un: Option<f64>,
        /// Standard deviation of the force on the base to the left of its tangent, in uN.
        pub base_force_y_sd_un: Option<f64>,
        /// Standard deviation of the moment on the base, in nN m.
        pub base_moment_sd_nnm: Option<f64>,
        /// Side of the whisker that the pole is on, with --model: cb (convex) or cf (concave).
        pub side: Option<Side>,
        /// Arclength from the base to the contact, in mm; with --model.
        pub arc_length_mm: Option<f64> = place,
        /// Reason of a frame without a force: missing, no-lever, out-of-reach or no-state.
        pub reason: Option<NoForce>,
    }
}

/// Method by which forces follow from the curvature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceMethod {
    /// Moment over lever. Every frame in contact needs the angle of the contact.
    Lever,
    /// The stable state of the full model that has this curvature, and this distance of the contact from the base.
    Model,
}

/// First axis of the frame of the base, to which positions, angles and forces of frames refer. Without a follicle both axes are one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BaseAxis {
    /// Tangent of the bent whisker at its base, as a film shows it.
    #[default]
    Tangent,
    /// Axis of the follicle, which a push turns: the base's tangent in all other tables.
    Follicle,
}

names!(BaseAxis { Tangent = "tangent", Follicle = "follicle" });

/// Method, baseline and standard deviations with which forces follow from frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceOptions {
    /// Method by which forces follow from the curvature.
    pub method: ForceMethod,
    /// Baseline from which the curvature changes; `None` for the shape at rest alone.
    pub baseline: Option<CurvatureBaseline>,
    /// Standard deviations of what a frame measures. Without one of the curvature, the scatter of the baseline is it.
    pub deviations: FrameDeviations,
    /// First axis of the frame of the base.
    pub axis: BaseAxis,
}

impl ForceOptions {
    /// Creates options without a baseline and standard deviations, in the frame of the base's tangent.
    #[must_use]
    pub fn new(method: ForceMethod) -> Self {
        Self {
            method,
            baseline: None,
            deviations: FrameDeviations::default(),
            axis: BaseAxis::default(),
        }
    }

    /// Returns the standard deviations of what a frame measures, with the scatter of the baseline.
    fn with_scatter(&self) -> FrameDeviations {
        let scatter = self.baseline.map(|baseline| baseline.sd_per_mm);
        FrameDeviations {
            curvature_per_mm: self.deviations.curvature_per_mm.or(scatter),
            ..self.deviations
        }
    }
}

/// Least number of frames without contact that show a moment, as for a baseline.
const LEAST_FREE: usize = 2;

/// Largest moment without contact, in parts of that in contact, without a warning.
const MOST_AT_REST: f64 = 0.25;

/// Largest distance of a measured contact from the contact of the model without a warning, in whisker lengths.
///
/// Measured on 68 films made with points off by up to 2 pixels, or with a wrong shape at rest: 67 films have distances of up to 0.054. The axis
/// of another frame of the base leads to distances of up to 0.53.
const MOST_OFF: f64 = 0.1;

/// Returns one line for frames of `whisker` without a force, and one for frames whose contact is far from the contact of the model.
#[must_use]
pub fn warnings(whisker: &Whisker, forces: &[FrameForce]) -> Vec<String> {
    let all = forces.len();
    let without = forces.iter().filter(|force| force.reason.is_some()).count();
    let has_no_contact = forces.iter().all(|force| force.reason == Some(NoForce::Missing));
    let without = (without > 0).then(|| {
        let what = format!("{without} of {all} frames have no force");
        match has_no_contact {
            true => format!(
                "{what}: each lacks a number, such as its contact, which an import without a pole does not find"
            ),
            false => format!("{what}, for the reasons in the table"),
        }
    });
    let most_mm = MOST_OFF * whisker.length_mm;
    let offs = forces.iter().filter_map(|force| force.contact_off_mm);
    let far: Vec<f64> = offs.filter(|off| *off > most_mm).collect();
    let far = (!far.is_empty()).then(|| {
        let [most_mm, farthest] =
            [most_mm, far.iter().copied().fold(0.0, f64::max)].map(|mm| digits(rounded(mm, 3)));
        format!(
            "{} of {all} frames have a contact_off_mm of more than {most_mm}, a tenth of the whisker's length, and up to {farthest}: check the contacts, \
             and the axis of their frame",
            far.len()
        )
    });
    without.into_iter().chain(far).chain(unlike_rest(forces)).collect()
}

/// Returns a warning if the curvature without contact is not that of the scene's shape at rest.
fn unlike_rest(forces: &[FrameForce]) -> Option<String> {
    let is_free = |force: &&FrameForce| force.reason.is_none() && force.force_un == Some(0.0);
    let (free, held): (Vec<&FrameForce>, Vec<&FrameForce>) = forces.iter().partition(is_free);
    if free.len() < LEAST_FREE || held.is_empty() {
        return None;
    }
    let of_free = median(free.iter().filter_map(|force| force.moment_nnm)).abs();
    let of_held = median(held.iter().filter_map(|force| Some(force.moment_nnm?.abs())));
    (of_free > MOST_AT_REST * of_held).then(|| {
        let [of_free, of_held] = [of_free, of_held].map(|nnm| digits(rounded(nnm, 3)));
        format!(
            "frames without contact have a moment of {of_free} nN m, others {of_held} nN m (medians): the shape at rest of the scene may not be the \
             whisker's; a baseline measures it"
        )
    })
}

/// Computes the force in each of the `frames` of `whisker` at `pole`, whose friction is left out, `[frame]`. With [`ForceMethod::Lever`], a
/// frame in contact without the angle of the contact has the reason [`NoForce::NoLever`].
#[must_use]
pub fn forces(
    whisker: &Whisker,
    pole: &Pole,
    frames: &[CurvatureFrame],
    method: ForceMethod,
) -> Vec<FrameForce> {
    let options = ForceOptions::new(method);
    forces_until(whisker, pole, frames, &options, &AtomicBool::new(false))
}

/// Computes the forces as [`forces`] does, with a baseline and standard deviations. The deviations are of first order in the deviations of
/// the frames, which are independent; loads of frames without contact are exactly 0. If `cancel` is true, the function soon returns, and the
/// remaining frames have the reason [`NoForce::Cancelled`].
#[must_use]
pub fn forces_until(
    whisker: &Whisker,
    pole: &Pole,
    frames: &[CurvatureFrame],
    options: &ForceOptions,
    cancel: &AtomicBool,
) -> Vec<FrameForce> {
    let method = options.method;
    let deviations = options.with_scatter();
    let baseline_per_mm = options.baseline.map_or(0.0, |baseline| baseline.mean_per_mm);
    let distances = frames.iter().filter_map(|frame| frame.contact);
    let distances = distances.map(|contact| DVec2::from(contact.contact_mm).length());
    let nearest = distances.fold(whisker.length_mm, f64::min);
    let model = || Model::new(whisker, pole, nearest, options.axis);
    let model = (method == ForceMethod::Model).then(model);
    let force = |frame: &CurvatureFrame| {
        let bending = Bending::new(whisker, frame).less(baseline_per_mm);
        if frame.is_missing(method) {
            return bending.none(frame.time_s, NoForce::Missing);
        }
        let Some(contact) = &frame.contact else {
            return bending.free(frame.time_s);
        };
        match &model {
            Some(_) if cancel.load(Ordering::Relaxed) => {
                bending.none(frame.time_s, NoForce::Cancelled)
            }
            Some(model) => model.force(&bending, frame, contact, &deviations),
            None => bending.force(frame, contact, &deviations),
        }
    };
    frames.par_iter().map(force).collect()
}
