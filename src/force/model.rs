//! Force of the full model: the stable state with the measured curvature, at the measured distance of the contact from the base.

use super::lever::Bending;
use super::{CurvatureFrame, FrameContact, FrameForce, NoForce};
use crate::rod::{Rest, Rod, Side, Units, arclength};
use crate::scene::{Pole, Whisker};
use crate::sheet::Sheet;
use crate::shooting::batch::{Batch, Method};
use crate::shooting::shape::{RodPoint, profile};
use crate::shooting::{FirstVariation, Resolution, limited};
use glam::DVec2;

/// Resolution of the model's states.
const FINE: Resolution = Resolution::FINE;

/// Step of the row parameter `|load| tau^2` between samples of the states at one distance of the contact, over the softness. Folds lie above 6.5.
const SAMPLE_STEP: f64 = 0.25;

/// Maximum number of samples. The largest first fold without friction lies at 24.15.
const SAMPLES: u32 = 128;

/// Maximum number of Newton steps to each state.
const STEPS: u32 = 20;

/// Newton step, relative to contact and load, after which a state counts as found. The next one is at most 1e-6 of it: that is the error
/// of the differences.
const LAST_STEP: f64 = 1e-9;

/// Relative change of contact and load from which the derivatives of Newton's method follow.
const DIFFERENCE: f64 = 1e-7;

/// Model of the whisker, with the pole on each side.
pub struct Model {
    sides: [(Rod, Sheet); 2],
    units: Units,
}

/// State of the model.
#[derive(Clone, Copy)]
struct ModelState {
    /// Contact and load, `(tau, load)`.
    point: DVec2,
    /// Base in the frame of the contact.
    base: RodPoint,
    /// Position of the contact in the frame of the base, in whisker lengths.
    contact: DVec2,
    /// Change of the curvature at the measured point, in radians per whisker length.
    change: f64,
}

/// Contact of a frame, in whisker lengths.
struct Measured {
    contact: DVec2,
    /// Arclength of the point where the curvature is measured.
    at: f64,
    /// Change of the curvature there.
    change: f64,
}

impl Model {
    /// Creates the model; contacts are at least `nearest_mm` from the base.
    pub fn new(whisker: &Whisker, pole: &Pole, nearest_mm: f64) -> Self {
        let method = Method::new(FINE);
        let nearest = [nearest_mm / whisker.length_mm];
        let sides = [Side::Cb, Side::Cf].map(|side| {
            let rod = whisker.rod(&Pole::smooth(pole.radius_mm), side);
            let sheet = Sheet::new(method, &rod, side, &nearest);
            (rod, sheet)
        });
        Self {
            sides,
            units: whisker.units(),
        }
    }

    /// Returns the force in a frame in contact.
    pub fn force(
        &self,
        bending: &Bending,
        frame: &CurvatureFrame,
        contact: &FrameContact,
    ) -> FrameForce {
        let none = |reason| bending.none(frame.time_s, reason);
        let length = self.units.length_mm;
        let measured = Measured {
            contact: DVec2::from(contact.contact_mm) / length,
            at: frame.at_arc_length_mm / length,
            change: bending.change_per_mm * length,
        };
        let (rod, sheet) = &self.sides[usize::from(measured.change < 0.0)];
        let rest = Rest::new(&Rod {
            pole: 0.0,
            ..rod.clone()
        });
        let (s, _) = rest.touch_at_distance(measured.contact.length());
        if s > rest.end() {
            return none(NoForce::OutOfReach);
        }
        if s <= measured.at {
            return none(NoForce::NoLever);
        }
        let touch = DVec2::new(rod.tau(s), 0.0);
        let is_stable = |state: &ModelState| {
            let (tau, load) = state.point.into();
            let shot: Vec<FirstVariation> =
                Batch::new(Method::new(FINE)).shoot_at(rod, [(tau, load)]);
            let is_on_whisker = tau <= rod.tau_tip() || sheet.is_at_tip(tau, 1e-12);
            is_on_whisker && sheet.is_stable(tau, load, &shot[0].full.map)
        };
        let off = |state: &ModelState| state.contact.distance(measured.contact);
        let starts = measured.starts(rod, touch, is_stable);
        let found = starts
            .into_iter()
            .filter_map(|start| measured.newton(rod, start, |state| measured.miss(state)));
        let found = found.filter(is_stable);
        let nearest = found.min_by(|one, other| off(one).total_cmp(&off(other)));
        let Some(state) = nearest else {
            return none(NoForce::NoState);
        };
        let ModelState { point, base, .. } = state;
        let units = &self.units;
        let force = point.y * rod.radius(point.x).powi(2);
        let on_base = force * DVec2::new(base.tangent.y, base.tangent.x) * units.force_un;
        FrameForce {
            force_un: Some(force * units.force_un),
            base_force_x_un: Some(on_base.x),
            base_force_y_un: Some(on_base.y),
            base_moment_nnm: Some(-force * base.position.x * units.moment_nnm),
            contact_angle_deg: Some(-base.tangent.to_angle().to_degrees()),
            contact_off_mm: Some(off(&state) * length),
            reason: None,
            ..none(NoForce::NoState)
        }
    }
}

impl Measured {
    /// Returns distance and curvature by which `state` misses the measured ones.
    fn miss(&self, state: &ModelState) -> DVec2 {
        let distance = self.contact.length() - state.contact.length();
        DVec2::new(distance, self.change - state.change)
    }

    /// Returns starts near all states with the measured distance and curvature, `[start]` as `(tau, load)`. Along the stable states at this
    /// distance, from `touch` on, the curvature first grows and may then fall again, so that two of them can have it.
    fn starts(
        &self,
        rod: &Rod,
        touch: DVec2,
        is_stable: impl Fn(&ModelState) -> bool,
    ) -> Vec<DVec2> {
        let sign = self.change.signum();
        let step = SAMPLE_STEP / rod.softness(touch.x).max(1.0);
        let mut before: [Option<(DVec2, f64)>; 2] = [None; 2];
        let mut starts = Vec::new();
        for sample in 0..=SAMPLES {
            let w = sign * step * f64::from(sample);
            let from = before[1].map_or(touch.x, |(point, _)| point.x);
            let start = DVec2::new(from, w / (from * from));
            let miss = |state: &ModelState| {
                let DVec2 { x: tau, y: load } = state.point;
                DVec2::new(self.miss(state).x, w - load * tau * tau)
            };
            let Some(state) = self.newton(rod, start, miss).filter(&is_stable) else {
                break;
            };
            let miss = self.miss(&state).y;
            let [last, middle] = before;
            if let Some((point, other)) = middle {
                if (other < 0.0) != (miss < 0.0) {
                    let part = other / (other - miss);
                    starts.push(point + part * (state.point - point));
                } else if let Some((from, first)) = last
                    && other.abs() <= first.abs().min(miss.abs())
                {
                    // Between these samples the curvature may turn back: two states or none.
                    starts.extend([0.5 * (from + point), point, 0.5 * (point + state.point)]);
                }
            }
            before = [middle, Some((state.point, miss))];
        }
        // The states end between the last sample and the next: look from there, and from the sample before.
        starts.extend(before.into_iter().flatten().map(|(point, _)| point));
        starts
    }

    /// Returns the state of a contact at `point`, `(tau, load)`; `None` if the measured point is not before the contact.
    fn state(&self, rod: &Rod, point: DVec2) -> Option<ModelState> {
        let is_before = point.is_finite() && point.x > 0.0 && self.at < arclength(rod, point.x);
        let at = is_before.then_some([0.0, self.at])?;
        let [base, measured] = profile(rod, point.x, point.y, FINE, &at).try_into().ok()?;
        let to_base = DVec2::new(base.tangent.x, -base.tangent.y);
        Some(ModelState {
            point,
            contact: to_base.rotate(-base.position),
            base,
            change: measured.moment / rod.stiffness(self.at),
        })
    }

    /// Finds the state that misses nothing, by Newton's method from `start`.
    fn newton(
        &self,
        rod: &Rod,
        start: DVec2,
        miss: impl Fn(&ModelState) -> DVec2,
    ) -> Option<ModelState> {
        let mut here = self.state(rod, start)?;
        for _ in 0..STEPS {
            let s = arclength(rod, here.point.x);
            let scales = DVec2::new(s, here.point.y.abs() + 1.0 / (s * s));
            let now = miss(&here);
            let by = |axis: DVec2| {
                let step = axis * scales * DIFFERENCE;
                let beside = self.state(rod, here.point - step)?;
                Some((miss(&beside) - now) / step.length())
            };
            let (by_tau, by_load) = (by(DVec2::X)?, by(DVec2::Y)?);
            let step = DVec2::new(now.perp_dot(by_load), by_tau.perp_dot(now));
            let (step, length) = limited(step / by_tau.perp_dot(by_load), s, here.point.y);
            here = self.state(rod, here.point + step)?;
            if length < LAST_STEP {
                return Some(here);
            }
        }
        None
    }
}
