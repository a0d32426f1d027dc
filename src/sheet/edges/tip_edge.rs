//! The tip edge: states with the contact at the tip, from first touch to the corner with the fold edge.
//!
//! It is sampled at Chebyshev-Lobatto points of the load, and at the extrema of the distance. Between two samples the distance then grows
//! or falls throughout.

use crate::sheet::case::SheetCase;
use crate::sheet::edges::predictor::{EdgeSample, LAST_STEP_ALONG_EDGE, Prediction, place_between};
use crate::sheet::fold::{FoldPoint, directions};
use glam::DVec2;
use std::f64::consts::FRAC_PI_2;
use whiskmap_mechanics::numerics::chebyshev::{CHEBYSHEV_COUNT, LOBATTO_NODES};
use whiskmap_mechanics::numerics::newton_form::{Polynomial, RootProblem, through_nodes};
use whiskmap_mechanics::numerics::{Bracket, nearest_turn};
use whiskmap_mechanics::shooting::batch::Batch;
use whiskmap_mechanics::shooting::{SecondVariation, ShootingMap};

/// Tip edge between its samples, as polynomials of the part of the load at the corner.
#[derive(Clone, Debug)]
pub struct TipEdge {
    tau: f64,
    corner: f64,
    ln_distance: Polynomial<CHEBYSHEV_COUNT>,
    phi: Polynomial<CHEBYSHEV_COUNT>,
    by_load: [Polynomial<CHEBYSHEV_COUNT>; 2],
}

/// Largest error of the slopes of the polynomial through the distances, relative to the steepest slope, or to 1.
const SLOPE_OFF: f64 = 1e-2;

/// Number of intervals between the samples of an edge that no polynomial approximates.
const MANY_TIP_INTERVALS: usize = 256;

/// Tip edge without the corner: its samples, the polynomials through them, and the shooting map at first touch.
#[derive(Clone, Debug)]
pub struct SampledTipEdge {
    /// Samples of the tip edge by load, including extrema of the distance, `[sample]`.
    pub samples: Vec<EdgeSample>,
    /// Polynomials of the tip edge through the samples at Lobatto points and the corner; `None` if they are not certified.
    pub edge: Option<TipEdge>,
    /// Shooting map at first touch with the contact at the tip.
    pub at_touch: ShootingMap,
}

impl SampledTipEdge {
    /// Samples the tip edge up to the `corner`: at few loads, or at many if the few are not certified.
    pub fn new(case: SheetCase, corner: &FoldPoint) -> Self {
        let few = TipLoads::new(case, corner, &*LOBATTO_NODES);
        let edge = Some(TipEdge::new(&few)).filter(TipEdge::is_certified);
        let samples = if let Some(edge) = &edge {
            few.samples(&edge.extrema())
        } else {
            let part = |i| libm::sin(FRAC_PI_2 * i as f64 / MANY_TIP_INTERVALS as f64).powi(2);
            let parts: Vec<f64> = (0..=MANY_TIP_INTERVALS).map(part).collect();
            let many = TipLoads::new(case, corner, &parts);
            many.samples(&many.extrema())
        };
        Self { samples, edge, at_touch: few.maps[0] }
    }
}

/// Below this ratio to the slope at the next place, the slope of the distance at first touch is only rounding. First touch is then the extremum: both
/// distances differ by 1e-18.
const FLAT_TOUCH: f64 = 1e-9;

/// Last Newton step toward an extremum, relative to the width of its bracket. The remaining error is its square.
const LAST_STEP_TO_EXTREMUM: f64 = 1e-7;

/// Extremum of the distance along the tip edge, as its samples predict it.
#[derive(Clone, Copy, Debug)]
pub(super) struct DistanceExtremum {
    /// Index of the sample before the extremum.
    after: usize,
    /// Predicted load, in parts of the corner's load.
    part: f64,
    /// Parts that bracket the root of `dlnD/dload`.
    parts: Bracket,
    /// Second derivatives of `(ln D, phi)` by the load.
    by_load_load: DVec2,
}

impl DistanceExtremum {
    /// Returns the extremum between loads in parts of `corner`, with the derivatives of `(ln D, phi)` by the load, as the secant predicts
    /// it; `None` if `dlnD/dload` keeps its sign. A slope of 0 at first touch, as of a straight whisker, is at a sample already, also where friction
    /// leaves its rounding.
    fn between(after: usize, corner: f64, ends: [(f64, DVec2); 2]) -> Option<Self> {
        let [(from, slope), (to, slope_there)] = ends;
        let by_part = (slope_there - slope) / (to - from);
        let is_at_touch = from == 0.0 && slope.x.abs() <= FLAT_TOUCH * slope_there.x.abs();
        let changes = slope.x * slope_there.x < 0.0 && !is_at_touch;
        changes.then(|| Self {
            after,
            part: from - slope.x / by_part.x,
            parts: Bracket::new([from, to], [slope.x, slope_there.x]),
            by_load_load: by_part / corner,
        })
    }

    /// Returns the part of the extremum and the map there. The polynomials usually determine the second derivatives so well that one
    /// trajectory suffices; otherwise Newton's method computes its own.
    fn polished(&self, case: SheetCase, corner: &FoldPoint) -> (f64, ShootingMap) {
        let batch = Batch::new(case.method);
        let at = |part| [(corner.tau, part * corner.load)];
        let last_step = LAST_STEP_TO_EXTREMUM * (self.parts.above - self.parts.below).abs();
        let map: ShootingMap = batch.shoot_at(case.rod, at(self.part))[0];
        let step = -map.by_load.x / (self.by_load_load.x * corner.load);
        if step.abs() <= last_step {
            let here = SecondVariation {
                map,
                by_load_load: self.by_load_load,
                ..SecondVariation::default()
            };
            let moved = DVec2::new(0.0, step * corner.load);
            return (self.part + step, here.extrapolated(moved).map);
        }
        let newton = |part| {
            let here: SecondVariation = batch.shoot_at(case.rod, at(part))[0];
            let slope = here.map.by_load.x;
            (slope, part - slope / (here.by_load_load.x * corner.load))
        };
        let part = self.parts.newton(self.part, |_| last_step, newton).x;
        (part, batch.shoot_at(case.rod, at(part))[0])
    }
}

/// Maps of the tip edge at several loads.
struct TipLoads<'a> {
    case: SheetCase<'a>,
    corner: &'a FoldPoint,
    /// Loads in parts of the corner's load; the last one is 1.
    parts: &'a [f64],
    maps: Vec<ShootingMap>,
    /// Directions of the pole in radians, continuous from first touch, one for each load.
    phis: Vec<f64>,
}

impl<'a> TipLoads<'a> {
    fn new(case: SheetCase<'a>, corner: &'a FoldPoint, parts: &'a [f64]) -> Self {
        let before_corner = parts[..parts.len() - 1].iter();
        let points = before_corner.map(|part| (corner.tau, part * corner.load));
        let mut maps: Vec<ShootingMap> = case.shoot(points);
        maps.push(corner.variation.map);
        let loads = parts.iter().map(|part| part * corner.load);
        let phis = directions(0.0, loads.zip(&maps)).collect();
        Self { case, corner, parts, maps, phis }
    }

    /// Returns the samples before the corner, including the `extrema` of the distance.
    fn samples(&self, extrema: &[DistanceExtremum]) -> Vec<EdgeSample> {
        let mut samples: Vec<EdgeSample> = Vec::new();
        for (m, part) in self.parts[..self.parts.len() - 1].iter().enumerate() {
            let sample = |(place, map): (f64, ShootingMap)| EdgeSample {
                place,
                tau: self.corner.tau,
                load: place * self.corner.load,
                ln_distance: libm::log(map.pole.length()),
                phi: nearest_turn(map.pole.to_angle(), self.phis[m]),
            };
            let after = extrema.iter().filter(|extremum| extremum.after == m);
            let polished = after.map(|extremum| extremum.polished(self.case, self.corner));
            let all = std::iter::once((*part, self.maps[m])).chain(polished);
            samples.extend(all.map(sample));
        }
        samples
    }

    /// Returns the extrema between the loads.
    fn extrema(&self) -> Vec<DistanceExtremum> {
        let ends = |m| [m, m + 1].map(|m: usize| (self.parts[m], self.maps[m].by_load));
        let between = |m| DistanceExtremum::between(m, self.corner.load, ends(m));
        (0..self.parts.len() - 1).filter_map(between).collect()
    }
}

impl TipEdge {
    /// Returns true if the slopes of the polynomial through the distances agree with the slopes of the trajectories.
    fn is_certified(&self) -> bool {
        let known = |part: &f64| self.corner * self.by_load[0].at(*part).0;
        let largest = |of: &dyn Fn(&f64) -> f64| {
            let sizes = LOBATTO_NODES.iter().map(|part| of(part).abs());
            sizes.fold(0.0, f64::max)
        };
        let off = largest(&|part| self.ln_distance.at(*part).1 - known(part));
        off <= SLOPE_OFF * largest(&known).max(1.0)
    }

    /// Interpolates the maps `sampled` at the Lobatto points.
    fn new(sampled: &TipLoads) -> Self {
        let maps = sampled.maps.iter().zip(&sampled.phis);
        let values = maps.map(|(map, phi)| {
            let ln_distance = libm::log(map.pole.length());
            [ln_distance, *phi, map.by_load.x, map.by_load.y]
        });
        let nodes = sampled.parts.iter().copied();
        let [ln_distance, phi, by_load @ ..] = through_nodes(nodes.zip(values));
        Self { tau: sampled.corner.tau, corner: sampled.corner.load, ln_distance, phi, by_load }
    }

    /// Returns the predicted point of the tip edge between two neighbouring samples at which `ln D` is `target`.
    pub fn predict(&self, pair: [&EdgeSample; 2], target: f64) -> Prediction {
        let ends = pair.map(|sample| sample.place);
        let part = place_between(&self.ln_distance, ends, pair, target);
        Prediction {
            tau: self.tau,
            load: self.corner * part,
            phi: self.phi.at(part).0,
            second: Some([DVec2::ZERO, DVec2::ZERO, self.by_load_load(part)]),
        }
    }

    /// Returns the extrema of the distance between the Lobatto loads of the tip edge, `[extremum]`. Three places from load to load are
    /// tested, because two extrema may be close.
    pub(super) fn extrema(&self) -> Vec<DistanceExtremum> {
        let slope = |part| (part, DVec2::from(self.by_load.map(|by| by.at(part).0)));
        let mut extrema = Vec::new();
        let mut from = slope(0.0);
        for (after, pair) in LOBATTO_NODES.windows(2).enumerate() {
            for third in [1.0, 2.0, 3.0] {
                let to = slope(pair[0] + third / 3.0 * (pair[1] - pair[0]));
                let found = DistanceExtremum::between(after, self.corner, [from, to]);
                if let Some(mut extremum) = found {
                    let problem =
                        RootProblem { target: 0.0, near: extremum.part, bracket: extremum.parts };
                    extremum.part = self.by_load[0].solve(&problem, LAST_STEP_ALONG_EDGE);
                    extremum.by_load_load = self.by_load_load(extremum.part);
                    extrema.push(extremum);
                }
                from = to;
            }
        }
        extrema
    }

    fn by_load_load(&self, part: f64) -> DVec2 {
        let [distance, phi] = &self.by_load;
        DVec2::new(distance.at(part).1, phi.at(part).1) / self.corner
    }
}
