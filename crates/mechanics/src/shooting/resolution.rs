//! How many steps a trajectory takes.

use crate::rod::{Demands, RadiusProfile, Rod, arclength};

/// How finely trajectories are integrated: `least` steps under about the load of a cylinder's fold, and no step along which the
/// radius of a cone changes by more than a factor `exp(longest)`, the modulus by more than `exp(2 longest)`, or the resting whisker
/// turns by more than `0.6 longest`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Steps of a straight whisker under `q = 8` with `beta tau = 1`.
    pub least: u32,
    /// Longest step in `beta tau`, in `3.2 A* tau` and in half the logarithm of the modulus; at most 0.4.
    pub longest: f64,
    /// Fewest steps of a piece of a profile: 1, but where errors are to be seen by doubling.
    pub fewest: u32,
}

impl Resolution {
    /// What maps and lines take unless told otherwise: states are off by less than 1e-11 of the length for taper up to 0.99
    /// (`tests/mechanics/integrators.rs`).
    pub const FINE: Self = Self::of(20);

    /// What signs and guesses need. Over the stable sheet states are off by less than 1e-6.
    pub const COARSE: Self = Self::of(5);

    /// From cheap to exact, a factor of 6 to 26 in the error apart.
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

    /// So many steps, and none longer than a cone of taper 0.96 takes on average in as many.
    #[must_use]
    pub const fn of(least: u32) -> Self {
        let longest = 3.2 / least as f64;
        Self {
            least,
            longest: if longest < 0.4 { longest } else { 0.4 },
            fewest: 1,
        }
    }

    /// Twice as fine.
    #[must_use]
    pub const fn doubled(self) -> Self {
        Self {
            least: 2 * self.least,
            longest: 0.5 * self.longest,
            fewest: 2 * self.fewest,
        }
    }

    /// Steps for a trajectory from `tau` under `load` on `rod`; with a profile, those of a piece that did all the bending
    /// ([`PieceSteps`]).
    ///
    /// What is needed grows with the root of the load above all, so that a whisker that hardly bends takes a third of the steps.
    /// The weights are those of 20,000 random trajectories that had to reach 1e-8, 1e-10 and 3e-12 (`benches/NOTES.md`).
    #[must_use]
    pub fn steps(&self, rod: &Rod, tau: f64, load: f64) -> u32 {
        self.steps_from(rod, tau, load, arclength(rod, tau))
    }

    /// The same where the arclength `s` of the contact is known already.
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
        let fastest = fastest(rod.taper, bend).max(0.5 * change_of_modulus(rod));
        let weight = weight(bending, bend * s) + weight_of_taper(rod.taper * tau);
        self.rounded(weight, fastest * tau)
    }

    /// What the pieces of the profile of `rod` need on the way of a trajectory from `tau` under `load`.
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

    /// Those on a rod of one modulus without a profile, from `tau`, load and arclength: without a branch, so that a compiler
    /// can work on several at once.
    #[inline(always)]
    pub(super) fn steps_on_uniform(&self, taper: f64, bend: f64, [tau, load, s]: [f64; 3]) -> u32 {
        let weight = weight(load.abs() * s * s, bend * s) + weight_of_taper(taper * tau);
        self.rounded(weight, fastest(taper, bend) * tau)
    }

    /// At least as many steps as both ask for, up to a number that many trajectories share: three significant bits.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::manual_clamp,
        reason = "the last bits of the sum are the number; NaN becomes the smallest, which `clamp` would let through"
    )]
    #[inline(always)]
    fn rounded(&self, weight: f64, needed: f64) -> u32 {
        /// Added to a number below, it leaves no bits for fractions.
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

/// What the pieces of a profile need on the way of one trajectory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PieceSteps {
    /// Steps of a piece that did all the bending.
    bent: f64,
    /// Steps of a piece as long as the whisker, for its shape at rest and its modulus.
    at_rest: f64,
    /// Steps of a piece of roughness 1.
    rough: f64,
    /// See [`Resolution`].
    fewest: u32,
    /// Of the contact, see [`Demands`].
    reach: u32,
}

impl PieceSteps {
    /// How many steps the piece `k` of `profile` takes: by its share in the bending, its length, and how its radius changes.
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

/// Of its logarithm, over the whisker.
fn change_of_modulus(rod: &Rod) -> f64 {
    rod.gradient.abs() / (1.0 + rod.gradient).min(1.0)
}

/// Of the load and of the rest shape, which turns by `bend` between base and contact.
#[inline(always)]
fn weight(bending: f64, bend: f64) -> f64 {
    let root = bending.sqrt();
    let coiling = 0.6 * (root - COILING).max(0.0);
    0.28 + 0.195 * root + coiling + 0.18 * bend * bend.min(2.0)
}

/// The root of a scaled load from which on a whisker coils up, so that the same error counts for more of the distance between base and
/// pole. Few stable states without friction are beyond it: the first fold of a cone lies at `q` of 24 at most.
const COILING: f64 = 4.5;

/// Of the fall of the radius.
#[inline(always)]
fn weight_of_taper(fall: f64) -> f64 {
    0.17 * fall * fall.min(2.0)
}

/// What limits the length of a step, per `tau`.
#[inline(always)]
fn fastest(taper: f64, bend: f64) -> f64 {
    taper.max(1.6 * bend)
}

/// How many times as many steps collocation takes along a piece that does all the bending as Nystrom's method along a cone: it is of a
/// lower order (`benches/NOTES.md`).
const CONCENTRATED: f64 = 2.2;

/// Steps that a roughness of 1 takes, in parts of `least`.
const ROUGH: f64 = 1.6;

/// Bounds the work on a trajectory that a lost Newton step has sent far away.
const MOST: f64 = 8192.0;
