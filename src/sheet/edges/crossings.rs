//! Where each row of a map leaves the stable sheet: over the fold (slip-off) or over the tip (pull-off).
//!
//! The edges form one closed line, touch - tip - corner - fold; consecutive samples share their computed
//! distance, and a row crosses between two samples when exactly one of them is at most its own distance. So
//! the number of crossings has the right parity whatever the rounding.

use crate::numerics::nearest_turn;
use crate::rod::{PERFECT_CONE_CUT, Rod, Side};
use crate::sheet::edges::bracket::bisect;
use crate::sheet::edges::edge_newton::{Bends, Edge, Wanted, seek_nearby};
use crate::sheet::edges::{Edges, Sample};
use crate::sheet::fold::predictor::Near;
use crate::sheet::row::REACH_SLACK;
use crate::sheet::row::Row;
use crate::shooting::ShootingMap;
use crate::shooting::batch::Method;
use glam::DVec2;

/// A row's crossing of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Which edge.
    pub edge: Edge,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Push angle since first touch, in radians, as a magnitude on the row's side.
    pub push: f64,
    /// Remaining error, relative: the distance in `ln D`, and the square of how far the point still is (the push angle is flat
    /// at a fold).
    pub residual: f64,
}

/// The largest error, relative to the distance of the pole, of a crossing that is taken for one.
const SOUND: f64 = 1e-10;

impl Crossing {
    /// Whether Newton's method found it.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.residual <= SOUND
    }

    /// Of a row that meets the tip edge at first touch: without a load, whatever the resolution. The point of a perfect
    /// cone yields to any force, so it slips off.
    fn at_touch(rod: &Rod) -> Self {
        let pointed = rod.taper > 1.0 - PERFECT_CONE_CUT;
        Self {
            edge: if pointed { Edge::Fold } else { Edge::Tip },
            tau: rod.tau_tip(),
            load: 0.0,
            push: 0.0,
            residual: 0.0,
        }
    }

    /// Whether it is one of those.
    #[must_use]
    pub fn is_at_touch(&self) -> bool {
        self.load == 0.0
    }
}

/// A row and a place near its crossing.
struct Candidate {
    row: usize,
    edge: Edge,
    near: Near,
    /// The samples on both sides of it.
    between: [Sample; 2],
}

impl Candidate {
    /// Whether `point` is between the samples, or next to them.
    fn holds(&self, point: DVec2) -> bool {
        let [a, b] = self.between;
        let is_between = |x: f64, a: f64, b: f64| (x - a) * (x - b) <= NEXT_TO * (b - a).powi(2);
        match self.edge {
            Edge::Fold => is_between(point.x, a.tau, b.tau),
            Edge::Tip => is_between(point.y, a.load, b.load),
        }
    }
}

/// How far, in parts of their distance, a crossing may be outside of the samples that it is between but for rounding.
const NEXT_TO: f64 = 1e-9;

/// How much the load of a fold between two samples, as all samples around tell it, may differ from what the two alone tell: more
/// is a jump of the first fold.
const ASTRAY: f64 = 0.15;

/// The place on `edge` where `ln D` is `target` between two samples.
fn near(edges: &Edges, edge: Edge, pair: [&Sample; 2], target: f64) -> Near {
    match edge {
        Edge::Fold => {
            let by_all = edges.fold_line.at(pair, target);
            let by_two = Near::between(pair, target);
            if (by_all.load / by_two.load - 1.0).abs() < ASTRAY {
                by_all
            } else {
                by_two
            }
        }
        Edge::Tip => edges.tip_line.at(pair, target),
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
                        near: near(edges, edge, [&a, &b], *target),
                        between: [a, b],
                    });
                }
            }
        }
    }
    for (candidate, crossing) in candidates
        .iter()
        .zip(polish(method, rod, side, rows, &candidates))
    {
        found[candidate.row].push(crossing);
    }
    for row in &mut found {
        row.sort_by(|a, b| a.push.total_cmp(&b.push));
    }
    found
}

/// The crossings that the candidates lead to.
fn polish(
    method: Method,
    rod: &Rod,
    side: Side,
    rows: &[Row],
    candidates: &[Candidate],
) -> Vec<Crossing> {
    let wanted: Vec<Wanted> = candidates
        .iter()
        .map(|c| Wanted {
            rod: *rod,
            edge: c.edge,
            pole_distance: rows[c.row].pole_distance,
            from: DVec2::new(c.near.tau, c.near.load),
        })
        .collect();
    let bends: Vec<Option<Bends>> = candidates.iter().map(|c| c.near.bends).collect();
    let polished = seek_nearby(method, &wanted, &bends)
        .into_iter()
        .zip(candidates);
    polished
        .map(|(sought, c)| {
            let row = &rows[c.row];
            let crossing = |point: DVec2, map: &ShootingMap, residual: f64| {
                let phi = nearest_turn(map.pole.to_angle(), c.near.phi);
                Crossing {
                    edge: c.edge,
                    tau: point.x,
                    load: point.y,
                    push: side.sign() * (phi - row.touch),
                    residual,
                }
            };
            let residual = sought.miss.abs() + sought.left * sought.left;
            let newton = crossing(sought.point, &sought.here.map, residual);
            if newton.is_sound() && c.holds(sought.point) {
                return newton;
            }
            let bisected = bisect(method, rod, side, c.edge, row.pole_distance.ln(), c.between);
            let bisected = bisected.map(|(point, here)| {
                let distance = here.map.pole.length();
                let residual = (row.pole_distance / distance).ln().abs();
                crossing(point, &here.map, residual)
            });
            if let Some(bisected) = bisected.filter(Crossing::is_sound) {
                return bisected;
            }
            // The first fold jumps from contact to contact, and there is nothing between the samples. What Newton's
            // method has found may be on another sheet: the row must be walked.
            Crossing {
                edge: c.edge,
                tau: c.near.tau,
                load: c.near.load,
                push: side.sign() * (c.near.phi - row.touch),
                residual: f64::INFINITY,
            }
        })
        .collect()
}
