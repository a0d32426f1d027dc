//! Crossings: the points at which each row of a map leaves the stable sheet, over the fold (slip-off) or over the tip (pull-off).
//!
//! The edges form one closed line, touch - tip - corner - fold. Consecutive samples share their computed distance. A row crosses between
//! two samples if exactly one of them is at most at the row's distance. So the number of crossings has the right parity whatever the
//! rounding. Each crossing is predicted and then corrected.

use crate::newton::LaneSharing;
use crate::sheet::case::SheetCase;
use crate::sheet::edges::Edges;
use crate::sheet::edges::bisection::{EdgeBisection, bisect};
use crate::sheet::edges::edge_newton::{
    EdgeIterate, EdgeProblem, edge_newton, edge_newton_predicted,
};
use crate::sheet::edges::predictor::{EdgeSample, Prediction};
use crate::sheet::row::{Crossing, Edge, REACH_SLACK, Row};
use glam::DVec2;
use whiskmap_mechanics::numerics::nearest_turn;

/// Row with two samples of an edge between which it crosses, and the predicted crossing.
struct CrossingCandidate<'a> {
    row: usize,
    problem: EdgeProblem<'a>,
    /// Predicted direction of the pole in radians, continuous from first touch.
    phi: f64,
    between: [EdgeSample; 2],
}

impl CrossingCandidate<'_> {
    /// Returns true if `point` is between the samples.
    fn holds(&self, point: DVec2) -> bool {
        let [a, b] = self.between;
        let is_between = |x: f64, a: f64, b: f64| (x - a) * (x - b) <= 0.0;
        match self.problem.edge {
            Edge::Fold => is_between(point.x, a.tau, b.tau),
            Edge::Tip => is_between(point.y, a.load, b.load),
        }
    }
}

/// Largest relative difference between the fold load predicted from all samples and from the two neighbours alone. A larger one is a jump
/// of the first fold.
const FOLD_LOAD_TOLERANCE: f64 = 0.15;

/// Returns the predicted point of `edge` between two samples at which `ln D` is `target`.
fn predict(edges: &Edges, edge: Edge, pair: [&EdgeSample; 2], target: f64) -> Prediction {
    let by_all = edges.predict(edge, pair, target);
    let by_two = Prediction::linear(pair, target);
    if edge == Edge::Tip || (by_all.load / by_two.load - 1.0).abs() < FOLD_LOAD_TOLERANCE {
        by_all
    } else {
        by_two
    }
}

/// Returns the crossings of each row, `[row][crossing]`, sorted by push angle.
pub fn crossings(case: SheetCase, edges: &Edges, rows: &[Row]) -> Vec<Vec<Crossing>> {
    let targets: Vec<f64> =
        rows.iter().map(|row| libm::log(row.pole_distance) - REACH_SLACK).collect();
    let mut candidates = Vec::new();
    let mut found = vec![Vec::new(); rows.len()];
    for (edge, samples) in [(Edge::Fold, &edges.fold), (Edge::Tip, &edges.tip)] {
        for (after, pair) in samples.windows(2).enumerate() {
            let (a, b) = (pair[0], pair[1]);
            for (index, (row, target)) in rows.iter().zip(&targets).enumerate() {
                let reached = [a.ln_distance > *target, b.ln_distance > *target];
                // At first touch at the tip, the shape at rest decides. Where the integration puts the tip on the other side of the pole,
                // the row crosses there to the accuracy of the integration. A whisker that is touched elsewhere can have its tip nearer.
                let at_touch = edge == Edge::Tip
                    && after == 0
                    && (row.contact - row.end).abs() <= REACH_SLACK + 2.0 * edges.tip_error
                    && (row.is_at_reach() || row.is_reached() != reached[0]);
                if at_touch && row.is_reached() != reached[1] {
                    found[index].push(Crossing::at_touch(case.rod));
                } else if !at_touch && reached[0] != reached[1] {
                    let predicted = predict(edges, edge, [&a, &b], *target);
                    candidates.push(CrossingCandidate {
                        row: index,
                        problem: EdgeProblem {
                            rod: case.rod,
                            edge,
                            pole_distance: row.pole_distance,
                            start: DVec2::new(predicted.tau, predicted.load),
                            second: predicted.second,
                        },
                        phi: predicted.phi,
                        between: [a, b],
                    });
                }
            }
        }
    }
    let corrected = correct(case, rows, &candidates);
    for (candidate, crossing) in candidates.iter().zip(corrected) {
        found[candidate.row].push(crossing);
    }
    for row in &mut found {
        row.sort_by(|a, b| a.push.total_cmp(&b.push));
    }
    found
}

/// Corrects the candidates by Newton's method, or else by bisection between the samples; steep crossings are corrected again with twice
/// the steps. Returns one crossing for each candidate.
fn correct(case: SheetCase, rows: &[Row], candidates: &[CrossingCandidate]) -> Vec<Crossing> {
    let SheetCase { method, side, .. } = case;
    let problems: Vec<EdgeProblem> = candidates.iter().map(|c| c.problem).collect();
    let iterates = edge_newton_predicted(method, &problems);
    let reached = |(c, iterate): (&CrossingCandidate, &EdgeIterate)| {
        let map = &iterate.here.map;
        let phi = nearest_turn(map.pole.to_angle(), c.phi);
        Crossing {
            edge: c.problem.edge,
            tau: iterate.point.x,
            load: iterate.point.y,
            push: side.sign() * (phi - rows[c.row].touch),
            residual: iterate.residual,
            slope: c.problem.edge.slope(map),
        }
    };
    let mut corrected: Vec<Crossing> = candidates.iter().zip(&iterates).map(reached).collect();
    let has_failed =
        |i: &usize| !(corrected[*i].is_sound() && candidates[*i].holds(iterates[*i].point));
    let failed: Vec<usize> = (0..candidates.len()).filter(has_failed).collect();
    let between = failed.iter().map(|&i| {
        let CrossingCandidate { problem, between, .. } = candidates[i];
        EdgeBisection::new(problem.edge, between, libm::log(problem.pole_distance))
    });
    let bisected = bisect(case, between.collect());
    for (i, bisected) in failed.into_iter().zip(bisected) {
        let c = &candidates[i];
        let bisected = bisected.map(|iterate| reached((c, &iterate)));
        // Where the first fold jumps from contact to contact, there is nothing between the samples. The result of Newton's method may be
        // on another sheet, so continuation must decide.
        corrected[i] = bisected.filter(Crossing::is_sound).unwrap_or(Crossing {
            edge: c.problem.edge,
            tau: c.problem.start.x,
            load: c.problem.start.y,
            push: side.sign() * (c.phi - rows[c.row].touch),
            residual: f64::INFINITY,
            slope: f64::NAN,
        });
    }
    let is_steep = |i: &usize| corrected[*i].is_sound() && corrected[*i].is_steep();
    let steep: Vec<usize> = (0..candidates.len()).filter(is_steep).collect();
    let again: Vec<EdgeProblem> = steep
        .iter()
        .map(|&i| EdgeProblem {
            start: DVec2::new(corrected[i].tau, corrected[i].load),
            second: None,
            ..problems[i]
        })
        .collect();
    let finer = edge_newton(method.doubled(), LaneSharing::Open, &again);
    for (i, iterate) in steep.into_iter().zip(&finer) {
        let c = &candidates[i];
        let found = reached((c, iterate));
        if found.is_sound() && c.holds(iterate.point) {
            corrected[i] = found;
        } else {
            // Continuation must decide.
            corrected[i].residual = f64::INFINITY;
        }
    }
    corrected
}
