//! Where each row of a map leaves the stable sheet: over the fold (slip-off) or over the tip (pull-off).
//!
//! The edges form one closed line, touch - tip - corner - fold; consecutive samples share their computed
//! distance, and a row crosses between two samples when exactly one of them is at most its own distance. So
//! the number of crossings has the right parity whatever the rounding. Where a row crosses is predicted, and then corrected.

use crate::numerics::{Bracket, nearest_turn};
use crate::rod::{Rod, Side};
use crate::sheet::edges::Edges;
use crate::sheet::edges::edge_newton::{EdgeProblem, edge_newton_predicted};
use crate::sheet::edges::predictor::{Prediction, Sample};
use crate::sheet::fold::first_folds;
use crate::sheet::row::{Crossing, Edge, REACH_SLACK, Row};
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{SecondVariation, ShootingMap};
use glam::DVec2;

/// A row, and two samples of an edge between which it crosses.
struct Candidate {
    row: usize,
    edge: Edge,
    predicted: Prediction,
    between: [Sample; 2],
}

/// How far, in parts of their distance, a crossing may be outside of the samples that it is between but for rounding.
const OUTSIDE: f64 = 1e-9;

impl Candidate {
    /// Whether `point` is between the samples.
    fn holds(&self, point: DVec2) -> bool {
        let [a, b] = self.between;
        let is_between = |x: f64, a: f64, b: f64| (x - a) * (x - b) <= OUTSIDE * (b - a).powi(2);
        match self.edge {
            Edge::Fold => is_between(point.x, a.tau, b.tau),
            Edge::Tip => is_between(point.y, a.load, b.load),
        }
    }
}

/// How much the load of a fold between two samples, as all samples around tell it, may differ from what the two alone tell: more
/// is a jump of the first fold.
const ASTRAY: f64 = 0.15;

/// Where `ln D` is `target` on `edge` between two samples.
fn predict(edges: &Edges, edge: Edge, pair: [&Sample; 2], target: f64) -> Prediction {
    let by_all = edges.predict(edge, pair, target);
    let by_two = Prediction::linear(pair, target);
    if edge == Edge::Tip || (by_all.load / by_two.load - 1.0).abs() < ASTRAY {
        by_all
    } else {
        by_two
    }
}

/// Every crossing of every row, sorted by push angle.
pub fn crossings(
    method: Method,
    rod: &Rod,
    side: Side,
    edges: &Edges,
    rows: &[Row],
) -> Vec<Vec<Crossing>> {
    let targets: Vec<f64> = rows
        .iter()
        .map(|row| row.pole_distance.ln() - REACH_SLACK)
        .collect();
    let mut candidates = Vec::new();
    let mut found = vec![Vec::new(); rows.len()];
    for (edge, samples) in [(Edge::Fold, &edges.fold), (Edge::Tip, &edges.tip)] {
        for (after, pair) in samples.windows(2).enumerate() {
            let (a, b) = (pair[0], pair[1]);
            for (index, (row, target)) in rows.iter().zip(&targets).enumerate() {
                let reached = [a, b].map(|sample| sample.ln_distance > *target);
                // At first touch the shape at rest decides. Where the integration puts the tip on the other side of the
                // pole, the two cross there as nearly as it can tell.
                let at_touch = edge == Edge::Tip
                    && after == 0
                    && (row.is_at_reach() || row.is_reached() != reached[0]);
                if at_touch && row.is_reached() != reached[1] {
                    found[index].push(Crossing::at_touch(rod));
                } else if !at_touch && reached[0] != reached[1] {
                    candidates.push(Candidate {
                        row: index,
                        edge,
                        predicted: predict(edges, edge, [&a, &b], *target),
                        between: [a, b],
                    });
                }
            }
        }
    }
    let corrected = correct(method, rod, side, rows, &candidates);
    for (candidate, crossing) in candidates.iter().zip(corrected) {
        found[candidate.row].push(crossing);
    }
    for row in &mut found {
        row.sort_by(|a, b| a.push.total_cmp(&b.push));
    }
    found
}

/// The crossings that the candidates lead to: by Newton's method, else by bisection between the samples.
fn correct(
    method: Method,
    rod: &Rod,
    side: Side,
    rows: &[Row],
    candidates: &[Candidate],
) -> Vec<Crossing> {
    let problems: Vec<EdgeProblem> = candidates
        .iter()
        .map(|c| EdgeProblem {
            rod,
            edge: c.edge,
            pole_distance: rows[c.row].pole_distance,
            start: DVec2::new(c.predicted.tau, c.predicted.load),
            second: c.predicted.second,
        })
        .collect();
    let iterates = edge_newton_predicted(method, &problems);
    let corrected = iterates.into_iter().zip(candidates).map(|(iterate, c)| {
        let row = &rows[c.row];
        let crossing = |point: DVec2, map: &ShootingMap, residual: f64| {
            let phi = nearest_turn(map.pole.to_angle(), c.predicted.phi);
            Crossing {
                edge: c.edge,
                tau: point.x,
                load: point.y,
                push: side.sign() * (phi - row.touch),
                residual,
            }
        };
        let residual = iterate.miss.abs() + iterate.left * iterate.left;
        let newton = crossing(iterate.point, &iterate.here.map, residual);
        if newton.is_sound() && c.holds(iterate.point) {
            return newton;
        }
        let bisected = bisect(method, rod, side, c, row.pole_distance.ln());
        let bisected = bisected.map(|(point, here)| {
            let distance = here.map.pole.length();
            let residual = (row.pole_distance / distance).ln().abs();
            crossing(point, &here.map, residual)
        });
        // Where the first fold jumps from contact to contact, there is nothing between the samples. What Newton's method
        // has found may be on another sheet: continuation must tell.
        bisected.filter(Crossing::is_sound).unwrap_or(Crossing {
            edge: c.edge,
            tau: c.predicted.tau,
            load: c.predicted.load,
            push: side.sign() * (c.predicted.phi - row.touch),
            residual: f64::INFINITY,
        })
    });
    corrected.collect()
}

/// Halvings: more than a mantissa has bits.
const HALVINGS: usize = 64;

/// After so many halvings it is told by how much the distance still changes, in parts of what it has been seen to miss, that it leaps: as
/// the first fold does from contact to contact. The change of a square root would have fallen to a 64th.
const TELLING: usize = 12;
const LEAP: f64 = 0.25;

/// The point `(tau, load)` of an edge at which `ln D` is `target`, where Newton's method loses it because the distance turns nearby.
/// If both samples are on the same side of it, the one that is closer. `None` where a fold is missing, or the distance leaps
/// over the target.
fn bisect(
    method: Method,
    rod: &Rod,
    side: Side,
    candidate: &Candidate,
    target: f64,
) -> Option<(DVec2, SecondVariation)> {
    let [from, to] = candidate.between;
    let between = |part: f64| -> Option<(DVec2, SecondVariation)> {
        let tau = from.tau + part * (to.tau - from.tau);
        if candidate.edge == Edge::Fold {
            let fold = first_folds(method, rod, side, &[tau]).pop()??;
            return Some((DVec2::new(tau, fold.load), fold.variation));
        }
        let load = from.load + part * (to.load - from.load);
        let shot =
            Batch::new(method).shoot::<SecondVariation>(&[InitialCondition { rod, tau, load }]);
        Some((DVec2::new(tau, load), *shot.first()?))
    };
    let misses = [from, to].map(|sample| sample.ln_distance - target);
    if (misses[0] <= 0.0) == (misses[1] <= 0.0) {
        let is_from_closer = misses[0].abs() <= misses[1].abs();
        return between(if is_from_closer { 0.0 } else { 1.0 });
    }
    let mut parts = Bracket::new([0.0, 1.0], misses);
    let mut ends = misses;
    let mut largest = misses[0].abs().max(misses[1].abs());
    for halving in 0..HALVINGS {
        if halving >= TELLING && (ends[1] - ends[0]).abs() > LEAP * largest {
            return None;
        }
        let middle = parts.middle();
        let (_, here) = between(middle)?;
        let miss = here.map.pole.length().ln() - target;
        parts.shrink(middle, miss);
        largest = largest.max(miss.abs());
        ends[usize::from((miss <= 0.0) != (ends[0] <= 0.0))] = miss;
    }
    between(parts.middle())
}
