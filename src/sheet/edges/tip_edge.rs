//! The tip edge between its samples.

use crate::numerics::lobatto::{Curve, LOADS, PARTS, through};
use crate::numerics::newton_form::oriented;
use crate::sheet::edges::Sample;
use crate::sheet::fold::predictor::{LAST_STEP, Near, place};
use crate::shooting::ShootingMap;
use glam::DVec2;

/// An extremum of the distance along the tip edge.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// The sample before it.
    pub after: usize,
    /// The load.
    pub load: f64,
    /// Loads on both sides of it.
    pub between: [f64; 2],
    /// Second derivatives of `(ln D, phi)` by the load.
    pub bend: DVec2,
}

/// The tip edge, by the parts of the load at the corner.
#[derive(Clone, Debug)]
pub struct TipLine {
    tau: f64,
    corner: f64,
    ln_distance: Curve,
    phi: Curve,
    by_load: [Curve; 2],
}

impl TipLine {
    /// Through `maps` with the contact at `tau`, under all parts of the load `corner`, with the directions `phis` of the pole.
    pub fn new(tau: f64, corner: f64, maps: &[ShootingMap], phis: &[f64; LOADS]) -> Self {
        let numbers = |number: fn(&ShootingMap) -> f64| {
            let mut numbers = [0.0; LOADS];
            for (slot, map) in numbers.iter_mut().zip(maps) {
                *slot = number(map);
            }
            numbers
        };
        let [ln_distance, phi, by_load @ ..] = through(
            0,
            LOADS,
            [
                numbers(|map| map.pole.length().ln()),
                *phis,
                numbers(|map| map.by_load.x),
                numbers(|map| map.by_load.y),
            ],
        );
        Self {
            tau,
            corner,
            ln_distance,
            phi,
            by_load,
        }
    }

    /// Where `ln D` is `target` between two samples.
    pub fn at(&self, pair: [&Sample; 2], target: f64) -> Near {
        let part = place(
            &self.ln_distance,
            pair.map(|sample| sample.place),
            pair,
            target,
        );
        Near {
            tau: self.tau,
            load: self.corner * part,
            phi: self.phi.at(part).0,
            bends: Some([DVec2::ZERO, DVec2::ZERO, self.bend(part)]),
        }
    }

    /// Where `dlnD/dload` changes its sign, looked for at three places from sample to sample: two of them may be close.
    pub fn turns(&self) -> Vec<Turn> {
        let slope = &self.by_load[0];
        let mut turns = Vec::new();
        let (mut from, mut at_from) = (0.0, slope.at(0.0).0);
        for (after, pair) in PARTS.windows(2).enumerate() {
            for third in [1.0, 2.0, 3.0] {
                let to = pair[0] + third / 3.0 * (pair[1] - pair[0]);
                let at_to = slope.at(to).0;
                // A slope of exactly 0, as a straight whisker's at first touch, is at a sample already.
                if at_from * at_to < 0.0 {
                    let near = from + at_from / (at_from - at_to) * (to - from);
                    let ends = oriented([from, to], [at_from, at_to]);
                    let part = slope.solve(0.0, near, ends, LAST_STEP);
                    turns.push(Turn {
                        after,
                        load: self.corner * part,
                        between: [from, to].map(|part| self.corner * part),
                        bend: self.bend(part),
                    });
                }
                (from, at_from) = (to, at_to);
            }
        }
        turns
    }

    fn bend(&self, part: f64) -> DVec2 {
        let [distance, phi] = &self.by_load;
        DVec2::new(distance.at(part).1, phi.at(part).1) / self.corner
    }
}
