//! Starts of the integration steps of trajectories, relative to which a shader integrates neighbouring trajectories.

use super::InitialCondition;
use super::gather::{Conditions, Gather, lanes};
use crate::numerics::{Lanes, LanesTask, SimdTask, Unit, WIDTH};
use crate::shooting::contact::radius_and_arclength;
use crate::shooting::{
    Bent, NoSensitivity, Nystrom8, Polynomial, RodSystem, Scales, Section, Spiral, Straight,
    TrajectoryState, Uniform, integrate,
};
use glam::DVec2;
use std::marker::PhantomData;

/// State of the whisker where a step starts. The frame's origin is the contact; its second axis is along the force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepStart {
    /// Radius at the start of the step over the base radius.
    pub radius: f64,
    /// Arclength of the start of the step from the base, in whisker lengths.
    pub arclength: f64,
    /// Unit tangent of the rod at the start of the step, in the frame of the contact.
    pub tangent: DVec2,
    /// Position of the start of the step along the first axis, across the force, from the contact, in whisker lengths.
    pub across: f64,
    /// Rotation of the rod by bending from the contact to the start of the step, in radians.
    pub bent: f64,
    /// Unit tangent of a parabola at rest in its own frame; the first axis for other rest shapes.
    pub rest: DVec2,
}

/// Returns the starts of the steps of each trajectory, one trajectory after the other, and the rotation of each base by bending, in
/// radians: `[trajectory]`. The trajectory `i` starts at `conditions[i]` and takes `steps[i]` steps. The rods are cones with a constant
/// modulus.
#[must_use]
pub fn step_starts(conditions: &[InitialCondition], steps: &[u32]) -> (Vec<StepStart>, Vec<f64>) {
    let unit = Unit::detect();
    unit.run(StepStarts { conditions, steps })
}

struct StepStarts<'a> {
    conditions: &'a [InitialCondition<'a>],
    steps: &'a [u32],
}

impl SimdTask for StepStarts<'_> {
    type Output = (Vec<StepStart>, Vec<f64>);

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let all: u32 = self.steps.iter().sum();
        let mut starts = Vec::with_capacity(all as usize);
        let mut bent = Vec::with_capacity(self.steps.len());
        let has_polynomial = self.conditions.iter().any(|c| c.rod.polynomial.is_some());
        let has_spiral = self.conditions.iter().any(|c| c.rod.spiral.is_some());
        let has_bend = self.conditions.iter().any(|c| c.rod.bend != 0.0);
        let blocks = self.conditions.chunks(T::LANES);
        for (conditions, steps) in blocks.zip(self.steps.chunks(T::LANES)) {
            macro_rules! follow {
                ($rest:ty) => {
                    T::outlined(FollowSteps::<$rest> {
                        conditions: &std::array::from_fn(|lane| {
                            &conditions[lane.min(conditions.len() - 1)]
                        }),
                        steps,
                        starts: &mut starts,
                        of: PhantomData,
                    })
                };
            }
            let turned = match (has_polynomial, has_spiral, has_bend) {
                (true, ..) => follow!(Polynomial<T>),
                (false, true, _) => follow!(Spiral<T>),
                (false, false, true) => follow!(Bent<T>),
                (false, false, false) => follow!(Straight),
            };
            bent.extend_from_slice(&turned[..steps.len()]);
        }
        (starts, bent)
    }
}

/// Task that integrates trajectories side by side, each in its own number of steps. Lanes that have reached the base continue; their
/// numbers are ignored.
struct FollowSteps<'a, I> {
    conditions: &'a Conditions<'a>,
    steps: &'a [u32],
    /// Output, to which the starts are appended.
    starts: &'a mut Vec<StepStart>,
    of: PhantomData<I>,
}

impl<T: Lanes, I: Gather<T>> LanesTask<T> for FollowSteps<'_, I> {
    /// Angle by which bending has turned each rod at its base.
    type Output = [f64; WIDTH];

    #[inline(always)]
    fn run(self) -> [f64; WIDTH] {
        let Self {
            conditions,
            steps,
            starts,
            ..
        } = self;
        let mut counts = [1.0; WIDTH];
        let mut places = [0; WIDTH];
        let mut end = starts.len();
        for (lane, steps) in steps.iter().enumerate() {
            counts[lane] = f64::from(*steps);
            places[lane] = end;
            end += *steps as usize;
        }
        starts.resize(end, StepStart::default());
        let tau: T = lanes(conditions, |condition| condition.tau);
        let load: T = lanes(conditions, |condition| condition.load);
        let taper: T = lanes(conditions, |condition| condition.rod.taper);
        let cos: T = lanes(conditions, |condition| condition.rod.contact_tangent().x);
        let sin: T = lanes(conditions, |condition| condition.rod.contact_tangent().y);
        let [radius, s] = radius_and_arclength(taper, tau);
        let (intrinsic, at_rest, _) = I::gather(conditions, s);
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let system = RodSystem {
            force: load * radius * radius,
            intrinsic,
            material: Uniform,
        };
        let scales = Scales::tapered::<Nystrom8>(taper, tau / T::pack(counts));
        let mut section = Section {
            rho: radius,
            inverse_cube: one / (radius * radius * radius),
            arclength: s,
        };
        let mut state: TrajectoryState<T, I, NoSensitivity> =
            (at_rest, ([cos, sin, zero, zero, zero], ((), ((), ()))));
        let mut turned = [0.0; WIDTH];
        for step in 0..steps.iter().copied().max().unwrap_or_default() {
            let (rest, ([cos, sin, across, _, bent], _)) = state;
            let (cos, sin) = (cos.unpack(), sin.unpack());
            let (across, bent) = (across.unpack(), bent.unpack());
            let (radius, arclength) = (section.rho.unpack(), section.arclength.unpack());
            let [rest_cos, rest_sin] = I::tangent(rest);
            let (rest_cos, rest_sin) = (rest_cos.unpack(), rest_sin.unpack());
            for (lane, steps) in steps.iter().enumerate() {
                if step < *steps {
                    starts[places[lane] + step as usize] = StepStart {
                        radius: radius[lane],
                        arclength: arclength[lane],
                        tangent: DVec2::new(cos[lane], sin[lane]),
                        across: across[lane],
                        bent: bent[lane],
                        rest: DVec2::new(rest_cos[lane], rest_sin[lane]),
                    };
                }
            }
            state =
                integrate::<Nystrom8, T, _, _, NoSensitivity>(&system, &scales, section, 1, state);
            section = section.at(scales.end());
            let (_, ([.., bent], _)) = state;
            let bent = bent.unpack();
            for (lane, steps) in steps.iter().enumerate() {
                if step + 1 == *steps {
                    turned[lane] = bent[lane];
                }
            }
        }
        turned
    }
}
