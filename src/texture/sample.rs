//! Samples and events of a course behind a surface.

use super::tip::{TipFrame, TipPlace};
use crate::rod::Side;
use crate::shooting::Reading;
use crate::trace::row;
use crate::whisk::phase::{Passage, Phase};
use crate::whisk::{AngleCourse, Undecided, WhiskEventKind, signed_deg};
use serde::Serialize;

/// Phase of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TexturePhase {
    /// The same asperity has bent the whisker since the sample before, or since a touch after it.
    Stuck,
    /// The whisker has detached from an asperity since the sample before.
    Slipping,
    /// The whisker is at rest in the frame of its base.
    Free,
    /// The model does not determine where the whisker is.
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
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct TextureSample {
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
        /// Arclength from the base to the contact, in mm.
        pub arc_length_mm: Option<f64>,
        /// Position of the tip along the surface, in mm from the point nearest to the base.
        pub tip_x_mm: Option<f64>,
        /// Height of the tip beyond the line of the asperities, in mm.
        pub tip_height_mm: Option<f64>,
        /// Size of the force between asperity and whisker, normal to both, in uN.
        pub force_un: Option<f64>,
        /// Force that the asperity puts on the base, along the base's tangent, in uN.
        pub base_force_x_un: Option<f64>,
        /// Force that the asperity puts on the base, to the left of its tangent, in uN.
        pub base_force_y_un: Option<f64>,
        /// Moment of the asperity on the base, in nN m: positive turns it to the left.
        pub base_moment_nnm: Option<f64>,
        /// Bending energy of the whisker, in nJ.
        pub energy_nj: Option<f64>,
        /// Reason of an undecided sample: on-an-asperity, tip-edge, not-found or crosses-surface.
        pub reason: Option<NoTextureState>,
    }
}

row! {
    /// Event of a course behind a rough surface, between samples. Its state is the last one before it, and the first one after a touch.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct TextureEvent {
        /// Time of the event, in s, from the straight line between two samples.
        pub time_s: f64,
        /// Kind of the event: touch, release, slip-off, pull-off or undecided.
        pub event: WhiskEventKind,
        /// Number of the asperity, from 0 at the lower end of the surface.
        pub asperity: Option<usize>,
        /// Side of the whisker that the asperity is on: cb (convex) or cf (concave).
        pub side: Side,
        /// Angle of the base, in degrees.
        pub angle_deg: f64,
        /// Rotation of the base since the whisker at rest would touch this asperity, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        /// Position of the tip along the surface, in mm from the point nearest to the base.
        pub tip_x_mm: Option<f64>,
        /// Size of the force between asperity and whisker, normal to both, in uN.
        pub force_un: Option<f64>,
        /// Moment of the asperity on the base, in nN m: positive turns it to the left.
        pub base_moment_nnm: Option<f64>,
        /// Bending energy of the whisker, in nJ.
        pub energy_nj: Option<f64>,
        /// Energy that a detachment loses, in nJ: that before it less that of the contact which follows at once.
        pub lost_nj: Option<f64>,
    }
}

/// State in contact with an asperity.
#[derive(Clone, Copy)]
pub(super) struct Held {
    /// Number of the asperity on its surface.
    pub asperity: usize,
    pub side: Side,
    /// Push in radians, as a magnitude.
    pub push: f64,
    /// Loads, and place of the tip; `None` where no state was found.
    pub state: Option<(Reading, TipPlace)>,
}

impl Held {
    fn value(&self, of: fn(&Reading) -> f64) -> Option<f64> {
        self.state.as_ref().map(|(reading, _)| of(reading))
    }
}

/// First state in which the whisker meets the surface in two places. Other asperities would bend it there, too.
#[derive(Clone, Copy)]
pub(super) struct Crossing {
    time_s: f64,
    angle: f64,
    held: Held,
}

impl Crossing {
    /// Returns the first crossing among states, each at its `[time in s, angle in radians]`.
    pub fn first<'a>(
        states: impl Iterator<Item = (&'a Option<Held>, &'a [f64; 2])>,
    ) -> Option<Self> {
        let crossing = |(held, [time_s, angle]): (&Option<Held>, &[f64; 2])| {
            let held = held.filter(|own| own.state.is_some_and(|(_, tip)| tip.crosses))?;
            Some(Self {
                time_s: *time_s,
                angle: *angle,
                held,
            })
        };
        let crossings = states.filter_map(crossing);
        crossings.min_by(|one, other| one.time_s.total_cmp(&other.time_s))
    }
}

/// Returns the samples of a course; all from the first crossing on are undecided.
pub(super) fn samples(
    course: &AngleCourse,
    phases: &[Phase],
    passages: &[Passage],
    held: &[Option<Held>],
    tips: &TipFrame,
    crossed: Option<Crossing>,
) -> Vec<TextureSample> {
    let mut passages = passages.iter().peekable();
    let times = course.times_s().iter().zip(course.angles_deg());
    let states = times.zip(phases.iter().zip(held));
    let samples = states.map(|((&time_s, &angle_deg), (phase, held))| {
        let mut has_slipped = false;
        while let Some(passage) = passages.next_if(|passage| passage.time_s <= time_s) {
            has_slipped |= passage.event.is_none();
        }
        let crosses = crossed.is_some_and(|own| own.time_s <= time_s);
        let reason = match phase {
            _ if crosses => Some(NoTextureState::CrossesSurface),
            Phase::Undecided { reason, .. } => Some(match reason {
                Undecided::OnThePole => NoTextureState::OnAnAsperity,
                Undecided::TipEdge => NoTextureState::TipEdge,
                Undecided::NotFound => NoTextureState::NotFound,
            }),
            Phase::Contact { .. } if held.is_none_or(|own| own.state.is_none()) => {
                Some(NoTextureState::NotFound)
            }
            _ => None,
        };
        let held = held.filter(|_| !crosses);
        let is_free = reason.is_none() && held.is_none();
        let load = |of: fn(&Reading) -> f64| match is_free {
            true => Some(0.0),
            false => held.and_then(|own| own.value(of)),
        };
        let tip = match is_free {
            true => Some(tips.free(angle_deg.to_radians())),
            false => held.and_then(|own| own.state).map(|(_, tip)| tip),
        };
        TextureSample {
            time_s,
            angle_deg,
            phase: match reason {
                Some(_) => TexturePhase::Undecided,
                None if has_slipped => TexturePhase::Slipping,
                None if is_free => TexturePhase::Free,
                None => TexturePhase::Stuck,
            },
            asperity: held.map(|own| own.asperity),
            side: held.map(|own| own.side),
            push_angle_deg: held.map(|own| signed_deg(own.side, own.push)),
            arc_length_mm: held.and_then(|own| own.value(|state| state.arc_length_mm)),
            tip_x_mm: tip.map(|tip| tip.x_mm),
            tip_height_mm: tip.map(|tip| tip.height_mm),
            force_un: load(|state| state.force_un),
            base_force_x_un: load(|state| state.base_force_un.x),
            base_force_y_un: load(|state| state.base_force_un.y),
            base_moment_nnm: load(|state| state.base_moment_nnm),
            energy_nj: load(|state| state.energy_nj),
            reason,
        }
    });
    samples.collect()
}

/// Returns the events of a course, up to the first crossing.
pub(super) fn events(
    passages: &[Passage],
    kinds: &[WhiskEventKind],
    held: &[Option<Held>],
    crossed: Option<Crossing>,
) -> Vec<TextureEvent> {
    let energy = |i: usize| held[i].and_then(|own| own.value(|state| state.energy_nj));
    let is_before = |time_s: f64| crossed.is_none_or(|own| time_s < own.time_s);
    let before = (0..passages.len()).take_while(|i| is_before(passages[*i].time_s));
    let events = before.map(|i| {
        let (passage, event) = (&passages[i], kinds[i]);
        let is_detachment = matches!(event, WhiskEventKind::SlipOff | WhiskEventKind::PullOff);
        let next = passages.get(i + 1).filter(|next| {
            next.angle == passage.angle && next.event == Some(WhiskEventKind::Touch)
        });
        let after = match next {
            Some(_) => energy(i + 1),
            None => Some(0.0),
        };
        let lost = energy(i).zip(after).map(|(before, after)| before - after);
        TextureEvent {
            lost_nj: lost.filter(|_| is_detachment),
            ..TextureEvent::new(
                event,
                [passage.time_s, passage.angle],
                passage.side,
                held[i],
            )
        }
    });
    let end = crossed.map(|own| {
        let moment = [own.time_s, own.angle];
        TextureEvent::new(
            WhiskEventKind::Undecided,
            moment,
            own.held.side,
            Some(own.held),
        )
    });
    events.chain(end).collect()
}

impl TextureEvent {
    /// Creates an event at `[time in s, angle in radians]` that loses no energy.
    fn new(
        event: WhiskEventKind,
        [time_s, angle]: [f64; 2],
        side: Side,
        held: Option<Held>,
    ) -> Self {
        let value = |of: fn(&Reading) -> f64| held.and_then(|own| own.value(of));
        let tip = held.and_then(|own| own.state).map(|(_, tip)| tip);
        Self {
            time_s,
            event,
            asperity: held.map(|own| own.asperity),
            side,
            angle_deg: angle.to_degrees(),
            push_angle_deg: held.map(|own| signed_deg(own.side, own.push)),
            tip_x_mm: tip.map(|tip| tip.x_mm),
            force_un: value(|state| state.force_un),
            base_moment_nnm: value(|state| state.base_moment_nnm),
            energy_nj: value(|state| state.energy_nj),
            lost_nj: None,
        }
    }
}
