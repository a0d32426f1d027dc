//! Whisking: the quasi-static course of a whisker whose base rotates to and fro in front of one pole.
//!
//! The angle of the base is 0 where the resting whisker first touches the pole on the CB side, and grows with the push there. The pole stays:
//! its centre has the same distance from the base on both sides. A whisker that detaches swings to the other side of the pole. On the way
//! back it touches the pole there, on CF. Without friction the state between detachments depends on the angle alone, so that only the side
//! is history. With friction the contact slides or sticks, and its place is history, too. Inertia is left out.

mod contact;
mod course;
mod gaps;
mod legs;
mod options;
pub(crate) mod phase;
mod readings;
mod rows;
mod shapes;
pub(crate) mod states;
mod turns;

pub use course::{AngleCourse, CourseError};
pub use gaps::CourseGap;
pub(crate) use options::CurvaturePoint;
pub use options::{CourseStart, CurvatureAtError, WhiskOptions};
pub(crate) use readings::signed_deg;
pub use rows::{Undecided, WhiskEvent, WhiskEventKind, WhiskRegime, WhiskSample};
pub use shapes::CourseShapes;

use crate::scene::{Pole, Whisker, digits};
use crate::sheet::Row;
use crate::trace::NoState;
use glam::DVec2;
use legs::Legs;
use phase::{Phase, ROUNDING};
use states::{BothSides, SideStates};
use turns::Turns;
use whiskmap_mechanics::rod::{Rest, Side};

/// Course of a whisker in front of one pole.
#[derive(Clone, Debug, PartialEq)]
pub struct Whisk {
    /// Samples of the course, one for each of its times: `[sample]`.
    pub samples: Vec<WhiskSample>,
    /// Events of the course in the order of time: `[event]`.
    pub events: Vec<WhiskEvent>,
    /// Gaps of the course, in which angles of the base are missing, in the order of time: `[gap]`.
    pub gaps: Vec<CourseGap>,
    /// Angle of the base at first touch on CF, in degrees. It differs from 0 with the radius of the pole.
    pub cf_touch_deg: f64,
    /// First angle of the base, in degrees, if it lies beyond first touch, and neither a start nor a gap comes before it: the whisker is then
    /// assumed to be free.
    /// `None` without this assumption.
    pub assumed_free_deg: Option<f64>,
}

impl Whisk {
    /// Returns one line for each of these: the assumption of a free whisker beyond first touch, bridged gaps, other gaps, and samples
    /// without a state. Without any of them, there is no line.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let start = self.assumed_free_deg.map(|angle_deg| {
            format!(
                "the first angle is {} deg, beyond first touch: the whisker is assumed to be free, past the pole; choose the start \
                 `contact` or `free`",
                digits(angle_deg)
            )
        });
        let spans = self.events.iter().filter(|event| event.event == WhiskEventKind::Undecided);
        let undecided =
            self.samples.iter().filter(|sample| sample.regime == WhiskRegime::Undecided);
        let (spans, undecided) = (spans.count(), undecided.count());
        let without = (undecided > 0 || spans > 0).then(|| {
            let all = self.samples.len();
            let begin = match spans {
                0 => String::new(),
                _ => format!("; {spans} such spans begin"),
            };
            format!(
                "{undecided} of {all} samples are undecided, for the reasons in the table{begin}"
            )
        });
        let gaps = gaps::warnings(&self.gaps, &self.samples);
        start.into_iter().chain(gaps).chain(without).collect()
    }

    /// Returns the energy that friction dissipates along the course, in nJ; NaN if a part of the course is undecided.
    #[must_use]
    pub fn dissipated_nj(&self) -> f64 {
        let last = self.samples.last().and_then(|sample| sample.dissipated_nj);
        last.unwrap_or(f64::NAN)
    }

    /// Returns the energy that the detachments of the course lose, in nJ. A detachment loses the energy of the last state before it, less
    /// the energy of a state on the other side that follows at once. The result is NaN if one of these energies is not known, as of an undecided state,
    /// and after a gap that is not bridged.
    #[must_use]
    pub fn lost_nj(&self) -> f64 {
        if self.gaps.iter().any(|gap| !gap.is_bridged) {
            return f64::NAN;
        }
        let mut events = self.events.iter().peekable();
        let mut lost = 0.0;
        while let Some(event) = events.next() {
            if event.event.is_detachment() {
                let next = events.peek();
                let simultaneous = next.filter(|next| next.angle_deg == event.angle_deg);
                let after = match simultaneous {
                    None => Some(0.0),
                    Some(next) => next.energy_nj.filter(|_| next.event == WhiskEventKind::Touch),
                };
                lost += event.energy_nj.unwrap_or(f64::NAN) - after.unwrap_or(f64::NAN);
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
         whisker touches the pole from its other side; choose the start `contact` for a course that begins in contact"
    )]
    Begin {
        /// First angle of the course, in degrees.
        angle_deg: f64,
        /// Angle of the base at first touch on CF, in degrees.
        cf_touch_deg: f64,
    },
    /// The course should begin in contact, but no side holds the whisker at the first angle.
    #[error(
        "cannot begin in contact: the first angle is {angle_deg} deg; pushes on CB end at {cb_end_deg:.6} deg{}",
        .cf_end_deg.map_or_else(String::new, |end| format!(", and on CF at {end:.6} deg"))
    )]
    NotHeld {
        /// First angle of the course, in degrees.
        angle_deg: f64,
        /// Angle of the base at which a push on CB ends, in degrees.
        cb_end_deg: f64,
        /// Angle of the base at which a push on CF ends, in degrees; `None` if the resting whisker does not reach the pole there.
        cf_end_deg: Option<f64>,
    },
    /// The curvature should be taken at a place that the whisker does not have.
    #[error(transparent)]
    CurvatureAt(#[from] CurvatureAtError),
    /// The end of the push, or with friction a limit of sliding up to it, was not found on this side.
    #[error("the states up to the detachment on {0} were not found")]
    Unresolved(Side),
    /// The course was cancelled by [`WhiskOptions::cancel`].
    #[error("cancelled")]
    Cancelled,
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
/// If the resting whisker does not reach the pole, the course begins in contact, or a detachment is not found.
pub fn whisk(
    whisker: &Whisker,
    pole: &Pole,
    distance_mm: f64,
    course: &AngleCourse,
) -> Result<Whisk, WhiskError> {
    whisk_with(whisker, pole, distance_mm, course, &WhiskOptions::default())
}

/// Computes the course as [`whisk`] does, with a start and a flag that cancels.
///
/// # Errors
/// Fails as [`whisk`] does. Also fails if the course should begin in contact, but no side holds the whisker. Also fails if the curvature
/// should be taken beyond the whisker, or if the computation is cancelled.
pub fn whisk_with(
    whisker: &Whisker,
    pole: &Pole,
    distance_mm: f64,
    course: &AngleCourse,
    options: &WhiskOptions,
) -> Result<Whisk, WhiskError> {
    let point = CurvaturePoint::of(whisker, options.curvature_at_mm)?;
    let front = Front::new(whisker, pole, distance_mm)?;
    let gaps = course.gaps(options.bridge_s);
    let legs = front.follow(course, &gaps, options)?;
    let (mut samples, events) = front.states(&legs, point, options)?;
    let known = course.known();
    for (&i, sample) in known.iter().zip(&mut samples) {
        let (time_s, angle_deg) = (course.times_s[i], course.angles_deg[i]);
        *sample = sample.at(time_s, angle_deg, (front.pole_mm, pole.radius_mm));
    }
    samples.extend(gaps.iter().flat_map(|gap| gap.samples(&course.times_s)));
    samples.sort_by(|one, other| one.time_s.total_cmp(&other.time_s));
    let first = course.angles_deg[known[0]];
    let is_assumed = options.start.is_none() && !begins_in_gap(&known, options);
    Ok(Whisk {
        samples,
        events,
        gaps,
        cf_touch_deg: front.turns.cf_touch.to_degrees(),
        assumed_free_deg: (is_assumed && first.to_radians() > ROUNDING).then_some(first),
    })
}

/// A whisker in front of its pole.
struct Front<'a> {
    whisker: &'a Whisker,
    sides: BothSides,
    turns: Turns,
    /// Centre of the pole in mm, in the axes of first touch on CB.
    pole_mm: DVec2,
}

impl<'a> Front<'a> {
    fn new(whisker: &'a Whisker, pole: &Pole, distance_mm: f64) -> Result<Self, WhiskError> {
        let length_mm = whisker.length_mm;
        let rests = [Side::Cb, Side::Cf].map(|side| Rest::new(&whisker.rod(pole, side)));
        let cb = Row::new(&rests[0], distance_mm / length_mm);
        if !cb.is_reached() {
            let reach_mm = rests[0].reach() * length_mm;
            return Err(NoState::OutOfReach { reach_mm }.into());
        }
        let cf_distance = rests[1].distance_of_pole(cb.pole_distance);
        let cf = Row::new(&rests[1], cf_distance);
        let states = |side, distance_mm| {
            let states = SideStates::new(whisker, pole, side, &[distance_mm]);
            states.map_err(|_| WhiskError::Unresolved(side))
        };
        let cb_states = states(Side::Cb, distance_mm)?;
        let cf_states = match cf.is_reached() {
            true => Some(states(Side::Cf, cf_distance * length_mm)?),
            false => None,
        };
        let turns = Turns {
            cf_touch: cf.touch - cb.touch,
            cb_end: cb_states.end(0),
            cf_end: cf_states.as_ref().map(|states| states.end(0)),
        };
        Ok(Self {
            whisker,
            sides: BothSides { cb: Some(cb_states), cf: cf_states },
            turns,
            pole_mm: DVec2::from_angle(cb.touch) * (cb.pole_distance * length_mm),
        })
    }

    /// Moves the base along `course` from one known angle to the next.
    fn follow(
        &self,
        course: &AngleCourse,
        gaps: &[CourseGap],
        options: &WhiskOptions,
    ) -> Result<Legs<'_>, WhiskError> {
        let known = course.known();
        let first = course.angles_deg[known[0]];
        let (angle, time_s) = (first.to_radians(), course.times_s[known[0]]);
        let mut legs = Legs::new(&self.turns, &self.sides);
        match begins_in_gap(&known, options) {
            true => legs.resume(angle, time_s),
            false => legs.first(begin(&self.turns, first, options.start)?, angle, time_s),
        }
        let is_open = |end: usize| gaps.iter().any(|gap| !gap.is_bridged && gap.end == Some(end));
        for pair in known.windows(2) {
            if options.is_cancelled() {
                return Err(WhiskError::Cancelled);
            }
            let ends = [pair[0], pair[1]];
            let angles = ends.map(|i| course.angles_deg[i].to_radians());
            let times = ends.map(|i| course.times_s[i]);
            match is_open(ends[1]) {
                true => legs.resume(angles[1], times[1]),
                false => legs.leg(angles, times),
            }
        }
        Ok(legs)
    }

    /// Computes the samples and the events of `legs` with their states. Times and angles of samples are missing.
    fn states(
        &self,
        legs: &Legs,
        point: Option<CurvaturePoint>,
        options: &WhiskOptions,
    ) -> Result<(Vec<WhiskSample>, Vec<WhiskEvent>), WhiskError> {
        let unit_nj = self.whisker.units().moment_nnm;
        let mut samples = Vec::with_capacity(legs.samples.len());
        for chunk in legs.samples.chunks(STATES_AT_ONCE) {
            if options.is_cancelled() {
                return Err(WhiskError::Cancelled);
            }
            samples.extend(self.sides.samples(chunk, point, unit_nj));
        }
        let mut events = Vec::with_capacity(legs.events.len());
        for chunk in legs.events.chunks(STATES_AT_ONCE) {
            if options.is_cancelled() {
                return Err(WhiskError::Cancelled);
            }
            events.extend(self.sides.events(chunk));
        }
        Ok((samples, events))
    }
}

/// Number of states that are computed between two looks at the flag that cancels.
pub(crate) const STATES_AT_ONCE: usize = 1 << 10;

/// Returns true if the phase at the first of the `known` angles is unknown: angles before it are missing, and no start is given.
fn begins_in_gap(known: &[usize], options: &WhiskOptions) -> bool {
    known[0] > 0 && options.start.is_none()
}

/// Returns the phase in which a course begins at the angle `first_deg`, in degrees.
fn begin(turns: &Turns, first_deg: f64, start: Option<CourseStart>) -> Result<Phase, WhiskError> {
    let first = first_deg.to_radians();
    match start {
        Some(CourseStart::Contact) => turns.held(first).next().ok_or_else(|| WhiskError::NotHeld {
            angle_deg: first_deg,
            cb_end_deg: turns.cb_end.push.to_degrees(),
            cf_end_deg: turns.cf_end.map(|end| (turns.cf_touch - end.push).to_degrees()),
        }),
        _ => turns.begin(first).ok_or(WhiskError::Begin {
            angle_deg: first_deg,
            cf_touch_deg: turns.cf_touch.to_degrees(),
        }),
    }
}
