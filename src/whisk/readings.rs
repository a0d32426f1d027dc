//! Samples and events of a course with their states.

use super::legs::{LegEvent, LegSample};
use super::options::CurvaturePoint;
use super::rows::{Undecided, WhiskEvent, WhiskRegime, WhiskSample};
use super::states::{BothSides, CourseState, PushedContact, SideStates};
use crate::friction::{held, states};
use crate::trace::StateRow;
use glam::DVec2;
use rayon::prelude::*;
use whiskmap_mechanics::rod::Side;

impl WhiskSample {
    /// Returns the sample at a time in s and an angle of the base in degrees, with the position of the contact on a pole with this centre and
    /// radius. Positions are in the axes of first touch on CB: the base is at the origin, its tangent then along the first axis.
    pub(super) fn at(
        self,
        time_s: f64,
        angle_deg: f64,
        (centre_mm, radius_mm): (DVec2, f64),
    ) -> Self {
        let contact = self.side.zip(self.contact_angle_deg).map(|(side, contact_deg)| {
            let tangent = DVec2::from_angle((contact_deg - angle_deg).to_radians());
            centre_mm + side.sign() * radius_mm * tangent.perp()
        });
        Self {
            time_s,
            angle_deg: Some(angle_deg),
            contact_x_mm: contact.map(|point| point.x),
            contact_y_mm: contact.map(|point| point.y),
            ..self
        }
    }
}

/// Returns a `push`, a magnitude in radians, in degrees with the sign of its side.
pub fn signed_deg(side: Side, push: f64) -> f64 {
    side.sign() * push.to_degrees() + 0.0
}

impl BothSides {
    /// Returns the samples of a course with their states and the curvature at a `point`, without times and angles: `[sample]`. `unit_nj` is
    /// the unit of energies, in nJ.
    pub fn samples(
        &self,
        samples: &[LegSample],
        point: Option<CurvaturePoint>,
        unit_nj: f64,
    ) -> Vec<WhiskSample> {
        let contacts = samples.iter().map(|sample| sample.held.ok().flatten());
        let readings = self.at(&contacts.collect::<Vec<_>>(), states);
        let samples = samples.par_iter().zip(readings);
        let with_curvature = |(leg_sample, state): (&LegSample, Option<CourseState>)| {
            let curvature = point.and_then(|point| match leg_sample.held.ok()? {
                None => Some(point.at_rest_per_mm),
                Some(contact) => {
                    let states = self.of(contact.side)?;
                    Some(states.curvature_per_mm(&state?, point.at_mm))
                }
            });
            WhiskSample { curvature_per_mm: curvature, ..sample(leg_sample, state, unit_nj) }
        };
        samples.map(with_curvature).collect()
    }

    /// Returns the events of a course with their states: `[event]`.
    pub fn events(&self, events: &[LegEvent]) -> Vec<WhiskEvent> {
        let contacts =
            events.iter().map(|event| Some(event.contact).filter(|contact| !contact.push.is_nan()));
        // A snap begins at a limit, where rounding may hide that the contact still sticks.
        let readings = self.at(&contacts.collect::<Vec<_>>(), held);
        let events = events.iter().zip(readings).map(|(event, reading)| {
            let PushedContact { side, push, .. } = event.contact;
            let push = Some(push).filter(|push| !push.is_nan());
            let event = WhiskEvent {
                time_s: event.time_s,
                event: event.kind,
                side,
                angle_deg: event.angle.to_degrees(),
                push_angle_deg: push.map(|push| signed_deg(side, push)),
                snaps_deg: match event.kind.is_detachment() {
                    true => self.of(side).and_then(SideStates::snaps_deg),
                    false => None,
                },
                ..WhiskEvent::default()
            };
            event.with_state(reading.as_ref().map(|state| &state.reading))
        });
        events.collect()
    }
}

/// Returns a sample without a state, whose angle is missing for this `reason`.
pub fn missing(time_s: f64, reason: Undecided) -> WhiskSample {
    let undecided = LegSample { held: Err(reason), dissipated: f64::NAN };
    WhiskSample { time_s, ..sample(&undecided, None, f64::NAN) }
}

/// Returns a sample without time and angle. `unit` is the unit of energies, in nJ.
fn sample(leg_sample: &LegSample, state: Option<CourseState>, unit: f64) -> WhiskSample {
    let LegSample { held, dissipated } = *leg_sample;
    let empty = WhiskSample::default();
    let (regime, reason, loads) = match (held, &state) {
        (Err(reason), _) => (WhiskRegime::Undecided, Some(reason), empty),
        (Ok(None), _) => (WhiskRegime::Free, None, empty.unloaded()),
        (Ok(Some(_)), None) => (WhiskRegime::Undecided, Some(Undecided::NotFound), empty),
        (Ok(Some(_)), Some(state)) => {
            let loads = empty.with_state(Some(&state.reading));
            (WhiskRegime::Contact, None, loads)
        }
    };
    let contact = held.ok().flatten();
    let is_known = dissipated.is_finite() && reason != Some(Undecided::Stuck);
    WhiskSample {
        regime,
        side: contact.map(|contact| contact.side),
        push_angle_deg: contact.map(|contact| signed_deg(contact.side, contact.push)),
        dissipated_nj: is_known.then_some(dissipated * unit),
        sliding: state.and_then(|state| state.sliding),
        reason,
        ..loads
    }
}
