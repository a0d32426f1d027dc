//! The tip edge: states with the contact at the tip, from first touch to the corner with the fold edge. They are sampled at
//! Chebyshev-Lobatto nodes of the load, and where the distance has an extremum: between samples it then grows or falls throughout.

use crate::numerics::lobatto::{LOBATTO_COUNT, LOBATTO_NODES, LobattoPolynomial, through_lobatto};
use crate::numerics::newton_form::RootProblem;
use crate::numerics::{Bracket, nearest_turn};
use crate::rod::Rod;
use crate::sheet::edges::predictor::{LAST_STEP_ALONG_EDGE, Prediction, Sample, place_between};
use crate::sheet::fold::FoldPoint;
use crate::sheet::lattice::directions;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{SecondVariation, ShootingMap};
use glam::DVec2;

/// The last Newton step toward an extremum, relative to the distance of the places around it: its square is left.
const LAST_STEP_TO_EXTREMUM: f64 = 1e-7;

/// An extremum of the distance along the tip edge, as far as its samples tell.
#[derive(Clone, Copy, Debug)]
pub struct Extremum {
    /// The sample before it.
    pub after: usize,
    /// The load.
    pub load: f64,
    /// Loads around it, of `dlnD/dload`.
    pub loads: Bracket,
    /// Second derivatives of `(ln D, phi)` by the load.
    pub by_load_load: DVec2,
}

/// The tip edge between its samples, by the parts of the load at the corner.
#[derive(Clone, Debug)]
pub struct TipEdge {
    tau: f64,
    corner: f64,
    ln_distance: LobattoPolynomial,
    phi: LobattoPolynomial,
    by_load: [LobattoPolynomial; 2],
}

impl TipEdge {
    /// The edge up to before the `corner`: its samples, extrema of distance among them, and the polynomials through the others and
    /// the corner; and first touch.
    pub fn sampled(
        method: Method,
        rod: &Rod,
        corner: &FoldPoint,
    ) -> (Vec<Sample>, Self, ShootingMap) {
        let condition = |load| InitialCondition {
            rod,
            tau: corner.tau,
            load,
        };
        let loads = LOBATTO_NODES[..LOBATTO_COUNT - 1]
            .iter()
            .map(|part| part * corner.load);
        let conditions: Vec<InitialCondition> = loads.map(condition).collect();
        let mut maps = Batch::new(method)
            .padded()
            .shoot::<ShootingMap>(&conditions);
        maps.push(corner.variation.map);
        let phis = directions(corner.load, maps.iter());
        let edge = Self::new(corner.tau, corner.load, &maps, &phis);
        let extrema = edge.extrema();
        let mut samples: Vec<Sample> = Vec::new();
        for (m, at_node) in conditions.iter().enumerate() {
            let sample = |place: f64, load: f64, map: &ShootingMap| Sample {
                place,
                tau: corner.tau,
                load,
                ln_distance: map.pole.length().ln(),
                phi: nearest_turn(map.pole.to_angle(), phis[m]),
            };
            samples.push(sample(LOBATTO_NODES[m], at_node.load, &maps[m]));
            for extremum in extrema.iter().filter(|extremum| extremum.after == m) {
                let (load, map) = extremum.polished(method, *at_node);
                samples.push(sample(load / corner.load, load, &map));
            }
        }
        (samples, edge, maps[0])
    }

    /// Through `maps` with the contact at `tau`, under all parts of the load `corner`, with the directions `phis` of the pole.
    fn new(tau: f64, corner: f64, maps: &[ShootingMap], phis: &[f64; LOBATTO_COUNT]) -> Self {
        let numbers = |number: fn(&ShootingMap) -> f64| {
            let mut numbers = [0.0; LOBATTO_COUNT];
            for (slot, map) in numbers.iter_mut().zip(maps) {
                *slot = number(map);
            }
            numbers
        };
        let values = [
            numbers(|map| map.pole.length().ln()),
            *phis,
            numbers(|map| map.by_load.x),
            numbers(|map| map.by_load.y),
        ];
        let [ln_distance, phi, by_load @ ..] = through_lobatto(0, LOBATTO_COUNT, values);
        Self {
            tau,
            corner,
            ln_distance,
            phi,
            by_load,
        }
    }

    /// Where `ln D` is `target` between two neighbouring samples.
    pub fn predict(&self, pair: [&Sample; 2], target: f64) -> Prediction {
        let ends = pair.map(|sample| sample.place);
        let part = place_between(&self.ln_distance, ends, pair, target);
        Prediction {
            tau: self.tau,
            load: self.corner * part,
            phi: self.phi.at(part).0,
            second: Some([DVec2::ZERO, DVec2::ZERO, self.by_load_load(part)]),
        }
    }

    /// Where `dlnD/dload` changes its sign, looked for at three places from sample to sample: two of them may be close.
    pub fn extrema(&self) -> Vec<Extremum> {
        let slope = &self.by_load[0];
        let mut extrema = Vec::new();
        let (mut from, mut at_from) = (0.0, slope.at(0.0).0);
        for (after, pair) in LOBATTO_NODES.windows(2).enumerate() {
            for third in [1.0, 2.0, 3.0] {
                let to = pair[0] + third / 3.0 * (pair[1] - pair[0]);
                let at_to = slope.at(to).0;
                // A slope of exactly 0, as a straight whisker's at first touch, is at a sample already.
                if at_from * at_to < 0.0 {
                    let near = from + at_from / (at_from - at_to) * (to - from);
                    let parts = Bracket::new([from, to], [at_from, at_to]);
                    let problem = RootProblem {
                        target: 0.0,
                        near,
                        bracket: parts,
                    };
                    let part = slope.solve(&problem, LAST_STEP_ALONG_EDGE);
                    extrema.push(Extremum {
                        after,
                        load: self.corner * part,
                        loads: Bracket {
                            below: self.corner * parts.below,
                            above: self.corner * parts.above,
                        },
                        by_load_load: self.by_load_load(part),
                    });
                }
                (from, at_from) = (to, at_to);
            }
        }
        extrema
    }

    fn by_load_load(&self, part: f64) -> DVec2 {
        let [distance, phi] = &self.by_load;
        DVec2::new(distance.at(part).1, phi.at(part).1) / self.corner
    }
}

impl Extremum {
    /// Its load and the map there. Mostly the polynomials know the second derivatives so well that one trajectory tells all; else
    /// Newton's method has its own.
    fn polished(&self, method: Method, at_tip: InitialCondition) -> (f64, ShootingMap) {
        let (load, by_load_load) = (self.load, self.by_load_load);
        let condition = |load| [InitialCondition { load, ..at_tip }];
        let last_step = LAST_STEP_TO_EXTREMUM * (self.loads.above - self.loads.below).abs();
        let map = Batch::new(method).shoot::<ShootingMap>(&condition(load))[0];
        let step = -map.by_load.x / by_load_load.x;
        if step.abs() <= last_step {
            let here = SecondVariation {
                map,
                by_load_load,
                ..SecondVariation::default()
            };
            return (load + step, here.extrapolated(DVec2::new(0.0, step)).map);
        }
        let newton = |load| {
            let here = Batch::new(method).shoot::<SecondVariation>(&condition(load))[0];
            let slope = here.map.by_load.x;
            (slope, load - slope / here.by_load_load.x)
        };
        let load = self.loads.newton(load, |_| last_step, newton).x;
        (
            load,
            Batch::new(method).shoot::<ShootingMap>(&condition(load))[0],
        )
    }
}
