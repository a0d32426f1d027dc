//! Shots with known answers: random states, shot in `f64` by the CPU.

use glam::DVec2;
use std::sync::Arc;
use whiskmap::integrate::Shot;
use whiskmap::rod::{Effects, RadiusProfile, Rod, arclength};
use whiskmap::shooting::ShootingMap;
use whiskmap::shooting::batch::{Batch, InitialCondition, Method};

/// A reproducible stream of numbers in `[0, 1)` (splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 40) as f64 / 16_777_216.0
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Taper and a parabola: what most whiskers have.
pub const USUAL: Effects = Effects {
    taper: true,
    curvature: true,
    spiral: false,
    gradient: false,
    profile: false,
};

/// Measured radii with a bulb at the base and a straight stretch in the middle.
pub const ROWS: [[f64; 2]; 7] = [
    [0.0, 1.0],
    [0.05, 1.06],
    [0.2, 0.85],
    [0.45, 0.6],
    [0.6, 0.6],
    [0.85, 0.25],
    [1.0, 0.08],
];

/// A whisker of taper up to 0.99 and `A*` up to 0.8, or a spiral that bends as much, or of measured radii, on either
/// side of a pole of radius up to 0.03 with friction up to 0.5, up to twice as stiff at the tip as at the base.
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
        spiral: effects
            .spiral
            .then(|| [random.between(-0.8, 0.8), random.between(-0.8, 0.8)]),
        profile: None,
    };
    if effects.profile {
        return Rod {
            taper: 1.0 - ROWS[ROWS.len() - 1][1],
            profile: Some(Arc::new(RadiusProfile::new(&ROWS, 1.0))),
            ..rod
        };
    }
    rod
}

/// A contact on `rod` under `q = |load| s^2` up to `most_q`, on the side of its pole.
pub fn condition<'a>(rod: &'a Rod, most_q: f64, random: &mut Random) -> InitialCondition<'a> {
    let tau = rod.tau_tip() * random.between(0.1, 1.0);
    let s = arclength(rod, tau);
    let load = rod.pole.signum() * random.between(0.0, most_q) / (s * s);
    InitialCondition { rod, tau, load }
}

/// The truth: the default steps are off by less than 1e-11 (`crates/mechanics/tests/mechanics/integrators.rs`).
pub fn maps(effects: Effects, conditions: &[InitialCondition]) -> Vec<ShootingMap> {
    let method = Method::new(whiskmap::shooting::Resolution::FINE).with_effects(effects);
    Batch::new(method).shoot::<ShootingMap>(conditions)
}

/// Shots at the poles of random states, with guesses off by 1 to 3 %.
pub struct Range {
    pub effects: Effects,
    pub rods: Vec<Rod>,
    pub truth: Vec<InitialCondition<'static>>,
    pub shots: Vec<Shot>,
}

impl Range {
    pub fn new(effects: Effects, count: usize, most_q: f64, seed: u64) -> Self {
        let mut random = Random(seed);
        let rods: Vec<Rod> = (0..count.div_ceil(8))
            .map(|_| rod(effects, &mut random))
            .collect();
        // A test ends soon: its states may keep their rods until then.
        let kept: &'static [Rod] = rods.clone().leak();
        let truth: Vec<InitialCondition> = (0..count)
            .map(|i| condition(&kept[i / 8], most_q, &mut random))
            .collect();
        let mut off = || {
            let size = random.between(0.01, 0.03);
            if random.unit() < 0.5 { -size } else { size }
        };
        let shots = maps(effects, &truth)
            .iter()
            .zip(&truth)
            .enumerate()
            .map(|(i, (map, condition))| Shot {
                rod: (i / 8) as u32,
                tau: condition.tau * (1.0 + off()),
                load: condition.load * (1.0 + off()),
                pole: map.pole,
            })
            .collect();
        Self {
            effects,
            rods,
            truth,
            shots,
        }
    }

    /// How far from the wanted place the poles of `(tau, load)` really are.
    pub fn misses(&self, states: impl IntoIterator<Item = (f64, f64)>) -> Vec<f64> {
        let conditions: Vec<InitialCondition> = states
            .into_iter()
            .zip(&self.truth)
            .map(|((tau, load), truth)| InitialCondition {
                rod: truth.rod,
                tau,
                load,
            })
            .collect();
        let wanted = self.shots.iter().map(|shot| shot.pole);
        maps(self.effects, &conditions)
            .iter()
            .zip(wanted)
            .map(|(map, wanted): (&ShootingMap, DVec2)| map.pole.distance(wanted))
            .collect()
    }
}
