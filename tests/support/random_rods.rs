//! Random whiskers for every set of effects, and random states of them.
#![allow(dead_code, reason = "each test program uses a part of this module")]

use std::sync::{Arc, LazyLock};
use whiskmap::mechanics::rod::{CurvaturePolynomial, Effects, RadiusProfile, Rod, arclength};
use whiskmap::mechanics::shooting::batch::InitialCondition;
use whiskmap::random::RandomStream;

/// Random numbers of 24 bits, which `f32` represents exactly.
#[derive(Clone)]
pub struct Random(RandomStream);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(RandomStream::of_state(seed))
    }

    /// Uniform number of at least 0 and less than 1.
    pub fn unit(&mut self) -> f64 {
        const STEPS: f64 = 16_777_216.0;
        (STEPS * self.0.uniform()).floor() / STEPS
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Effects of most whiskers: taper and a parabola.
pub const USUAL: Effects = Effects {
    taper: true,
    curvature: true,
    spiral: false,
    polynomial: false,
    gradient: false,
    profile: false,
};

/// Measured radii with a bulb at the base and a cylindrical part in the middle, as `[arclength, radius]` over length and base radius.
pub const ROWS: [[f64; 2]; 7] =
    [[0.0, 1.0], [0.05, 1.06], [0.2, 0.85], [0.45, 0.6], [0.6, 0.6], [0.85, 0.25], [1.0, 0.08]];

/// Profile of [`ROWS`], shared by all rods: trajectories of one profile share blocks.
static PROFILE: LazyLock<Arc<RadiusProfile>> =
    LazyLock::new(|| Arc::new(RadiusProfile::new(&ROWS, 1.0)));

/// Random rod with taper up to 0.99 or measured radii, `A*` up to 0.8, an equally bent spiral or a polynomial curvature, and up to twice the modulus at the
/// tip, on a random side of a pole of radius up to 0.03 with friction up to 0.5.
pub fn rod(effects: Effects, random: &mut Random) -> Rod {
    let bend = f64::from(effects.curvature) * random.between(0.0, 0.8);
    let side = if random.unit() < 0.5 { 1.0 } else { -1.0 };
    let rod = Rod {
        taper: f64::from(effects.taper) * random.between(0.0, 0.99),
        bend,
        slope: -2.0 * bend * random.between(-0.3, 0.3),
        pole: side * random.between(0.0, 0.03),
        gradient: f64::from(effects.gradient) * random.between(0.0, 1.0),
        friction: side * random.between(0.0, 0.5),
        spiral: effects.spiral.then(|| [random.between(-0.8, 0.8), random.between(-0.8, 0.8)]),
        polynomial: effects.polynomial.then(|| Arc::new(polynomial(random))),
        profile: None,
        mount: 0.0,
    };
    // Every fourth rod is in a mount that turns. Its compliance does not change the other numbers.
    let mut mount = random.clone();
    let turns = f64::from(mount.unit() < 0.25);
    let rod = Rod { mount: turns * mount.between(0.0, 0.2), ..rod };
    if effects.profile {
        return Rod {
            taper: 1.0 - ROWS[ROWS.len() - 1][1],
            profile: Some(Arc::clone(&PROFILE)),
            ..rod
        };
    }
    rod
}

/// Random curvature whose terms are as large as measured ones: a turn of up to 1 radian, and less from one degree to the next.
fn polynomial(random: &mut Random) -> CurvaturePolynomial {
    let mut size = 1.0;
    CurvaturePolynomial::new(std::array::from_fn(|_| {
        let drawn = size * random.between(-1.0, 1.0);
        size *= 0.6;
        drawn
    }))
}

/// Random contact and load on `rod`, with `q = |load| s^2` up to `most_q`, on the side of its pole.
pub fn condition<'a>(rod: &'a Rod, most_q: f64, random: &mut Random) -> InitialCondition<'a> {
    let tau = rod.tau_tip() * random.between(0.1, 1.0);
    let s = arclength(rod, tau);
    let load = rod.pole.signum() * random.between(0.0, most_q) / (s * s);
    InitialCondition { rod, tau, load }
}

/// `count` states of random rods, eight of each. The rods are leaked until the test program ends.
pub fn conditions(
    effects: Effects,
    count: usize,
    most_q: f64,
    seed: u64,
) -> Vec<InitialCondition<'static>> {
    let mut random = Random::new(seed);
    let rods = (0..count.div_ceil(8)).map(|_| rod(effects, &mut random));
    let rods: &'static [Rod] = rods.collect::<Vec<_>>().leak();
    let state = |i: usize| condition(&rods[i / 8], most_q, &mut random);
    (0..count).map(state).collect()
}
