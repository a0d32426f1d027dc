//! Fixed-step integration along the rod: what the Runge-Kutta methods share.

use super::real::hyperbolic_small;
use super::rhs::{Intrinsic, Material, Planar, RodSystem, Sensitivity, State};
use super::{Real, Rod, Section, arclength};

/// How finely trajectories are integrated: `least` steps under the load of a cylinder's fold, and no step along which the radius changes by more than
/// a factor `exp(longest)`, the modulus by more than `exp(2 longest)`, or the resting whisker turns by more than `longest`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Steps under `q = 8` with `beta tau = 1`.
    pub least: u32,
    /// Longest step in `beta tau`, in `2 A* tau` and in half the logarithm of the modulus; at most 0.4, the range of the stages' radii.
    pub longest: f64,
}

impl Resolution {
    /// What maps and lines take unless told otherwise: states are exact to rounding for taper up to 0.95, and to 2e-12 up
    /// to 0.99.
    pub const FINE: Self = Self::of(32);

    /// What signs and guesses need. Over the stable sheet states are off by less than 1e-6.
    pub const COARSE: Self = Self::of(8);

    /// From cheap to exact, about a factor of 30 in the error apart.
    pub const LADDER: [Self; 8] = [
        Self::of(4),
        Self::of(6),
        Self::of(8),
        Self::of(12),
        Self::of(16),
        Self::of(24),
        Self::FINE,
        Self::of(48),
    ];

    /// So many steps, and none longer than a cone of taper 0.96 takes on average in as many.
    #[must_use]
    pub const fn of(least: u32) -> Self {
        let longest = 3.2 / least as f64;
        Self {
            least,
            longest: if longest < 0.4 { longest } else { 0.4 },
        }
    }

    /// Twice as fine.
    #[must_use]
    pub const fn doubled(self) -> Self {
        Self {
            least: 2 * self.least,
            longest: 0.5 * self.longest,
        }
    }

    /// Steps for a trajectory from `tau` under `load` on `rod`; with a profile, steps for every piece of it.
    ///
    /// Errors grow with the load above all, so that a whisker that hardly bends takes a quarter of the steps. The weights
    /// are those of 20,000 random trajectories that had to reach 1e-8 and 1e-10 (`benches/NOTES.md`).
    #[must_use]
    pub fn steps(&self, rod: &Rod, tau: f64, load: f64) -> u32 {
        self.steps_from(rod, tau, load, arclength(rod, tau))
    }

    /// The same where the arclength `s` of the contact is known already.
    #[inline]
    pub(super) fn steps_from(&self, rod: &Rod, tau: f64, load: f64, s: f64) -> u32 {
        let mut bending = load.abs() * s * s;
        if rod.profile.is_some() {
            bending *= rod.softness(tau);
        }
        if rod.gradient < 0.0 {
            bending /= rod.modulus(s);
        }
        let bending = if bending <= EVEN_UP_TO {
            bending
        } else {
            (bending * EVEN_UP_TO).sqrt()
        };
        let modulus = rod.gradient.abs() / (1.0 + rod.gradient).min(1.0);
        let fastest = rod.taper.max(rod.sharpest_bend()).max(0.5 * modulus);
        let weight = 0.26 + 0.074 * bending;
        let shape = 0.16 * rod.taper + 0.05 * rod.sharpest_bend();
        let (weight, needed) = match rod.profile {
            Some(profile) => {
                let [change, length] = profile.changes[profile.piece(s)];
                let share = CONCENTRATED * profile.largest_share(s);
                (share * (weight + 0.16), change.max(fastest * length))
            }
            None => (weight + shape * tau, fastest * tau),
        };
        rounded((f64::from(self.least) * weight).max(needed / self.longest))
    }
}

/// Load `q` up to which steps grow in proportion; beyond, a whisker coils up.
const EVEN_UP_TO: f64 = 9.0;

/// Under more than a small load the bend gathers in the softest piece.
const CONCENTRATED: f64 = 2.0;

/// At least so many steps, up to a number that many trajectories share: two significant bits and some.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::manual_clamp,
    reason = "a small positive number; NaN becomes the smallest, which `clamp` would let through"
)]
fn rounded(steps: f64) -> u32 {
    let steps = steps.max(FEWEST).min(MOST);
    // `ceil` is a call where the target has no instruction for it.
    let steps = steps as u32 + u32::from(steps > f64::from(steps as u32));
    let unit = (steps.next_power_of_two() / 8).max(1);
    (steps + unit - 1) & !(unit - 1)
}

/// A piece may be much shorter than what the rod needs as a step, but the load may change on the first one.
const FEWEST: f64 = 2.0;

/// Bounds the work on a trajectory that a lost Newton step has sent far away.
const MOST: f64 = 8192.0;

/// An explicit Runge-Kutta method with fixed steps.
pub trait Integrator: Copy + Send + Sync + 'static {
    /// One step of length `h` from the section `from`; `scales[i]` is the factor by which the radius has grown
    /// at stage `i`.
    fn step<T: Real, I: Intrinsic<T>, C: Material<T>, S: Sensitivity<T>>(
        system: &RodSystem<T, I, C>,
        scales: &Scales<T>,
        from: Section<T>,
        h: T,
        state: State<T, I, S>,
    ) -> State<T, I, S>;

    /// Where the stages lie in the unit step.
    const NODES: [f64; STAGES];
}

/// Stages of the largest method.
pub const STAGES: usize = 12;

/// How the section changes from the start of a step to each stage; the last node of every method is the end of the step.
#[derive(Clone, Copy, Debug)]
pub struct Scales<T> {
    /// The factors of the radius and its inverse cube.
    stages: Option<[(T, T); STAGES]>,
    /// How much arclength the stages are nearer to the base, over the radius at the start of the step.
    along: [T; STAGES],
}

impl<T: Real> Scales<T> {
    /// Steps of `h` on a rod of this `taper`.
    #[inline(always)]
    pub fn tapered<M: Integrator>(taper: T, h: T) -> Self {
        let one = T::of(1.0);
        let mut stages = [(one, one); STAGES];
        let mut along = [one; STAGES];
        for ((stage, along), node) in stages.iter_mut().zip(&mut along).zip(M::NODES) {
            let length = h * T::of(node);
            let x = taper * length;
            let [odd, even] = hyperbolic_small(x);
            let (grown, shrunk) = (x.mul_add(even, odd), (-x).mul_add(even, odd));
            let inverse = (-x).mul_add(shrunk, one);
            *stage = (x.mul_add(grown, one), inverse * inverse * inverse);
            *along = length * grown;
        }
        Self {
            stages: Some(stages),
            along,
        }
    }

    /// Steps of `h` on a cylinder.
    #[inline(always)]
    pub fn cylinder<M: Integrator>(h: T) -> Self {
        Self {
            stages: None,
            along: M::NODES.map(|node| h * T::of(node)),
        }
    }

    /// The section at stage `i` of a step that starts at `from`.
    #[inline(always)]
    pub fn at(&self, i: usize, from: Section<T>) -> Section<T> {
        let arclength = from.arclength - from.rho * self.along[i];
        match &self.stages {
            Some(stages) => Section {
                rho: from.rho * stages[i].0,
                inverse_cube: from.inverse_cube * stages[i].1,
                arclength,
            },
            None => Section { arclength, ..from },
        }
    }
}

/// Integrates `system` over `tau` in `steps` steps from the section `from`.
#[inline(always)]
pub fn integrate<M: Integrator, T: Real, I, C, S: Sensitivity<T>>(
    system: &RodSystem<T, I, C>,
    scales: &Scales<T>,
    from: Section<T>,
    h: T,
    steps: u32,
    mut state: State<T, I, S>,
) -> State<T, I, S>
where
    I: Intrinsic<T>,
    C: Material<T>,
{
    let mut section = from;
    for _ in 0..steps {
        let (rest, (rod, sens)) = M::step::<T, I, C, S>(system, scales, section, h, state);
        state = (rest, (upright(rod), sens));
        section = scales.at(STAGES - 1, section);
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
