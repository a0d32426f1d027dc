//! Rows of a course: samples and events.

use crate::friction::Sliding;
use crate::trace::row;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

/// Regime of a sample: whether the whisker touches the pole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WhiskRegime {
    /// The whisker is at rest in the frame of its base.
    Free,
    /// The pole bends the whisker.
    Contact,
    /// The model does not say where the whisker is.
    #[default]
    Undecided,
}

/// Reason why a sample of a course has no state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Undecided {
    /// The whisker detached where neither side holds it, and the resting whisker would cross the pole.
    OnThePole,
    /// The edge of the tip meets the pole: the resting whisker is too short to be touched on this side.
    TipEdge,
    /// No state was found although the push has not ended.
    NotFound,
    /// The contact has stuck where the push should have ended, and the course from there is not known.
    Stuck,
    /// The angle of the base is missing, in a gap after which the course is not known.
    Missing,
    /// The angle of the base is missing, in a gap across which the course continues.
    Bridged,
    /// The angle of the base was missing, and several states are possible since then.
    AfterGap,
}

row! {
    /// Sample of a course: the state of the whisker at one time. Loads are 0 if the whisker is free.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct WhiskSample of a state {
        /// Time of the sample, in s.
        pub time_s: f64,
        /// Angle of the base, in degrees: 0 at first touch on CB, positive pushes CB.
        pub angle_deg: Option<f64>,
        /// Regime: free, contact or undecided.
        pub regime: WhiskRegime,
        /// Side of the whisker that the pole is on in contact: cb (convex) or cf (concave).
        pub side: Option<Side>,
        /// Rotation of the base since the touch, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        pub arc_length_mm: Option<f64> = place,
        /// Position of the contact along the base's tangent at first touch on CB, in mm; the base is at 0.
        pub contact_x_mm: Option<f64>,
        /// Position of the contact to the left of the base's tangent at first touch on CB, in mm.
        pub contact_y_mm: Option<f64>,
        pub contact_angle_deg: Option<f64> = place,
        /// Curvature of the whisker at the arclength of --curvature-at, in 1/mm.
        pub curvature_per_mm: Option<f64>,
        pub force_un: Option<f64> = load,
        pub contact_force_un: Option<f64> = load,
        pub base_force_x_un: Option<f64> = load,
        pub base_force_y_un: Option<f64> = load,
        pub base_moment_nnm: Option<f64> = load,
        pub energy_nj: Option<f64> = load,
        /// Energy that friction has dissipated since the start, in nJ.
        pub dissipated_nj: Option<f64>,
        /// Sliding direction of a contact with friction: tip, base or sticks.
        pub sliding: Option<Sliding>,
        /// Reason of an undecided sample: on-the-pole, tip-edge, not-found, stuck, missing, bridged or after-gap.
        pub reason: Option<Undecided>,
    }
}

/// Kind of an event of a course.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WhiskEventKind {
    /// The whisker touches the pole.
    Touch,
    /// The whisker leaves the pole, unloaded.
    Release,
    /// The whisker slips off the pole at the fold.
    SlipOff,
    /// The whisker is pulled off with its tip at the pole.
    PullOff,
    /// With friction, the contact that stuck snaps toward the base, and stays on the pole.
    Snap,
    /// The model does not say where the whisker is from here on.
    #[default]
    Undecided,
}

impl WhiskEventKind {
    /// Returns true if the whisker detaches: a slip-off or a pull-off.
    #[must_use]
    pub const fn is_detachment(self) -> bool {
        matches!(self, Self::SlipOff | Self::PullOff)
    }
}

row! {
    /// Event of a course, between samples. Its loads and energy belong to the last state before the event, and after a touch to the first
    /// state after it.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct WhiskEvent of a state {
        /// Time of the event, in s, from the straight line between two samples.
        pub time_s: f64,
        /// Kind of the event: touch, release, slip-off, pull-off, snap or undecided.
        pub event: WhiskEventKind,
        pub side: Side,
        /// Angle of the base, in degrees: 0 at first touch on CB, positive pushes CB.
        pub angle_deg: f64,
        /// Rotation of the base since the touch, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        pub force_un: Option<f64> = load,
        pub contact_force_un: Option<f64> = load,
        pub base_moment_nnm: Option<f64> = load,
        /// Bending energy of the whisker, in nJ; it is lost if the whisker detaches.
        pub energy_nj: Option<f64> = load,
        pub snaps_deg: Option<f64>,
    }
}
