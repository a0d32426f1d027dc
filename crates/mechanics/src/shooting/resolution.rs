//! Resolutions: numbers of integration steps of trajectories.

use crate::rod::{Demands, RadiusProfile, Rod, arclength};

/// Resolution of trajectories: `least` steps at about the load of a cylinder's fold. Along one step, the radius of a cone changes at most
/// by the factor `exp(longest)`, the modulus by `exp(2 longest)`. The resting whisker turns at most by `0.6 longest` radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Number of steps of a straight whisker under `q = 8` with `beta tau = 1`.
    pub least: u32,
    /// Longest integration step in `beta tau`, in `3.2 A* tau` and in half the logarithm of the modulus, at most 0.4.
    pub longest: f64,
    /// Fewest integration steps along a piece of a profile: 1, or more where errors are estimated by doubling.
    pub fewest: u32,
}

impl Resolution {
    /// Default resolution of maps and traces: errors of states are below 1e-11 whisker lengths for taper up to 0.99
    /// (`tests/mechanics/integrators.rs`).
    pub const FINE: Self = Self::of(20);

    /// Resolution for signs and guesses: errors of states on the stable sheet are below 1e-6 whisker lengths.
    pub const COARSE: Self = Self::of(5);

    /// Ladder of resolutions from cheap to exact, `[rung]`. Errors of neighbours differ by factors of 6 to 26.
    pub const LADDER: [Self; 8] = [
        Self::of(3),
        Self::of(4),
        Self::COARSE,
        Self::of(7),
        Self::of(10),
        Self::of(14),
        Self::FINE,
        Self::of(30),
    ];

    /// Creates the resolution with `least` steps. No step is longer than the average of as many on a cone of taper 0.96.
    #[must_use]
    pub const fn of(least: u32) -> Self {
        let longest = 3.2 / least as f64;
        Self { least, longest: if longest < 0.4 { longest } else { 0.4 }, fewest: 1 }
    }

    /// Returns the finer of this resolution and [`Resolution::FINE`].
    #[must_use]
    pub const fn at_least_fine(self) -> Self {
        if self.least < Self::FINE.least { Self::FINE } else { self }
    }

    /// Returns the resolution with twice as many steps.
    #[must_use]
    pub const fn doubled(self) -> Self {
        Self { least: 2 * self.least, longest: 0.5 * self.longest, fewest: 2 * self.fewest }
    }

    /// Returns the number of steps of a trajectory from `tau` under `load` on `rod`. With a profile it is the number for a piece that
    /// does all the bending ([`PieceSteps`]).
    ///
    /// The number grows mainly with the root of the load: a whisker that hardly bends takes a third of the steps. The weights were
    /// fitted to 20,000 random trajectories with errors of 1e-8, 1e-10 and 3e-12 (`benches/NOTES.md`).
    #[must_use]
    pub fn steps(&self, rod: &Rod, tau: f64, load: f64) -> u32 {
        self.steps_from(rod, tau, load, arclength(rod, tau))
    }

    /// Returns the number of steps as [`Resolution::steps`] does, for a contact at the known arclength `s`, in whisker lengths.
    #[inline(always)]
    pub(super) fn steps_from(&self, rod: &Rod, tau: f64, load: f64, s: f64) -> u32 {
        let bend = rod.sharpest_bend();
        if rod.is_uniform_cone() {
            return self.steps_on_uniform(rod.taper, bend, [tau, load, s]);
        }
        let mut bending = load.abs() * s * s;
        if rod.gradient < 0.0 {
            bending /= rod.modulus(s);
        }
        if rod.profile.is_some() {
            bending *= rod.softness(tau);
            let weight = weight(bending, bend * s) + 0.17;
            return self.rounded(CONCENTRATED * weight, 0.0);
        }
        let fastest = fastest_along(rod);
        let weight = weight(bending, bend * s) + weight_of_taper(rod.taper * tau);
        self.rounded(weight, fastest * tau)
    }

    /// Returns the numbers of a `rod` without a profile that determine the steps of its trajectories.
    #[must_use]
    pub fn rule(&self, rod: &Rod) -> StepRule {
        StepRule {
            least: f64::from(self.least),
            bend: rod.sharpest_bend(),
            fastest: fastest_along(rod) / self.longest,
        }
    }

    /// Returns the steps along the pieces of the profile of `rod` for a trajectory from `tau` under `load`.
    #[must_use]
    pub(super) fn of_pieces(&self, rod: &Rod, tau: f64, load: f64) -> PieceSteps {
        let s = arclength(rod, tau);
        let fastest = (1.6 * rod.sharpest_bend()).max(0.5 * change_of_modulus(rod));
        PieceSteps {
            bent: f64::from(self.steps_from(rod, tau, load, s)),
            at_rest: fastest / self.longest,
            rough: ROUGH * f64::from(self.least),
            fewest: self.fewest,
            reach: Demands::reach(s),
        }
    }

    /// Returns the number of steps on a rod with a constant modulus and no profile, from `tau`, load and arclength. It has no branch, so
    /// that a compiler vectorises it.
    #[inline(always)]
    pub(super) fn steps_on_uniform(&self, taper: f64, bend: f64, [tau, load, s]: [f64; 3]) -> u32 {
        let weight = weight(load.abs() * s * s, bend * s) + weight_of_taper(taper * tau);
        self.rounded(weight, fastest(taper, bend) * tau)
    }

    /// The larger of both numbers of steps, rounded up to three significant bits, so that many trajectories share it.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::manual_clamp,
        reason = "the last bits of the sum are the number; NaN becomes the smallest number, where `clamp` would keep it"
    )]
    #[inline(always)]
    fn rounded(&self, weight: f64, needed: f64) -> u32 {
        /// Added to a smaller number, it leaves no bits for fractions.
        const WHOLE: f64 = (1_u64 << 52) as f64;
        /// The bits of a mantissa after the first two.
        const REST: u64 = (1 << 50) - 1;
        let steps = (f64::from(self.least) * weight).max(needed / self.longest);
        let steps = steps.max(1.0).min(MOST);
        let nearest = (steps + WHOLE) - WHOLE;
        let whole = nearest + if nearest < steps { 1.0 } else { 0.0 };
        let rounded = f64::from_bits((whole.to_bits() + REST) & !REST);
        (rounded + WHOLE).to_bits() as u32
    }
}

/// Numbers of steps along the pieces of a profile for one trajectory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PieceSteps {
    /// Steps of a piece that does all the bending.
    bent: f64,
    /// Steps of a piece as long as the whisker, for its shape at rest and its modulus.
    at_rest: f64,
    /// Steps of a piece of roughness 1.
    rough: f64,
    /// Fewest steps of a piece, see [`Resolution`].
    fewest: u32,
    /// Reach of the contact, see [`Demands`].
    reach: u32,
}

/// Numbers of a rod without a profile that determine, with contact and load, the steps of its trajectories. Shaders count steps by them, as
/// [`Resolution::steps`] does on the CPU.
#[derive(Clone, Copy, Debug)]
pub struct StepRule {
    /// Least number of steps of the [`Resolution`].
    pub least: f64,
    /// Largest curvature at rest, in radians per whisker length.
    pub bend: f64,
    /// Number of steps for `tau = 1` that the longest step allows.
    pub fastest: f64,
}

impl StepRule {
    /// Weights of the number of steps, with their names in the shader.
    pub const WEIGHTS: [(&str, f64); 7] = [
        ("STEPS_AT_REST", AT_REST),
        ("STEPS_BY_ROOT", BY_ROOT),
        ("STEPS_BY_COIL", BY_COIL),
        ("COILING", COILING),
        ("STEPS_BY_TURN", BY_TURN),
        ("STEPS_BY_FALL", BY_FALL),
        ("MOST_STEPS", MOST),
    ];
}

impl PieceSteps {
    /// Returns the number of steps of the piece `k` of `profile`, by its share in the bending, its length, and the change of its radius.
    #[inline(always)]
    pub(super) fn of(&self, profile: &RadiusProfile, k: usize) -> u32 {
        let demand = profile.demands.of(self.reach, k);
        let bent = self.bent * f64::from(demand.bending);
        let at_rest = self.at_rest * profile.widths[k];
        let rough = self.rough * f64::from(demand.roughness);
        let needed = bent.max(at_rest).max(rough).min(MOST);
        (needed.ceil() as u32).max(self.fewest)
    }
}

/// Change of the logarithm of the modulus over the whisker: an upper bound.
fn change_of_modulus(rod: &Rod) -> f64 {
    rod.gradient.abs() / (1.0 + rod.gradient).min(1.0)
}

/// Weight of a straight cylinder at rest.
const AT_REST: f64 = 0.28;

/// Weight of the root of the scaled load.
const BY_ROOT: f64 = 0.195;

/// Weight of the root of the scaled load beyond [`COILING`].
const BY_COIL: f64 = 0.6;

/// Weight of the product of the angle by which the whisker at rest turns between base and contact, and this angle or 2.
const BY_TURN: f64 = 0.18;

/// Weight of the product of the fall of the radius, `fall = beta tau`, and this fall or 2.
const BY_FALL: f64 = 0.17;

/// Weight of the scaled load and of the rest shape, which turns by `bend` radians between base and contact.
#[inline(always)]
fn weight(bending: f64, bend: f64) -> f64 {
    let root = bending.sqrt();
    let coiling = BY_COIL * (root - COILING).max(0.0);
    AT_REST + BY_ROOT * root + coiling + BY_TURN * bend * bend.min(2.0)
}

/// Root of the scaled load above which a whisker coils up, so that an error is larger relative to the distance between base and
/// pole. Few stable states without friction lie above it: the first fold of a cone lies at `q` of 24 at most.
const COILING: f64 = 4.5;

/// Weight of the fall of the radius, `fall = beta tau`.
#[inline(always)]
fn weight_of_taper(fall: f64) -> f64 {
    BY_FALL * fall * fall.min(2.0)
}

/// Rate of change along `tau` of a rod without a profile that limits the length of a step.
fn fastest_along(rod: &Rod) -> f64 {
    fastest(rod.taper, rod.sharpest_bend()).max(0.5 * change_of_modulus(rod))
}

/// Rate of change along `tau` of a rod with a constant modulus that limits the length of a step.
#[inline(always)]
fn fastest(taper: f64, bend: f64) -> f64 {
    taper.max(1.6 * bend)
}

/// Steps of collocation along a piece that does all the bending, over the steps of Nystrom's method along a cone: collocation
/// is of lower order (`benches/NOTES.md`).
const CONCENTRATED: f64 = 2.2;

/// Steps for a roughness of 1, over `least`.
const ROUGH: f64 = 1.6;

/// Largest number of steps: it bounds the work on a trajectory that a diverging Newton step has sent far away.
const MOST: f64 = 8192.0;
