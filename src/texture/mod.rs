//! Texture: the quasi-static course of a whisker whose base sweeps to and fro behind a rough surface (the paper's Fig. 6).
//!
//! The paper has no model for this. Here, the surface is a row of small poles, its asperities, on a line. The whisker touches one of them
//! at a time, without friction and inertia, and passes between them. A detachment frees it. It comes to rest against the first asperity
//! ahead that its stable states can lie on at this angle of the base, else it is free. Against one pole, the limit of a single
//! asperity, the states equal the states of [`crate::whisk`].
//!
//! Positions are `[x, y]` in mm: the base is at the origin, and the line of the asperities is at `y = distance`. The angle of the base is 0
//! where the chord of the resting whisker is normal to that line. It grows toward `x`, and pushes CB then.

mod asperities;
mod event;
mod rows;
mod sample;
mod shape;
mod stays;
mod tip;

pub use rows::{NoTextureState, TextureEvent, TexturePhase, TextureSample};
pub use shape::shape;
pub use stays::{AsperityStay, TipBin, histogram};

use crate::friction;
use crate::scene::{SceneError, Surface, Whisker};
use crate::whisk::phase::{Obstacles, Phase};
use crate::whisk::states::{BothSides, PushedContact};
use crate::whisk::{AngleCourse, CurvatureAtError, CurvaturePoint, STATES_AT_ONCE};
use asperities::Asperities;
use rayon::prelude::*;
use sample::{Held, SurfaceCrossing};
use std::sync::atomic::{AtomicBool, Ordering};
use tip::TipFrame;
use whiskmap_mechanics::rod::Side;

/// Course of a whisker behind a rough surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Samples of the course, one for each of its times: `[sample]`.
    pub samples: Vec<TextureSample>,
    /// Events of the course in the order of time: `[event]`.
    pub events: Vec<TextureEvent>,
    /// Number of asperities within reach of the resting whisker.
    pub reached: usize,
}

/// Error of a course that cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A number of the rough surface is out of its range.
    #[error(transparent)]
    Surface(#[from] SceneError),
    /// The base turns away from the surface, or its angle is missing.
    #[error(
        "angle_deg[{index}] = {angle_deg}: must be between -90 and 90 deg from the normal of the surface, and none may be missing"
    )]
    Angle {
        /// Index of the sample whose angle is out of range.
        index: usize,
        /// Angle of the sample, in degrees.
        angle_deg: f64,
    },
    /// The resting whisker does not fit between two asperities.
    #[error(
        "the resting whisker does not fit between asperity {} at {} mm and asperity {} at {} mm; must have a larger spacing_um, or a smaller \
         asperity_radius_um or jitter", .asperities[0], .x_mm[0], .asperities[1], .x_mm[1]
    )]
    Blocked {
        /// Numbers of the two asperities on the surface, from its lower end: `[lower, upper]`.
        asperities: [usize; 2],
        /// Positions of the two asperities along the surface, in mm: `[lower, upper]`.
        x_mm: [f64; 2],
    },
    /// The resting whisker would cross an asperity at the first angle.
    #[error(
        "begins in contact: at the first angle of {angle_deg} deg the resting whisker meets asperity {asperity}; must be at most {:.6} \
         deg or at least {:.6} deg", .touches_deg[0], .touches_deg[1]
    )]
    Begin {
        /// First angle of the course, in degrees.
        angle_deg: f64,
        /// Number of the asperity on its surface.
        asperity: usize,
        /// Angles of the base at which the resting whisker touches the asperity, in degrees: `[CB, CF]`.
        touches_deg: [f64; 2],
    },
    /// The end of the push against an asperity was not found on this side.
    #[error("the detachment from asperity {asperity} on {side} was not found")]
    Unresolved {
        /// Number of the asperity on its surface.
        asperity: usize,
        /// Side of the whisker that the asperity is on.
        side: Side,
    },
    /// The curvature should be taken at a place that the whisker does not have.
    #[error(transparent)]
    CurvatureAt(#[from] CurvatureAtError),
    /// The course was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Computes the course of `whisker` behind `surface`.
///
/// ```
/// use whiskmap::scene::Scene;
/// use whiskmap::texture::texture;
/// use whiskmap::whisk::AngleCourse;
///
/// let scene = Scene::parse(include_str!("../../scenes/texture_cone.toml"), "texture_cone.toml")?;
/// let surface = scene.surface.ok_or("no surface")?;
/// let course = AngleCourse::sine(15.0, 0.2, 5.0, 100.0)?;
/// let found = texture(&scene.whisker, &surface, &course)?;
/// assert_eq!(found.samples.len(), 501);
/// assert!(found.stays().len() > 10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If a number of the surface is out of its range, an angle is missing, the course begins in contact or turns the base away from the
/// surface, the resting whisker does not fit between two asperities, or a detachment is not found.
pub fn texture(
    whisker: &Whisker,
    surface: &Surface,
    course: &AngleCourse,
) -> Result<Texture, TextureError> {
    texture_until(whisker, surface, course, None, &AtomicBool::new(false))
}

/// Computes the course as [`texture`] does, with the curvature at an arclength in mm, if it is given. If `cancel` is true, the function soon
/// returns an error.
///
/// # Errors
/// Fails as [`texture`] does, if the whisker is shorter than the arclength, and if it is cancelled.
pub fn texture_until(
    whisker: &Whisker,
    surface: &Surface,
    course: &AngleCourse,
    curvature_at_mm: Option<f64>,
    cancel: &AtomicBool,
) -> Result<Texture, TextureError> {
    surface.check(whisker)?;
    let point = CurvaturePoint::of(whisker, curvature_at_mm)?;
    let angles = course.angles_deg();
    if let Some(index) = angles.iter().position(|angle| !(-90.0..=90.0).contains(angle)) {
        let angle_deg = angles[index];
        return Err(TextureError::Angle { index, angle_deg });
    }
    let tips = TipFrame::new(whisker, surface);
    let (asperities, states) = Asperities::new(whisker, surface, &tips)?;
    let begin = asperities.begin(angles[0].to_radians())?;
    let (phases, passages) = asperities.follow(begin, course);
    let place = Placed { tips, asperities: &asperities };
    let times = course.times_s().iter().zip(angles);
    let moments: Vec<[f64; 2]> =
        times.map(|(time_s, angle_deg)| [*time_s, angle_deg.to_radians()]).collect();
    let contacts = phases.iter().zip(&moments).map(|(phase, [_, angle])| {
        let Phase::Contact { side, obstacle } = *phase else {
            return None;
        };
        let push = asperities.push(side, obstacle, *angle).max(0.0);
        place.contact(side, obstacle, push)
    });
    let contacts: Vec<Contact> = contacts.collect();
    let held = place.held(&states, &contacts, &moments, point, cancel)?;

    let changes: Vec<[f64; 2]> =
        passages.iter().map(|(time_s, passage)| [*time_s, passage.angle]).collect();
    let contacts: Vec<Contact> = passages
        .iter()
        .map(|(_, passage)| place.contact(passage.side, passage.obstacle, passage.push))
        .collect();
    let held_then = place.held(&states, &contacts, &changes, None, cancel)?;

    let samples = held.iter().zip(&moments);
    let crossed = SurfaceCrossing::first(samples.chain(held_then.iter().zip(&changes)));
    Ok(Texture {
        samples: sample::samples(course, &phases, &passages, &held, &place.tips, crossed, point),
        events: event::events(&passages, &held_then, crossed),
        reached: asperities.len(),
    })
}

/// Contact with an asperity, and the number of the asperity as an obstacle; `None` without contact. The row does not identify the asperity, because
/// asperities at equal distances share a row.
type Contact = Option<(PushedContact, i32)>;

/// Asperities of a surface with the frame of the tip.
struct Placed<'a> {
    tips: TipFrame,
    asperities: &'a Asperities,
}

impl Placed<'_> {
    /// Returns the contact with an obstacle after a push in radians, as a magnitude; `None` for a push that is NaN.
    fn contact(&self, side: Side, obstacle: i32, push: f64) -> Contact {
        let contact =
            || PushedContact { side, row: self.asperities.row(side, obstacle), push, phase: None };
        (!push.is_nan()).then(|| (contact(), obstacle))
    }

    /// Returns the state of each of the `contacts`, at its `[time in s, angle in radians]`; `None` without contact.
    fn held(
        &self,
        states: &BothSides,
        contacts: &[Contact],
        moments: &[[f64; 2]],
        point: Option<CurvaturePoint>,
        cancel: &AtomicBool,
    ) -> Result<Vec<Option<Held>>, TextureError> {
        let mut found = Vec::with_capacity(contacts.len());
        for chunk in contacts.chunks(STATES_AT_ONCE) {
            if cancel.load(Ordering::Relaxed) {
                return Err(TextureError::Cancelled);
            }
            let pushed = chunk.iter().map(|contact| contact.map(|(pushed, _)| pushed));
            found.extend(states.at(&pushed.collect::<Vec<_>>(), friction::states));
        }
        let held = contacts.par_iter().zip(found).zip(moments);
        let held = held.map(|((contact, state), [_, angle])| {
            let (PushedContact { side, push, .. }, obstacle) = (*contact)?;
            let (asperity, x_mm) = self.asperities.place(obstacle);
            Some(Held {
                asperity,
                side,
                push,
                state: state.map(|state| {
                    let tip = self.tips.held(x_mm, side, *angle, &state.reading);
                    (state.reading, tip)
                }),
                curvature_per_mm: state.zip(point).and_then(|(state, point)| {
                    Some(states.of(side)?.curvature_per_mm(&state, point.at_mm))
                }),
            })
        });
        Ok(held.collect())
    }
}

impl Texture {
    /// Returns one line for samples without a state; `None` without such samples.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        let is_undecided = |sample: &&TextureSample| sample.phase == TexturePhase::Undecided;
        let undecided = self.samples.iter().filter(is_undecided).count();
        let all = self.samples.len();
        (undecided > 0).then(|| {
            format!("{undecided} of {all} samples are undecided, for the reasons in the table")
        })
    }

    /// Returns the energy that the detachments of the course lose, in nJ; NaN if the loss of one is not known.
    #[must_use]
    pub fn lost_nj(&self) -> f64 {
        let events = self.events.iter();
        let ends = events.filter(|event| event.event.is_detachment());
        let lost = ends.map(|event| event.lost_nj.unwrap_or(f64::NAN));
        lost.fold(0.0, |sum, lost| sum + lost)
    }
}
