//! Edge Newton, the corrector: solves for the point of an edge at which the pole is at a distance. On the fold edge two equations
//! hold, `D` and `det = 0`, for contact and load; on the tip edge `D` alone, for the load.

use crate::rod::{Rod, arclength};
use crate::sheet::edges::predictor::SecondDerivatives;
use crate::sheet::row::Edge;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{SecondVariation, ShootingMap, limited};
use glam::DVec2;

/// A point of an edge to solve for.
#[derive(Clone, Copy, Debug)]
pub struct EdgeProblem<'a> {
    /// The whisker and its pole.
    pub rod: &'a Rod,
    /// The edge.
    pub edge: Edge,
    /// Distance of the pole's centre.
    pub pole_distance: f64,
    /// `(tau, load)` to start from.
    pub start: DVec2,
    /// Second derivatives there, if the start is a good prediction.
    pub second: Option<SecondDerivatives>,
}

/// Where Newton's method stands.
#[derive(Clone, Copy, Debug)]
pub struct EdgeIterate {
    /// `(tau, load)`.
    pub point: DVec2,
    /// The pole there.
    pub here: SecondVariation,
    /// What is missing in `ln D`.
    pub miss: f64,
    /// How far it still is, as [`limited`] measures lengths: the square of the last step, or the step not taken any more.
    pub left: f64,
    /// Whether a step was short enough to be the last one.
    pub has_converged: bool,
}

/// Iterations at the coarse resolution: from the guess of a cell next to the fold they lead to its error.
const COARSE_ITERATIONS: usize = 2;

/// Iterations at the method's own resolution; 1 or 2 are the rule.
const FINE_ITERATIONS: usize = 20;

/// The length of a step that needs no trajectory at its end: what is left after it is its square, and second derivatives
/// tell the rest to its cube.
const LAST_EDGE_STEP: f64 = 3e-7;

/// How far off, relatively, predicted second derivatives are at the most; 1e-3 is the rule.
const SECOND_OFF: f64 = 1e-2;

/// Solves all `problems`, first at the coarse resolution; the caller judges what is left in `miss` and `left`. Trajectories are not
/// padded: which problems next to the folds of a map come together depends on its strips, and no answer may.
#[must_use]
pub fn edge_newton(method: Method, problems: &[EdgeProblem]) -> Vec<EdgeIterate> {
    iterate(method, problems, COARSE_ITERATIONS, Batch::new)
}

/// The same at the method's own resolution throughout: for starts that are good already, and for whiskers that friction lets
/// coil up, where the coarse one leads astray.
#[must_use]
pub fn edge_newton_fine(method: Method, problems: &[EdgeProblem]) -> Vec<EdgeIterate> {
    iterate(method, problems, 0, |method| Batch::new(method).padded())
}

/// The same, and each answer is as if it were computed alone.
#[must_use]
pub fn edge_newton_unpadded(method: Method, problems: &[EdgeProblem]) -> Vec<EdgeIterate> {
    iterate(method, problems, 0, Batch::new)
}

/// The same from predictions. With their second derivatives most need a single trajectory, with first derivatives; toward the tip
/// those by the load are enough.
#[must_use]
pub fn edge_newton_predicted(method: Method, problems: &[EdgeProblem]) -> Vec<EdgeIterate> {
    let conditions: Vec<InitialCondition> = problems
        .iter()
        .map(|problem| condition(problem, problem.start))
        .collect();
    let maps = Batch::new(method)
        .padded()
        .shoot::<ShootingMap>(&conditions);
    let mut iterates = Vec::with_capacity(problems.len());
    let (mut open, mut again) = (Vec::new(), Vec::new());
    for (i, (problem, map)) in problems.iter().zip(maps).enumerate() {
        let [by_tau_tau, by_tau_load, by_load_load] = problem.second.unwrap_or_default();
        let here = SecondVariation {
            map,
            by_tau_tau,
            by_tau_load,
            by_load_load,
        };
        let last_step = problem.second.map(|_| LAST_EDGE_STEP);
        let (mut iterate, next) = newton_step(problem, problem.start, &here, last_step);
        if iterate.has_converged {
            iterate.left += SECOND_OFF * iterate.left.sqrt();
        } else {
            // A long step, or one of unknown second derivatives, can lead astray.
            let is_good = problem.second.is_some() && iterate.left < SECOND_OFF;
            let start = if is_good { next } else { problem.start };
            open.push(i);
            again.push(EdgeProblem { start, ..*problem });
        }
        iterates.push(iterate);
    }
    for (i, iterate) in open.into_iter().zip(edge_newton_fine(method, &again)) {
        iterates[i] = iterate;
    }
    iterates
}

fn condition<'a>(problem: &EdgeProblem<'a>, point: DVec2) -> InitialCondition<'a> {
    InitialCondition {
        rod: problem.rod,
        tau: point.x,
        load: point.y,
    }
}

fn iterate(
    method: Method,
    problems: &[EdgeProblem],
    coarse_iterations: usize,
    batch: fn(Method) -> Batch,
) -> Vec<EdgeIterate> {
    let mut points: Vec<DVec2> = problems.iter().map(|problem| problem.start).collect();
    let mut iterates: Vec<Option<EdgeIterate>> = vec![None; problems.len()];
    let mut open: Vec<usize> = (0..problems.len()).collect();
    for iteration in 0..coarse_iterations + FINE_ITERATIONS {
        if open.is_empty() {
            break;
        }
        let is_coarse = iteration < coarse_iterations;
        let method = if is_coarse { method.coarsely() } else { method };
        let last_step = (!is_coarse).then_some(LAST_EDGE_STEP);
        let conditions: Vec<InitialCondition> = open
            .iter()
            .map(|&i| condition(&problems[i], points[i]))
            .collect();
        let shots: Vec<SecondVariation> = batch(method).shoot(&conditions);
        let mut shots = shots.into_iter();
        open.retain(|&i| {
            let Some(here) = shots.next() else {
                return false;
            };
            let (iterate, next) = newton_step(&problems[i], points[i], &here, last_step);
            points[i] = next;
            iterates[i] = Some(iterate);
            !iterate.has_converged && next.is_finite() && next.x > 0.0
        });
    }
    iterates.into_iter().flatten().collect()
}

/// The iterate at `point`, where the pole is `here`, and the next point. A step of at most `last_step` is taken already: the iterate
/// is then the one at its end.
fn newton_step(
    problem: &EdgeProblem,
    point: DVec2,
    here: &SecondVariation,
    last_step: Option<f64>,
) -> (EdgeIterate, DVec2) {
    let miss = |here: &SecondVariation| libm::log(problem.pole_distance / here.map.pole.length());
    let step = match problem.edge {
        Edge::Fold => fold_step(here, miss(here)),
        Edge::Tip => DVec2::new(0.0, load_step(here, miss(here))),
    };
    let (step, length) = limited(step, arclength(problem.rod, point.x), point.y);
    let next = point + step;
    let has_converged = last_step.is_some_and(|last| length <= last);
    let (point, here, left) = if has_converged {
        (next, here.extrapolated(step), length * length)
    } else {
        (point, *here, length)
    };
    let iterate = EdgeIterate {
        point,
        here,
        miss: miss(&here),
        left,
        has_converged,
    };
    (iterate, next)
}

/// The step in load toward the point at the same contact whose `ln D` is larger by `miss`, to second order: where the distance is
/// largest, as that of a straight whisker is at first touch, a step of first order would go half the way.
fn load_step(here: &SecondVariation, miss: f64) -> f64 {
    let (slope, second) = (here.map.by_load.x, here.by_load_load.x);
    let slope_there = (slope * slope + 2.0 * second * miss).max(0.0).sqrt();
    2.0 * miss / (slope + slope_there.copysign(slope))
}

/// The step toward the point of the fold whose `ln D` is larger by `miss`.
fn fold_step(here: &SecondVariation, miss: f64) -> DVec2 {
    let by_distance = DVec2::new(here.map.by_tau.x, here.map.by_load.x);
    let by_det = here.det_gradient();
    let det = here.map.det();
    DVec2::new(
        miss * by_det.y + det * by_distance.y,
        -miss * by_det.x - det * by_distance.x,
    ) / by_distance.perp_dot(by_det)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From starts off by 1e-8 and 1e-5, with known second derivatives, with wrong ones and with none.
    #[test]
    fn predictions_lead_to_the_same_point() {
        let rod = Rod {
            taper: 0.95,
            bend: 0.4,
            pole: 0.0125,
            ..Rod::default()
        };
        let method = Method::fine();
        let fold = DVec2::new(rod.tau(0.8), 12.0);
        let tip = DVec2::new(rod.tau_tip(), 3.0);
        for (edge, start) in [(Edge::Fold, fold), (Edge::Tip, tip)] {
            let mut problem = EdgeProblem {
                rod: &rod,
                edge,
                pole_distance: 0.75,
                start,
                second: None,
            };
            if edge == Edge::Tip {
                let at_start = [condition(&problem, start)];
                let here = Batch::new(method).shoot::<SecondVariation>(&at_start)[0];
                problem.pole_distance = here.map.pole.length();
            }
            let known = edge_newton_fine(method, &[problem])[0];
            assert!(known.has_converged && known.miss.abs() < 1e-12, "{edge:?}");
            let here = &known.here;
            let seconds = [here.by_tau_tau, here.by_tau_load, here.by_load_load];
            for off in [1e-8, 1e-5] {
                let moved = DVec2::new(if edge == Edge::Fold { off } else { 0.0 }, off);
                let start = known.point * (DVec2::ONE + moved);
                for second in [Some(seconds), Some(seconds.map(|by| 1.1 * by)), None] {
                    let predicted = EdgeProblem {
                        start,
                        second,
                        ..problem
                    };
                    let found = edge_newton_predicted(method, &[predicted])[0];
                    let away = (found.point / known.point - DVec2::ONE).abs();
                    assert!(
                        found.has_converged && found.miss.abs() < 1e-12,
                        "{edge:?} {off}"
                    );
                    assert!(away.max_element() < 2e-9, "{edge:?} {off}: {away}");
                    let [a, b] = [&found, &known].map(|iterate| iterate.here.map.pole.to_angle());
                    assert!((a - b).abs() < 1e-12, "{edge:?} {off}: {a} {b}");
                }
            }
        }
    }
}
