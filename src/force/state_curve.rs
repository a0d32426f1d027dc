//! Stable states of the model at one distance of the contact from the base, and the states among them with a measured curvature.
//!
//! Along these states the row parameter `w = |load| tau^2` grows from first touch on. The curvature first grows, too, and may then fall again,
//! so that several states can have the same curvature. States are bracketed between samples of `w`, and on both sides of an extremum.

use super::BaseAxis;
use crate::newton::{BatchNewton, NewtonOutcome, NewtonProblem, NewtonStep};
use crate::sheet::Sheet;
use glam::DVec2;
use whiskmap_mechanics::numerics::illinois;
use whiskmap_mechanics::rod::{Rod, arclength};
use whiskmap_mechanics::shooting::batch::Method;
use whiskmap_mechanics::shooting::shape::profile;
use whiskmap_mechanics::shooting::{FirstVariation, FullState, Resolution};

/// Resolution of the states.
const FINE: Resolution = Resolution::FINE;

/// First step of `w` between samples, over the softness. Folds lie above 6.5.
const SAMPLE_STEP: f64 = 0.25;

/// Value of `w` at which the step has doubled, over the softness. Toward the tip of a cone folds lie at large values.
const DOUBLED_AT: f64 = 8.0;

/// Step at which the end of the states counts as reached, in parts of a whole one.
const LAST_PART: f64 = 1e-9;

/// Maximum number of samples, including samples after a halved step.
const SAMPLES: usize = 160;

/// Maximum number of trajectories to a state.
const TRAJECTORIES: u32 = 20;

/// Newton step, relative to the contact, whose end is extrapolated. The remaining error is about its square.
const LAST_STEP: f64 = 1e-8;

/// Miss of the curvature, in parts of its change, at which the search for a state ends.
const SAME_CURVATURE: f64 = 1e-15;

/// Largest miss of the curvature, in parts of its change, of a state that has it: rounding may end the search before.
const MOST_MISS: f64 = 1e-10;

/// Width in `w` to which an extremum of the curvature is narrowed. The curvature changes there by the square.
const EXTREMUM_WIDTH: f64 = 1e-6;

/// Largest difference between an extremum of the curvature and the measured curvature, in parts of the change of curvature, with which the
/// extremum counts as the state. Rounding decides there whether two states next to the extremum have the measured curvature, or none.
const AT_EXTREMUM: f64 = 1e-11;

impl BaseAxis {
    /// Returns the angle from this axis to the follicle's axis in a state of `rod`, in radians.
    pub(super) fn turn(self, rod: &Rod, full: &FullState) -> f64 {
        match self {
            Self::Tangent => rod.mount * full.force * full.position.x,
            Self::Follicle => 0.0,
        }
    }
}

/// Contact and curvature of a frame, in whisker lengths.
#[derive(Clone, Copy)]
pub struct Measured {
    /// Position of the contact in the frame of the base.
    pub contact: DVec2,
    /// Arclength of the point where the curvature is measured.
    pub at: f64,
    /// Change of the curvature there, in radians per whisker length.
    pub change: f64,
    /// First axis of the frame of the base.
    pub axis: BaseAxis,
}

/// State of the model.
#[derive(Clone, Copy)]
pub struct ModelState {
    /// Contact and load, `(tau, load)`.
    pub point: DVec2,
    /// Pole of the state with first derivatives, pose of the base, force and energy.
    pub full: FullState,
    /// Position of the contact in the frame of the base, in whisker lengths.
    pub contact: DVec2,
    /// Change of the curvature at the measured point, in radians per whisker length.
    change: f64,
}

/// State at a value of `w`, with its change of curvature less the measured one.
#[derive(Clone, Copy)]
pub struct CurveSample {
    w: f64,
    state: ModelState,
    miss: f64,
}

/// Stable states of one side at the measured distance of the contact.
pub struct StateCurve<'a> {
    pub rod: &'a Rod,
    pub sheet: &'a Sheet,
    pub measured: Measured,
}

impl StateCurve<'_> {
    /// Returns the states on the whisker that have the measured curvature, `[state]`, between `samples` of the curve.
    pub fn states(&self, samples: &[CurveSample]) -> Vec<ModelState> {
        let pairs = samples.windows(2);
        let crossings = pairs.filter_map(|pair| self.between([pair[0], pair[1]]));
        let triples = samples.windows(3);
        let turns = triples.flat_map(|triple| self.at_extremum([triple[0], triple[1], triple[2]]));
        let tip = self.rod.tau_tip();
        let is_on_whisker = |state: &ModelState| {
            let tau = state.point.x;
            tau <= tip || self.sheet.is_at_tip(tau, 1e-12)
        };
        let found = crossings.chain(turns).filter(is_on_whisker);
        found.filter(|state| self.has_lever(state)).collect()
    }

    /// Returns true if the measured point is before the contact of a state. Beyond the contact there is no moment.
    fn has_lever(&self, state: &ModelState) -> bool {
        self.measured.at < arclength(self.rod, state.point.x)
    }

    /// Returns true if the measured point is before the contact of a sample.
    pub fn have_lever(&self, samples: &[CurveSample]) -> bool {
        samples.iter().any(|sample| self.has_lever(&sample.state))
    }

    /// Returns samples from `touch` to the last stable state, `[sample]`. The resting whisker has the contact `touch`. A contact beyond the
    /// tip may come back: where the whisker ends does not matter to a state. A contact before the measured point may move beyond it.
    pub fn samples(&self, touch: f64) -> Vec<CurveSample> {
        let softness = self.rod.softness(touch).max(1.0);
        let step = |w: f64| SAMPLE_STEP * (1.0 / softness + w / DOUBLED_AT);
        let mut part = 1.0;
        let mut samples: Vec<CurveSample> = Vec::new();
        while samples.len() < SAMPLES && part > LAST_PART {
            let last = samples.last().map(|last| (last.w, last.state.point.x));
            let (w, from) = last.map_or((0.0, touch), |(w, from)| (w + part * step(w), from));
            match self.at(w, from).filter(|next| self.is_stable(next)) {
                Some(next) => samples.push(next),
                None if samples.is_empty() => break,
                None => part *= 0.5,
            }
        }
        samples
    }

    fn is_stable(&self, sample: &CurveSample) -> bool {
        let ModelState { point, full, .. } = &sample.state;
        self.sheet.is_stable(point.x, point.y, &full.map)
    }

    /// Returns the state with the measured curvature between two samples, if one sample has a smaller curvature and the other a larger one.
    fn between(&self, [one, other]: [CurveSample; 2]) -> Option<ModelState> {
        if one.miss * other.miss > 0.0 {
            return None;
        }
        let tolerance = SAME_CURVATURE * self.measured.change.abs();
        let from = one.state.point.x;
        let ends = [one, other].map(|end| [end.w, end.miss]);
        let root = illinois(ends, tolerance, |w| Some(self.at(w, from)?.miss))?;
        let found = self.at(root.x, from)?;
        let has_curvature = found.miss.abs() <= MOST_MISS * self.measured.change.abs();
        (has_curvature && self.is_stable(&found)).then_some(found.state)
    }

    /// Returns the states with the measured curvature around an extremum of the curvature. There, all three samples lie on one side of the
    /// measured curvature, and the middle sample misses it least.
    fn at_extremum(&self, mut around: [CurveSample; 3]) -> Vec<ModelState> {
        let is_below = around.map(|sample| sample.miss < 0.0);
        let [from, middle, to] = around.map(|sample| sample.miss.abs());
        if !self.has_lever(&around[1].state) {
            return Vec::new();
        }
        if is_below != [is_below[1]; 3] || middle > from.min(to) {
            return Vec::new();
        }
        while around[2].w - around[0].w > EXTREMUM_WIDTH {
            let [from, middle, to] = around;
            // Halves of the longer part narrow the interval; its middle is the least sample.
            let is_longer_after = to.w - middle.w > middle.w - from.w;
            let beyond = if is_longer_after { to } else { from };
            let Some(next) = self.at(middle.w.midpoint(beyond.w), middle.state.point.x) else {
                return Vec::new();
            };
            if (next.miss < 0.0) != is_below[1] {
                let inner = self.between([middle, next]);
                return inner.into_iter().chain(self.between([next, beyond])).collect();
            }
            around = match (next.miss.abs() < middle.miss.abs(), is_longer_after) {
                (true, true) => [middle, next, to],
                (true, false) => [from, next, middle],
                (false, true) => [from, middle, next],
                (false, false) => [next, middle, to],
            };
        }
        let [_, least, _] = around;
        let is_there = least.miss.abs() <= AT_EXTREMUM * self.measured.change.abs();
        is_there.then_some(least.state).into_iter().collect()
    }

    /// Returns the state at `w` with the measured distance of the contact, by Newton's method from the contact `tau`; `None` if it is not found.
    fn at(&self, w: f64, tau: f64) -> Option<CurveSample> {
        let mut problems = [DistanceProblem {
            rod: self.rod,
            distance: self.measured.contact.length(),
            w: self.sheet.side.sign() * w,
        }];
        let start = problems[0].point(tau);
        let newton = BatchNewton::new(Method::new(FINE), TRAJECTORIES);
        let found = newton.solve(&mut problems, [start]).pop()?;
        if found.outcome != NewtonOutcome::Converged {
            return None;
        }
        let (point, full) = (found.point, found.state);
        let at = [self.measured.at];
        let [measured] = profile(self.rod, point.x, point.y, FINE, &at).try_into().ok()?;
        let axis =
            full.tangent.rotate(DVec2::from_angle(-self.measured.axis.turn(self.rod, &full)));
        let state = ModelState {
            point,
            full,
            contact: DVec2::new(axis.x, -axis.y).rotate(-full.position),
            change: measured.moment / self.rod.stiffness(self.measured.at),
        };
        let miss = state.change - self.measured.change;
        Some(CurveSample { w, state, miss })
    }
}

/// Search for the state with a given distance of its contact from the base, at a value of `w`.
struct DistanceProblem<'a> {
    rod: &'a Rod,
    /// Distance of the contact from the base, in whisker lengths.
    distance: f64,
    /// Row parameter with the sign of the side: `load tau^2`.
    w: f64,
}

impl DistanceProblem<'_> {
    /// Returns `(tau, load)` at the contact `tau`.
    fn point(&self, tau: f64) -> DVec2 {
        DVec2::new(tau, self.w / (tau * tau))
    }
}

impl<'a> NewtonProblem<'a> for DistanceProblem<'a> {
    type Output = FirstVariation;

    fn rod(&self) -> &'a Rod {
        self.rod
    }

    fn step(&mut self, at: DVec2, here: &FirstVariation) -> NewtonStep {
        let position = here.full.position;
        let by_tau = here.by_tau.position - 2.0 * at.y / at.x * here.by_load.position;
        let length = position.length();
        let step = (self.distance - length) * length / position.dot(by_tau);
        let next = self.point(at.x + step.clamp(-0.5 * at.x, 0.5 * at.x));
        match step.abs() < LAST_STEP * at.x {
            true => NewtonStep::Extrapolate(next - at),
            false => NewtonStep::Shoot(next),
        }
    }
}
