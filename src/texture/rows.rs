//! Rows of the tables of courses behind surfaces.

use crate::trace::row;
use crate::whisk::WhiskEventKind;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

/// Phase of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TexturePhase {
    /// An asperity bends the whisker, which has not detached since the sample before.
    Stuck,
    /// The whisker has detached from an asperity since the sample before.
    Slipping,
    /// The whisker is at rest in the frame of its base.
    Free,
    /// The model does not determine where the whisker is.
    #[default]
    Undecided,
}

/// Reason why a sample has no state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoTextureState {
    /// The whisker detached where no asperity holds it, and the resting whisker would cross one.
    OnAnAsperity,
    /// The edge of the tip meets an asperity: the resting whisker is too short to be touched on this side.
    TipEdge,
    /// No state was found although the push has not ended.
    NotFound,
    /// The whisker has met the surface in two places, where more than one asperity would bend it.
    CrossesSurface,
}

row! {
    /// Sample of a course behind a rough surface. Loads are 0 if the whisker is free.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct TextureSample of a state {
        /// Time of the sample, in s.
        pub time_s: f64,
        /// Angle of the base, in degrees: 0 with the resting chord normal to the surface, growing along it.
        pub angle_deg: f64,
        /// Phase: stuck, slipping (detached since the sample before), free or undecided.
        pub phase: TexturePhase,
        /// Number of the asperity that bends the whisker, from 0 at the lower end of the surface.
        pub asperity: Option<usize>,
        /// Side of the whisker that the asperity is on: cb (convex) or cf (concave).
        pub side: Option<Side>,
        /// Rotation of the base since the whisker at rest would touch this asperity, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        pub arc_length_mm: Option<f64> = place,
        /// Position of the contact along the surface, in mm from the point nearest to the base.
        pub contact_x_mm: Option<f64>,
        /// Position of the contact toward the surface, in mm from the base.
        pub contact_y_mm: Option<f64>,
        /// Curvature of the whisker at the arclength of --curvature-at, in 1/mm.
        pub curvature_per_mm: Option<f64>,
        /// Position of the tip along the surface, in mm from the point nearest to the base.
        pub tip_x_mm: Option<f64>,
        /// Height of the tip beyond the line of the asperities, in mm.
        pub tip_height_mm: Option<f64>,
        /// Size of the force between asperity and whisker, normal to both, in uN.
        pub force_un: Option<f64> = load,
        /// Force that the asperity puts on the base, along the base's tangent, in uN.
        pub base_force_x_un: Option<f64> = load,
        /// Force that the asperity puts on the base, to the left of its tangent, in uN.
        pub base_force_y_un: Option<f64> = load,
        /// Moment of the asperity on the base, in nN m: positive turns it to the left.
        pub base_moment_nnm: Option<f64> = load,
        pub energy_nj: Option<f64> = load,
        /// Reason of an undecided sample: on-an-asperity, tip-edge, not-found or crosses-surface.
        pub reason: Option<NoTextureState>,
    }
}

row! {
    /// Event of a course behind a rough surface, between samples. Its state is the last one before it, and the first one after a touch.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct TextureEvent of a state {
        /// Time of the event, in s, from the straight line between two samples.
        pub time_s: f64,
        /// Kind of the event: touch, release, slip-off, pull-off or undecided.
        pub event: WhiskEventKind,
        /// Number of the asperity, from 0 at the lower end of the surface.
        pub asperity: Option<usize>,
        /// Side of the whisker that the asperity is on: cb (convex) or cf (concave).
        pub side: Side,
        /// Angle of the base, in degrees: 0 with the resting chord normal to the surface, growing along it.
        pub angle_deg: f64,
        /// Rotation of the base since the whisker at rest would touch this asperity, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        /// Position of the tip along the surface, in mm from the point nearest to the base.
        pub tip_x_mm: Option<f64>,
        /// Size of the force between asperity and whisker, normal to both, in uN.
        pub force_un: Option<f64> = load,
        /// Moment of the asperity on the base, in nN m: positive turns it to the left.
        pub base_moment_nnm: Option<f64> = load,
        pub energy_nj: Option<f64> = load,
        /// Energy that a detachment loses, in nJ: that before it less that of the contact which follows at once.
        pub lost_nj: Option<f64>,
    }
}
