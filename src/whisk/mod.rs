//! Whisking: the quasi-static course of a whisker whose base rotates to and fro in front of one pole.
//!
//! The angle of the base is 0 where the resting whisker first touches the pole on the CB side, and grows with the push there. The pole stays:
//! its centre has the same distance from the base on both sides. A whisker that detaches swings to the other side of the pole. On the way
//! back it touches the pole there, on CF. Between detachments the state depends on the angle alone, so that only the side is history.
//! Inertia is left out.

mod course;
pub(crate) mod phase;
pub(crate) mod states;
mod turns;

pub use course::{AngleCourse, CourseError};

use crate::rod::{Rest, Side};
use crate::scene::{Pole, Whisker};
use crate::sheet::Row;
use crate::shooting::Reading;
use crate::trace::{NoState, row};
use phase::{Obstacles, Passage, Phase};
use serde::Serialize;
use states::{BothSides, RowPush, SideStates};
use turns::Turns;

/// Regime of a sample: whether the whisker touches the pole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WhiskRegime {
    /// The whisker is at rest in the frame of its base.
    Free,
    /// The pole bends the whisker.
    Contact,
    /// The model does not say where the whisker is.
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
}

row! {
    /// Sample of a course: the state of the whisker at one time. Loads are 0 if the whisker is free.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct WhiskSample {
        /// Time of the sample, in s.
        pub time_s: f64,
        /// Angle of the base, in degrees: 0 at first touch on CB, positive pushes CB.
        pub angle_deg: f64,
        /// Regime: free, contact or undecided.
        pub regime: WhiskRegime,
        /// Side of the whisker that the pole is on in contact: cb (convex) or cf (concave).
        pub side: Option<Side>,
        /// Rotation of the base since the touch, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        /// Arclength from the base to the contact, in mm.
        pub arc_length_mm: Option<f64>,
        /// Angle of the tangent at the contact, from the base's tangent, in degrees.
        pub contact_angle_deg: Option<f64>,
        /// Size of the force between pole and whisker, normal to both, in uN.
        pub force_un: Option<f64>,
        /// Force that the pole puts on the base, along the base's tangent, in uN.
        pub base_force_x_un: Option<f64>,
        /// Force that the pole puts on the base, to the left of its tangent, in uN.
        pub base_force_y_un: Option<f64>,
        /// Moment of the pole on the base, in nN m: positive turns it to the left.
        pub base_moment_nnm: Option<f64>,
        /// Bending energy of the whisker, in nJ.
        pub energy_nj: Option<f64>,
        /// Reason of an undecided sample: on-the-pole, tip-edge or not-found.
        pub reason: Option<Undecided>,
    }
}

/// Kind of an event of a course.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
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
    /// The model does not say where the whisker is from here on.
    Undecided,
}

row! {
    /// Event of a course, between samples. Its loads and energy are those of the last state before it, and of the first one after a touch.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct WhiskEvent {
        /// Time of the event, in s, from the straight line between two samples.
        pub time_s: f64,
        /// Kind of the event: touch, release, slip-off, pull-off or undecided.
        pub event: WhiskEventKind,
        /// Side of the whisker that the pole is on: cb (convex) or cf (concave).
        pub side: Side,
        /// Angle of the base, in degrees.
        pub angle_deg: f64,
        /// Rotation of the base since the touch, in degrees: positive CB, negative CF.
        pub push_angle_deg: Option<f64>,
        /// Size of the force between pole and whisker, normal to both, in uN.
        pub force_un: Option<f64>,
        /// Moment of the pole on the base, in nN m: positive turns it to the left.
        pub base_moment_nnm: Option<f64>,
        /// Bending energy of the whisker, in nJ; it is lost if the whisker detaches.
        pub energy_nj: Option<f64>,
    }
}

/// Course of a whisker in front of one pole.
#[derive(Clone, Debug, PartialEq)]
pub struct Whisk {
    /// Samples of the course, one for each of its times.
    pub samples: Vec<WhiskSample>,
    /// Events of the course in the order of time.
    pub events: Vec<WhiskEvent>,
    /// Angle of the base at first touch on CF, in degrees. It differs from 0 with the radius of the pole.
    pub cf_touch_deg: f64,
}

impl Whisk {
    /// Returns the energy that the detachments of the course lose, in nJ: that of the last states before them, without that of a state
    /// on the other side that follows at once.
    #[must_use]
    pub fn lost_nj(&self) -> f64 {
        let mut events = self.events.iter().peekable();
        let mut lost = 0.0;
        while let Some(event) = events.next() {
            if matches!(
                event.event,
                WhiskEventKind::SlipOff | WhiskEventKind::PullOff
            ) {
                let held = events
                    .peek()
                    .filter(|next| next.angle_deg == event.angle_deg);
                let held = held.filter(|next| next.event == WhiskEventKind::Touch);
                let held = held.and_then(|next| next.energy_nj);
                lost += event.energy_nj.unwrap_or(f64::NAN) - held.unwrap_or_default();
            }
        }
        lost
    }
}

/// Error of a course that cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WhiskError {
    /// The resting whisker does not reach the pole on CB.
    #[error(transparent)]
    Pole(#[from] NoState),
    /// The course begins in contact, where the state depends on what was before.
    #[error(
        "begins in contact: the first angle is {angle_deg} deg; must be at most 0 deg, or at least {cf_touch_deg:.6} deg, where the \
         whisker touches the pole from its other side"
    )]
    Begin {
        /// First angle of the course, in degrees.
        angle_deg: f64,
        /// Angle of the base at first touch on CF, in degrees.
        cf_touch_deg: f64,
    },
    /// With friction, the force depends on the whole course.
    #[error(
        "contact.friction = {0}: must be 0, because the force of a contact that sticks depends on the course"
    )]
    Friction(f64),
    /// The end of the push was not found on this side.
    #[error("the detachment on {0:?} was not found")]
    Unresolved(Side),
}

/// Computes the course of `whisker` in front of `pole`, which first touches it at `distance_mm` from the base on CB.
///
/// ```
/// use whiskmap::scene::Scene;
/// use whiskmap::whisk::{AngleCourse, WhiskEventKind, whisk};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let course = AngleCourse::sine(20.0, 10.0, 0.1, 1000.0)?;
/// let found = whisk(&cone.whisker, &cone.pole, 15.66, &course)?;
/// assert_eq!(found.events[1].event, WhiskEventKind::SlipOff);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the resting whisker does not reach the pole, the course begins in contact, the contact has friction, or a detachment is not found.
pub fn whisk(
    whisker: &Whisker,
    pole: &Pole,
    distance_mm: f64,
    course: &AngleCourse,
) -> Result<Whisk, WhiskError> {
    let rods = [Side::Cb, Side::Cf].map(|side| whisker.rod(pole, side));
    if rods[0].friction != 0.0 {
        return Err(WhiskError::Friction(rods[0].friction));
    }
    let rests = rods.each_ref().map(Rest::new);
    let cb = Row::new(&rests[0], distance_mm / whisker.length_mm);
    if !cb.is_reached() {
        let (tip, _) = rests[0].at_arclength(1.0);
        let reach_mm = tip.length() * whisker.length_mm;
        return Err(NoState::OutOfReach { reach_mm }.into());
    }
    let cf_distance = rests[1].distance_of_pole(cb.pole_distance);
    let cf = Row::new(&rests[1], cf_distance);
    let cb_states = SideStates::new(whisker, pole, Side::Cb, vec![distance_mm]);
    let cb_states = cb_states.map_err(|_| WhiskError::Unresolved(Side::Cb))?;
    let cf_states = match cf.is_reached() {
        true => {
            let distances = vec![cf_distance * whisker.length_mm];
            let states = SideStates::new(whisker, pole, Side::Cf, distances);
            Some(states.map_err(|_| WhiskError::Unresolved(Side::Cf))?)
        }
        false => None,
    };
    let turns = Turns {
        cf_touch: cf.touch - cb.touch,
        cb_end: cb_states.end(0),
        cf_end: cf_states.as_ref().map(|states| states.end(0)),
    };
    let first = course.angles_deg[0];
    let begin = turns.begin(first.to_radians()).ok_or(WhiskError::Begin {
        angle_deg: first,
        cf_touch_deg: turns.cf_touch.to_degrees(),
    })?;
    let (phases, passages) = turns.follow(begin, course);
    let found = BothSides {
        cb: Some(cb_states),
        cf: cf_states,
    };
    let angles = course.angles_deg.iter().map(|deg| deg.to_radians());
    let contacts = phases.iter().zip(angles).map(|(phase, angle)| match phase {
        Phase::Contact { side, obstacle } => {
            Some((*side, (0, turns.push(*side, *obstacle, angle).max(0.0))))
        }
        _ => None,
    });
    let contacts: Vec<Contact> = contacts.collect();
    let readings = found.readings(&contacts);
    let times = course.times_s.iter().zip(&course.angles_deg);
    let states = phases.iter().zip(contacts.iter().zip(readings));
    let samples = times.zip(states);
    let samples = samples.map(|((time_s, angle_deg), (phase, (contact, reading)))| {
        sample([*time_s, *angle_deg], *phase, *contact, reading)
    });
    Ok(Whisk {
        samples: samples.collect(),
        events: events(&found, &passages),
        cf_touch_deg: turns.cf_touch.to_degrees(),
    })
}

/// Side, row and push in radians, as a magnitude, of a state in contact; `None` without contact.
type Contact = Option<(Side, RowPush)>;

/// Returns a push in degrees with the sign of its side; 0 without one.
pub(crate) fn signed_deg(side: Side, push: f64) -> f64 {
    side.sign() * push.to_degrees() + 0.0
}

/// Returns the events at the `passages`.
fn events(found: &BothSides, passages: &[Passage]) -> Vec<WhiskEvent> {
    let contact = |passage: &Passage| {
        let push = Some(passage.push).filter(|push| !push.is_nan());
        push.map(|push| (passage.side, (0, push)))
    };
    let contacts: Vec<Contact> = passages.iter().map(contact).collect();
    let readings = found.readings(&contacts);
    let events = passages.iter().zip(contacts.iter().zip(readings));
    let events = events.map(|(passage, (contact, reading))| WhiskEvent {
        time_s: passage.time_s,
        event: passage
            .event
            .unwrap_or_else(|| found.detachment(passage.side, 0)),
        side: passage.side,
        angle_deg: passage.angle.to_degrees(),
        push_angle_deg: contact.map(|(side, (_, push))| signed_deg(side, push)),
        force_un: reading.map(|state| state.force_un),
        base_moment_nnm: reading.map(|state| state.base_moment_nnm),
        energy_nj: reading.map(|state| state.energy_nj),
    });
    events.collect()
}

/// Returns the sample at `[time in s, angle in degrees]`.
fn sample(
    [time_s, angle_deg]: [f64; 2],
    phase: Phase,
    contact: Contact,
    reading: Option<Reading>,
) -> WhiskSample {
    let reason = match phase {
        Phase::Undecided { reason, .. } => Some(reason),
        Phase::Contact { .. } if reading.is_none() => Some(Undecided::NotFound),
        _ => None,
    };
    let load = |of: fn(&Reading) -> f64| match phase {
        Phase::Free { .. } => Some(0.0),
        _ => reading.as_ref().map(of),
    };
    WhiskSample {
        time_s,
        angle_deg,
        regime: match (phase, reason) {
            (_, Some(_)) => WhiskRegime::Undecided,
            (Phase::Free { .. }, _) => WhiskRegime::Free,
            _ => WhiskRegime::Contact,
        },
        side: contact.map(|(side, _)| side),
        push_angle_deg: contact.map(|(side, (_, push))| signed_deg(side, push)),
        arc_length_mm: reading.map(|state| state.arc_length_mm),
        contact_angle_deg: reading.map(|state| state.contact_angle_deg),
        force_un: load(|state| state.force_un),
        base_force_x_un: load(|state| state.base_force_un.x),
        base_force_y_un: load(|state| state.base_force_un.y),
        base_moment_nnm: load(|state| state.base_moment_nnm),
        energy_nj: load(|state| state.energy_nj),
        reason,
    }
}
