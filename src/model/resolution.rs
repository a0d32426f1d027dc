//! How many steps a trajectory takes.

use super::{Rod, arclength};

/// How finely trajectories are integrated: `least` steps under about the load of a cylinder's fold, and no step along which the
/// radius changes by more than a factor `exp(longest)`, the modulus by more than `exp(2 longest)`, or the resting whisker turns
/// by more than `0.6 longest`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Steps of a straight whisker under `q = 8` with `beta tau = 1`.
    pub least: u32,
    /// Longest step in `beta tau`, in `3.2 A* tau` and in half the logarithm of the modulus; at most 0.4.
    pub longest: f64,
}

impl Resolution {
    /// What maps and lines take unless told otherwise: states are off by less than 1e-11 of the length for taper up to 0.99
    /// (`tests/model.rs`).
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
    /// What is needed grows with the root of the load above all, so that a whisker that hardly bends takes a third of the steps.
    /// The weights are those of 20,000 random trajectories that had to reach 1e-8, 1e-10 and 3e-12 (`benches/NOTES.md`).
    #[must_use]
    pub fn steps(&self, rod: &Rod, tau: f64, load: f64) -> u32 {
        self.steps_from(rod, tau, load, arclength(rod, tau))
    }

    /// The same where the arclength `s` of the contact is known already.
    #[inline(always)]
    pub(super) fn steps_from(&self, rod: &Rod, tau: f64, load: f64, s: f64) -> u32 {
        let mut bending = load.abs() * s * s;
        if rod.profile.is_some() {
            bending *= rod.softness(tau);
        }
        if rod.gradient < 0.0 {
            bending /= rod.modulus(s);
        }
        let modulus = if rod.gradient == 0.0 {
            0.0
        } else {
            rod.gradient.abs() / (1.0 + rod.gradient).min(1.0)
        };
        let bend = rod.sharpest_bend();
        let fastest = rod.taper.max(1.6 * bend).max(0.5 * modulus);
        let [taper, bend] = [rod.taper * tau, bend * s].map(|x| x * x.min(2.0));
        let weight = 0.28 + 0.195 * bending.sqrt() + 0.18 * bend;
        let (weight, needed) = match rod.profile {
            Some(profile) => {
                let [change, length] = profile.changes[profile.piece(s)];
                let share = CONCENTRATED * profile.largest_share(s);
                let weight = (share * (weight + 0.17)).max(FEWEST);
                (weight, change.max(fastest * length))
            }
            None => (weight + 0.17 * taper, fastest * tau),
        };
        rounded((f64::from(self.least) * weight).max(needed / self.longest))
    }
}

/// Under more than a small load the bend gathers in the softest piece.
const CONCENTRATED: f64 = 2.0;

/// A piece of a profile may be much shorter than what the rod needs as a step; it takes this part of `least`, so that twice as
/// many steps are twice as many.
const FEWEST: f64 = 0.15;

/// At least so many steps, up to a number that many trajectories share: two significant bits and some.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::manual_clamp,
    reason = "a small positive number; NaN becomes the smallest, which `clamp` would let through"
)]
#[inline(always)]
fn rounded(steps: f64) -> u32 {
    let steps = steps.max(1.0).min(MOST);
    // `ceil` is a call where the target has no instruction for it.
    let steps = steps as u32 + u32::from(steps > f64::from(steps as u32));
    let unit = (steps.next_power_of_two() / 8).max(1);
    (steps + unit - 1) & !(unit - 1)
}

/// Bounds the work on a trajectory that a lost Newton step has sent far away.
const MOST: f64 = 8192.0;
