//! Samples of a course behind a surface, from the states in contact.

use super::rows::{NoTextureState, TexturePhase, TextureSample};
use super::tip::{TipFrame, TipPlace};
use crate::trace::StateRow;
use crate::whisk::phase::{Passage, Phase};
use crate::whisk::{AngleCourse, CurvaturePoint, Undecided, signed_deg};
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Reading;

/// State in contact with an asperity.
#[derive(Clone, Copy)]
pub struct Held {
    /// Number of the asperity on its surface.
    pub asperity: usize,
    pub side: Side,
    /// Push against the asperity since the touch, as a magnitude in radians.
    pub push: f64,
    /// Loads of the held whisker, and position of its tip; `None` where no state was found.
    pub state: Option<(Reading, TipPlace)>,
    /// Curvature of the held whisker at a given arclength, in 1/mm; `None` without a state, or an arclength.
    pub curvature_per_mm: Option<f64>,
}

impl Held {
    /// Returns the loads of the held whisker; `None` where no state was found.
    pub fn reading(&self) -> Option<&Reading> {
        self.state.as_ref().map(|(reading, _)| reading)
    }
}

/// First state in which the whisker meets the surface in two places. Other asperities would bend it there, too.
#[derive(Clone, Copy)]
pub struct SurfaceCrossing {
    pub time_s: f64,
    /// Angle of the base at the crossing, in radians.
    pub angle: f64,
    pub held: Held,
}

impl SurfaceCrossing {
    /// Returns the first crossing among states, each at its `[time in s, angle in radians]`; `None` without one.
    pub fn first<'a>(
        states: impl Iterator<Item = (&'a Option<Held>, &'a [f64; 2])>,
    ) -> Option<Self> {
        let crossing = |(held, [time_s, angle]): (&Option<Held>, &[f64; 2])| {
            let held = held.filter(|held| held.state.is_some_and(|(_, tip)| tip.crosses))?;
            Some(Self { time_s: *time_s, angle: *angle, held })
        };
        let crossings = states.filter_map(crossing);
        crossings.min_by(|one, other| one.time_s.total_cmp(&other.time_s))
    }
}

/// Returns the samples of a course, `[sample]`; all from the first crossing on are undecided.
pub fn samples(
    course: &AngleCourse,
    phases: &[Phase],
    passages: &[(f64, Passage)],
    held: &[Option<Held>],
    tips: &TipFrame,
    crossed: Option<SurfaceCrossing>,
    point: Option<CurvaturePoint>,
) -> Vec<TextureSample> {
    let mut passages = passages.iter().peekable();
    let times = course.times_s().iter().zip(course.angles_deg());
    let states = times.zip(phases.iter().zip(held));
    let samples = states.map(|((&time_s, &angle_deg), (phase, held))| {
        let mut has_slipped = false;
        while let Some((_, passage)) = passages.next_if(|(at, _)| *at <= time_s) {
            has_slipped |= passage.event.is_detachment();
        }
        let crosses = crossed.is_some_and(|crossing| crossing.time_s <= time_s);
        let reason = match phase {
            _ if crosses => Some(NoTextureState::CrossesSurface),
            Phase::Undecided { reason, .. } => Some(match reason {
                Undecided::OnThePole => NoTextureState::OnAnAsperity,
                Undecided::TipEdge => NoTextureState::TipEdge,
                // Only a contact with friction is stuck, and textures have none. Their courses have no gaps.
                Undecided::NotFound
                | Undecided::Stuck
                | Undecided::Missing
                | Undecided::Bridged
                | Undecided::AfterGap => NoTextureState::NotFound,
            }),
            Phase::Contact { .. } if held.is_none_or(|held| held.state.is_none()) => {
                Some(NoTextureState::NotFound)
            }
            _ => None,
        };
        let held = held.filter(|_| !crosses);
        let is_free = reason.is_none() && held.is_none();
        let loads = match is_free {
            true => TextureSample::default().unloaded(),
            false => TextureSample::default().with_state(held.as_ref().and_then(Held::reading)),
        };
        let tip = match is_free {
            true => Some(tips.free(angle_deg.to_radians())),
            false => held.and_then(|held| held.state).map(|(_, tip)| tip),
        };
        let contact = tip.and_then(|tip| tip.contact_mm);
        let curvature_per_mm = match is_free {
            true => point.map(|point| point.at_rest_per_mm),
            false => held.and_then(|held| held.curvature_per_mm),
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
            asperity: held.map(|held| held.asperity),
            side: held.map(|held| held.side),
            push_angle_deg: held.map(|held| signed_deg(held.side, held.push)),
            contact_x_mm: contact.map(|point| point.x),
            contact_y_mm: contact.map(|point| point.y),
            curvature_per_mm,
            tip_x_mm: tip.map(|tip| tip.x_mm),
            tip_height_mm: tip.map(|tip| tip.height_mm),
            reason,
            ..loads
        }
    });
    samples.collect()
}
