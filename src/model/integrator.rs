//! Fixed-step integration along the rod: what the Runge-Kutta methods share.

use super::real::exp_small;
use super::rhs::{Intrinsic, Planar, RodSystem, Sensitivity, State};
use super::{Radius, Real, Rod};

/// How finely trajectories are integrated: at least `least` steps, and none along which the radius changes by more than
/// a factor `exp(longest)` or the resting whisker turns by more than `longest`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Fewest steps.
    pub least: u32,
    /// Longest step in `beta tau` and in `2 A* tau`; at most 0.4, the range of the stages' radii.
    pub longest: f64,
}

impl Resolution {
    /// Steps for a trajectory over `tau` on `rod`: a multiple of `least`, so that many trajectories take equally many.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to a range of small positive numbers; NaN becomes 0 and then the smallest"
    )]
    pub fn steps(&self, rod: &Rod, tau: f64) -> u32 {
        let fastest = rod.taper.max(2.0 * rod.bend);
        let multiple = fastest * tau / (self.longest * f64::from(self.least));
        self.least * (multiple.ceil() as u32).clamp(1, MOST_MULTIPLES)
    }
}

/// Bounds the work on a trajectory that a lost Newton step has sent far away. `tau` is at most 25 on a whisker (a cone
/// cut at 1e-9, and some) and `2 A*` at most 20.
const MOST_MULTIPLES: u32 = 256;

/// An explicit Runge-Kutta method with fixed steps.
pub trait Integrator: Copy + Send + Sync + 'static {
    /// One step of length `h` from the radius `from`; `scales[i]` is the factor by which the radius has grown
    /// at stage `i`.
    fn step<T: Real, I: Intrinsic<T>, S: Sensitivity<N>, const N: usize>(
        system: &RodSystem<T, I>,
        scales: &Scales<T>,
        from: Radius<T>,
        h: T,
        state: State<T, I, N>,
    ) -> State<T, I, N>;

    /// Where the stages lie in the unit step.
    const NODES: [f64; STAGES];
}

/// Stages of the largest method.
pub const STAGES: usize = 12;

/// The factors by which the radius, and its inverse cube, change from the start of a step to each stage; the
/// last node of every method is the end of the step.
#[derive(Clone, Copy, Debug)]
pub struct Scales<T> {
    stages: Option<[Radius<T>; STAGES]>,
}

impl<T: Real> Scales<T> {
    /// The factors for steps of `h` on a rod of this `taper`.
    #[inline(always)]
    pub fn tapered<M: Integrator>(taper: T, h: T) -> Self {
        let mut stages = [Radius {
            rho: T::of(1.0),
            inverse_cube: T::of(1.0),
        }; STAGES];
        for (stage, node) in stages.iter_mut().zip(M::NODES) {
            let rho = exp_small(taper * h * T::of(node));
            stage.rho = rho;
            stage.inverse_cube = T::of(1.0) / (rho * rho * rho);
        }
        Self {
            stages: Some(stages),
        }
    }

    /// The factors of a cylinder.
    #[inline(always)]
    pub const fn cylinder() -> Self {
        Self { stages: None }
    }

    /// The radius at stage `i` of a step that starts at `from`.
    #[inline(always)]
    pub fn at(&self, i: usize, from: Radius<T>) -> Radius<T> {
        match &self.stages {
            Some(stages) => Radius {
                rho: from.rho * stages[i].rho,
                inverse_cube: from.inverse_cube * stages[i].inverse_cube,
            },
            None => from,
        }
    }
}

/// Integrates `system` over `tau` in `steps` steps from the radius `from`.
#[inline(always)]
pub fn integrate<M: Integrator, T: Real, I: Intrinsic<T>, S: Sensitivity<N>, const N: usize>(
    system: &RodSystem<T, I>,
    scales: &Scales<T>,
    from: Radius<T>,
    h: T,
    steps: u32,
    mut state: State<T, I, N>,
) -> State<T, I, N> {
    let mut radius = from;
    for _ in 0..steps {
        let (rest, (rod, sens)) = M::step::<T, I, S, N>(system, scales, radius, h, state);
        state = (rest, (upright(rod), sens));
        radius = scales.at(STAGES - 1, radius);
    }
    state
}

/// The rod with its tangent brought back to unit length, to first order in the drift of a step. Without this,
/// the drift near a slender tip stretches all that follows.
#[inline(always)]
fn upright<T: Real>([c, s, x, y]: Planar<T>) -> Planar<T> {
    let scale = T::of(1.5) - T::of(0.5) * c.mul_add(c, s * s);
    [scale * c, scale * s, x, y]
}
