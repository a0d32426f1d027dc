//! Fixed-step integration along the rod.

mod collocation;
mod nystrom8;

pub use collocation::{BackwardCompliance, collocate};
pub use nystrom8::Nystrom8;

use crate::numerics::{Real, hyperbolic_small};
use crate::shooting::{
    Intrinsic, Material, Planar, RodSystem, Section, Sensitivity, TrajectoryState,
};

/// Quantities that turn angles: `X` and the levers of the derivatives.
type Levers<T, S> = ([T; 1], <S as Sensitivity<T>>::Pairs);

/// Number of stages of an integration step.
pub const STAGES: usize = 8;

/// Changes of the cross-section from the start of a step to one of its stages.
#[derive(Clone, Copy, Debug)]
pub struct StepStage<T> {
    /// Coordinate `sigma` from the start of the step to the stage, dimensionless.
    pub sigma: T,
    /// Arclength from the start of the step to the stage, toward the base, over the radius at the start.
    pub along: T,
    /// Radius at the stage over the radius at the start of the step, `exp(taper sigma)`.
    pub grown: T,
    /// Inverse cube of the radius at the stage, over the one at the start of the step: `exp(-3 taper sigma)`.
    pub inverse_cube: T,
    /// Inverse square root of the radius at the stage, over the one at the start of the step: `exp(-taper sigma/2)`.
    pub shrunk: T,
}

/// Stages of an integration step, which all steps of a trajectory share.
#[derive(Clone, Copy, Debug)]
pub struct Scales<T> {
    stages: [StepStage<T>; STAGES],
    /// Taper of the rod, dimensionless. `None` for a cylinder.
    pub taper: Option<T>,
}

impl<T: Real> Scales<T> {
    /// Computes the stages of steps of length `h` in `sigma` on a rod of this `taper`. `taper h` is at most 0.8.
    #[inline(always)]
    pub fn tapered(taper: T, h: T) -> Self {
        let mut scales = Self::cylinder(h);
        let one = T::of(1.0);
        for stage in &mut scales.stages {
            let half = T::of(0.5) * stage.sigma;
            let x = taper * half;
            let [odd, even] = hyperbolic_small(x);
            let growth = x.mul_add(even, odd);
            let root = x.mul_add(growth, one);
            let shrunk = (-x).mul_add((-x).mul_add(even, odd), one);
            let cube = shrunk * shrunk * shrunk;
            *stage = StepStage {
                along: half * growth * (root + one),
                grown: root * root,
                inverse_cube: cube * cube,
                shrunk,
                ..*stage
            };
        }
        scales.taper = Some(taper);
        scales
    }

    /// Computes the stages of steps of length `h` in `sigma` on a cylinder.
    #[inline(always)]
    pub fn cylinder(h: T) -> Self {
        let one = T::of(1.0);
        let start = StepStage { sigma: h, along: h, grown: one, inverse_cube: one, shrunk: one };
        let mut stages = [start; STAGES];
        for (stage, node) in stages.iter_mut().zip(Nystrom8::NODES) {
            stage.sigma = h * T::of(node);
            stage.along = stage.sigma;
        }
        Self { stages, taper: None }
    }

    /// Returns the stage with index `i` of a step.
    #[inline(always)]
    pub fn stage(&self, i: usize) -> &StepStage<T> {
        &self.stages[i]
    }

    /// Returns the stage at the end of a step.
    #[inline(always)]
    pub fn end(&self) -> &StepStage<T> {
        &self.stages[STAGES - 1]
    }
}

impl<T: Real> Section<T> {
    /// Returns the section at a stage of a step that starts at this section.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, stage: &StepStage<T>) -> Self {
        Self {
            rho: self.rho * stage.grown,
            inverse_cube: self.inverse_cube * stage.inverse_cube,
            arclength: self.arclength - self.rho * stage.along,
        }
    }
}

/// Observer of a trajectory, which gets the rod after each integration step. The observer `()` ignores it.
pub trait StepObserver<T> {
    /// Takes the state of the rod at the cross-section at which a step ends.
    fn take(&mut self, section: &Section<T>, rod: &Planar<T>);
}

impl<T> StepObserver<T> for () {
    #[inline(always)]
    fn take(&mut self, _: &Section<T>, _: &Planar<T>) {}
}

/// Returns the state after `steps` integration steps of `system` from `state` at the section `from`. `observer` gets the rod after each
/// step.
#[inline(always)]
pub fn integrate<T: Real, I: Intrinsic<T>, C: Material<T>, S: Sensitivity<T>>(
    system: &RodSystem<T, I, C>,
    scales: &Scales<T>,
    from: Section<T>,
    steps: u32,
    mut state: TrajectoryState<T, I, S>,
    observer: &mut impl StepObserver<T>,
) -> TrajectoryState<T, I, S> {
    let mut section = from;
    for _ in 0..steps {
        let (rest, (rod, carried)) = Nystrom8::step::<T, I, C, S>(system, scales, section, state);
        let rod = upright(rod);
        state = (rest, (rod, carried));
        section = section.at(scales.end());
        observer.take(&section, &rod);
    }
    state
}

/// The rod with its tangent scaled to unit length, to first order in the drift of a step. The drift near a slender tip would
/// otherwise scale the rest of the trajectory.
#[inline(always)]
fn upright<T: Real>([c, s, x, y, bent]: Planar<T>) -> Planar<T> {
    let scale = T::of(1.5) - T::of(0.5) * c.mul_add(c, s * s);
    [scale * c, scale * s, x, y, bent]
}
