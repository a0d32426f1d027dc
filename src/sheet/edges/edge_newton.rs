//! Edge Newton, the corrector of crossings: solves for the point of an edge at which the pole has a given distance. On the fold edge two
//! equations, for `D` and `det = 0`, determine contact and load. On the tip edge `D` alone determines the load.

use crate::newton::{BatchNewton, LaneSharing, NewtonOutcome, NewtonProblem, NewtonStep};
use crate::rod::Rod;
use crate::sheet::edges::edge_problem::EdgeProblem;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{SecondVariation, ShootingMap};
use glam::DVec2;

/// Last iterate of an edge Newton.
#[derive(Clone, Copy, Debug)]
pub struct EdgeIterate {
    /// Contact coordinate and signed load, `(tau, load)`.
    pub point: DVec2,
    /// Pole and derivatives at `point`.
    pub here: SecondVariation,
    /// Remaining miss in `ln D`.
    pub miss: f64,
    /// Remaining step length, as [`limited`](crate::shooting::limited) measures it: the square of the last step, or the step that was not taken.
    pub left: f64,
    /// True if a step was short enough to be the last one.
    pub has_converged: bool,
}

/// Number of rounds at the coarse resolution. From the guess of a cell next to the fold, they reach the error of that resolution.
const COARSE_ROUNDS: u32 = 2;

/// Maximum number of trajectories at the method's own resolution; usually 1 or 2 suffice.
const EDGE_TRAJECTORIES: u32 = 20;

/// Step length whose end is extrapolated. The remaining step is its square, and second derivatives determine the end to its cube.
const LAST_EDGE_STEP: f64 = 3e-7;

/// Largest relative error of predicted second derivatives; usually it is 1e-3.
const SECOND_OFF: f64 = 1e-2;

/// Quality of the starts of an edge Newton, which decides the resolution and batching of its trajectories.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeStart {
    /// The first trajectories are coarse: for starts next to the edge, such as the guesses of cells.
    Coarse,
    /// All trajectories have the method's resolution: for good starts, and for whiskers that coil up under friction, where the coarse
    /// resolution fails.
    Fine,
    /// All trajectories have the method's resolution and share padded blocks: for the batches of a sheet, which do not depend on row
    /// batches.
    Shared,
}

/// Iteration of one edge problem.
struct EdgeSearch<'a, 'b> {
    problem: &'b EdgeProblem<'a>,
    left: f64,
}

impl<'a> NewtonProblem<'a> for EdgeSearch<'a, '_> {
    type Output = SecondVariation;

    fn rod(&self) -> &'a Rod {
        self.problem.rod
    }

    fn step(&mut self, at: DVec2, here: &SecondVariation) -> NewtonStep {
        let (step, length) = self.problem.step(at, here);
        if length <= LAST_EDGE_STEP {
            self.left = length * length;
            NewtonStep::Extrapolate(step)
        } else {
            self.left = length;
            NewtonStep::Shoot(at + step)
        }
    }
}

/// Solves all `problems`. Returns one iterate for each, with its remaining error in `miss` and `left`.
#[must_use]
pub fn edge_newton(method: Method, start: EdgeStart, problems: &[EdgeProblem]) -> Vec<EdgeIterate> {
    let newton = BatchNewton::new(method, EDGE_TRAJECTORIES);
    let newton = match start {
        EdgeStart::Coarse => BatchNewton {
            coarse_rounds: COARSE_ROUNDS,
            most_trajectories: COARSE_ROUNDS + EDGE_TRAJECTORIES,
            ..newton
        },
        EdgeStart::Fine => newton,
        EdgeStart::Shared => BatchNewton {
            sharing: LaneSharing::Open,
            ..newton
        },
    };
    let search = |problem| EdgeSearch { problem, left: 0.0 };
    let mut searches: Vec<EdgeSearch> = problems.iter().map(search).collect();
    let iterates = newton.solve(&mut searches, problems.iter().map(|problem| problem.start));
    let ended = searches.iter().zip(iterates);
    let ended = ended.map(|(search, iterate)| EdgeIterate {
        point: iterate.point,
        here: iterate.state,
        miss: search.problem.miss(&iterate.state),
        left: search.left,
        has_converged: iterate.outcome == NewtonOutcome::Converged,
    });
    ended.collect()
}

/// Solves all `problems` from predictions. With predicted second derivatives, most problems need a single trajectory with first
/// derivatives. Toward the tip, second derivatives by the load are enough. This is one step of another kernel, not a loop.
#[must_use]
pub fn edge_newton_predicted(method: Method, problems: &[EdgeProblem]) -> Vec<EdgeIterate> {
    let conditions = problems.iter().map(|problem| InitialCondition {
        rod: problem.rod,
        tau: problem.start.x,
        load: problem.start.y,
    });
    let conditions: Vec<InitialCondition> = conditions.collect();
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
        let (step, length) = problem.step(problem.start, &here);
        let there = here.extrapolated(step);
        let is_last = problem.second.is_some() && length <= LAST_EDGE_STEP;
        if !is_last {
            // A long step, or one without second derivatives, can end far from the edge.
            let is_good = problem.second.is_some() && length < SECOND_OFF;
            let start = problem.start + if is_good { step } else { DVec2::ZERO };
            open.push(i);
            again.push(EdgeProblem { start, ..*problem });
        }
        let left = length * length;
        iterates.push(EdgeIterate {
            point: problem.start + step,
            here: there,
            miss: problem.miss(&there),
            left: left + SECOND_OFF * left.sqrt(),
            has_converged: is_last,
        });
    }
    for (i, iterate) in open
        .into_iter()
        .zip(edge_newton(method, EdgeStart::Shared, &again))
    {
        iterates[i] = iterate;
    }
    iterates
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::row::Edge;

    /// Starts are off by 1e-8 and 1e-5; second derivatives are known, wrong or missing.
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
                let at_start = [InitialCondition {
                    rod: &rod,
                    tau: start.x,
                    load: start.y,
                }];
                let here = Batch::new(method).shoot::<SecondVariation>(&at_start)[0];
                problem.pole_distance = here.map.pole.length();
            }
            let known = edge_newton(method, EdgeStart::Shared, &[problem])[0];
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
