//! Edge Newton, the corrector of crossings: solves for the point of an edge at which the pole has a given distance. On the fold edge two
//! equations, for `D` and `det = 0`, determine contact and load. On the tip edge `D` alone determines the load.

use crate::newton::{BatchNewton, LaneSharing, NewtonOutcome, NewtonProblem, NewtonStep};
use crate::sheet::edges::predictor::SecondDerivatives;
use crate::sheet::row::Edge;
use glam::DVec2;
use whiskmap_mechanics::rod::{Rod, arclength};
use whiskmap_mechanics::shooting::batch::{Batch, Method};
use whiskmap_mechanics::shooting::{SecondVariation, ShootingMap, limited};

/// Newton problem for one point of an edge.
#[derive(Clone, Copy, Debug)]
pub struct EdgeProblem<'a> {
    /// Whisker and pole of the edge problem.
    pub rod: &'a Rod,
    /// Edge of the sheet on which the point lies.
    pub edge: Edge,
    /// Distance `D` of the pole's centre from the base, in whisker lengths.
    pub pole_distance: f64,
    /// Start of Newton's method, `(tau, load)`, dimensionless.
    pub start: DVec2,
    /// Second derivatives of `(ln D, phi)` at the start; `None` if the start is not a good prediction.
    pub second: Option<SecondDerivatives>,
}

/// Last iterate of the edge Newton for one point of an edge.
#[derive(Clone, Copy, Debug)]
pub struct EdgeIterate {
    /// Contact coordinate and signed load of the iterate, `(tau, load)`, dimensionless.
    pub point: DVec2,
    /// Pole of the iterate, with its first and second derivatives.
    pub here: SecondVariation,
    /// Remaining error of the iterate: the miss in `ln D`, plus the square of the remaining step as [`limited`] measures it. The
    /// remaining step is the square of the last one, or the step that was not taken.
    pub residual: f64,
    /// True if the last Newton step was short enough.
    pub has_converged: bool,
}

impl EdgeProblem<'_> {
    /// Returns the miss in `ln D` at the state `here`.
    fn miss(&self, here: &SecondVariation) -> f64 {
        libm::log(self.pole_distance / here.map.pole.length())
    }

    /// Returns the next step in `(tau, load)` from `at`, where the state is `here`, and its length.
    fn step(&self, at: DVec2, here: &SecondVariation) -> (DVec2, f64) {
        let miss = self.miss(here);
        let step = match self.edge {
            Edge::Fold => fold_step(here, miss),
            Edge::Tip => DVec2::new(0.0, load_step(here, miss)),
        };
        limited(step, arclength(self.rod, at.x), at.y)
    }

    /// Returns the iterate at `point`, from which a step of the length `left` remains.
    fn iterate(&self, point: DVec2, here: SecondVariation, left: f64) -> EdgeIterate {
        EdgeIterate {
            point,
            here,
            residual: self.miss(&here).abs() + left * left,
            has_converged: true,
        }
    }
}

/// Returns the step in load toward the point at the same contact whose `ln D` is larger by `miss`, to second order. Where the distance
/// has its maximum, as for a straight whisker at first touch, a first-order step would go half as far.
fn load_step(here: &SecondVariation, miss: f64) -> f64 {
    let (slope, second) = (here.map.by_load.x, here.by_load_load.x);
    let slope_there = (slope * slope + 2.0 * second * miss).max(0.0).sqrt();
    2.0 * miss / (slope + slope_there.copysign(slope))
}

/// Returns the step in `(tau, load)` toward the point of the fold whose `ln D` is larger by `miss`.
fn fold_step(here: &SecondVariation, miss: f64) -> DVec2 {
    let by_distance = DVec2::new(here.map.by_tau.x, here.map.by_load.x);
    let by_det = here.det_gradient();
    let sum = miss * by_det + here.map.det() * by_distance;
    -sum.perp() / by_distance.perp_dot(by_det)
}

/// Maximum number of trajectories of an edge problem; usually 1 or 2 suffice.
const EDGE_TRAJECTORIES: u32 = 20;

/// Step length whose end is extrapolated. The remaining step is its square, and second derivatives determine the end to its cube.
const LAST_EDGE_STEP: f64 = 3e-7;

/// Largest relative error of predicted second derivatives; usually it is 1e-3.
const SECOND_OFF: f64 = 1e-2;

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

/// Solves all `problems` of points on edges. Returns one iterate for each, `[problem]`, with its remaining error. Trajectories share blocks by
/// `sharing`: [`LaneSharing::Open`] is only for the batches of a sheet, whose problems do not depend on row batches.
#[must_use]
pub fn edge_newton(
    method: Method,
    sharing: LaneSharing,
    problems: &[EdgeProblem],
) -> Vec<EdgeIterate> {
    let newton = BatchNewton { sharing, ..BatchNewton::new(method, EDGE_TRAJECTORIES) };
    let search = |problem| EdgeSearch { problem, left: 0.0 };
    let mut searches: Vec<EdgeSearch> = problems.iter().map(search).collect();
    let iterates = newton.solve(&mut searches, problems.iter().map(|problem| problem.start));
    let ended = searches.iter().zip(iterates);
    let ended = ended.map(|(EdgeSearch { problem, left }, iterate)| EdgeIterate {
        has_converged: iterate.outcome == NewtonOutcome::Converged,
        ..problem.iterate(iterate.point, iterate.state, *left)
    });
    ended.collect()
}

/// Solves all `problems` of one rod from predictions, `[problem]`. With predicted second derivatives, most problems need one trajectory
/// with first derivatives. Toward the tip, second derivatives by the load are enough. This is one step of another kernel, not a loop.
#[must_use]
pub fn edge_newton_predicted(method: Method, problems: &[EdgeProblem]) -> Vec<EdgeIterate> {
    let Some(first) = problems.first() else {
        return Vec::new();
    };
    debug_assert!(problems.iter().all(|problem| std::ptr::eq(problem.rod, first.rod)));
    let starts = problems.iter().map(|problem| problem.start);
    let maps: Vec<ShootingMap> = Batch::new(method).padded().shoot_at(first.rod, starts);
    let mut open = Vec::new();
    let predicted = problems.iter().zip(maps).enumerate();
    let predicted = predicted.map(|(i, (problem, map))| {
        let [by_tau_tau, by_tau_load, by_load_load] = problem.second.unwrap_or_default();
        let here = SecondVariation { map, by_tau_tau, by_tau_load, by_load_load };
        let (step, length) = problem.step(problem.start, &here);
        let there = problem.start + step;
        // A length of NaN is not short.
        let is_last = problem.second.is_some() && length <= LAST_EDGE_STEP;
        if !is_last {
            // A long step, or one without second derivatives, can end far from the edge.
            let is_good = problem.second.is_some() && length < SECOND_OFF;
            let start = if is_good { there } else { problem.start };
            open.push((i, EdgeProblem { start, ..*problem }));
        }
        let left = length * length + SECOND_OFF * length;
        problem.iterate(there, here.extrapolated(step), left)
    });
    let mut iterates: Vec<EdgeIterate> = predicted.collect();
    let (places, again): (Vec<usize>, Vec<EdgeProblem>) = open.into_iter().unzip();
    let solved = edge_newton(method, LaneSharing::Open, &again);
    for (i, iterate) in places.into_iter().zip(solved) {
        iterates[i] = iterate;
    }
    iterates
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Starts are off by 1e-8 and 1e-5; second derivatives are known, wrong or missing.
    #[test]
    fn predictions_lead_to_the_same_point() {
        let rod = Rod { taper: 0.95, bend: 0.4, pole: 0.0125, ..Rod::default() };
        let method = Method::fine();
        let fold = DVec2::new(rod.tau(0.8), 12.0);
        let tip = DVec2::new(rod.tau_tip(), 3.0);
        let is_found = |iterate: &EdgeIterate| iterate.has_converged && iterate.residual < 1e-12;
        for (edge, start, along) in [(Edge::Fold, fold, DVec2::ONE), (Edge::Tip, tip, DVec2::Y)] {
            let mut problem =
                EdgeProblem { rod: &rod, edge, pole_distance: 0.75, start, second: None };
            if edge == Edge::Tip {
                let here: Vec<ShootingMap> = Batch::new(method).shoot_at(&rod, [start]);
                problem.pole_distance = here[0].pole.length();
            }
            let known = edge_newton(method, LaneSharing::Open, &[problem])[0];
            assert!(is_found(&known), "{edge:?}");
            let here = &known.here;
            let seconds = [here.by_tau_tau, here.by_tau_load, here.by_load_load];
            for off in [1e-8, 1e-5] {
                let start = known.point * (DVec2::ONE + off * along);
                for second in [Some(seconds), Some(seconds.map(|by| 1.1 * by)), None] {
                    let predicted = EdgeProblem { start, second, ..problem };
                    let found = edge_newton_predicted(method, &[predicted])[0];
                    let away = (found.point / known.point - DVec2::ONE).abs();
                    assert!(is_found(&found), "{edge:?} {off}");
                    assert!(away.max_element() < 2e-9, "{edge:?} {off}: {away}");
                    let [a, b] = [&found, &known].map(|iterate| iterate.here.map.pole.to_angle());
                    assert!((a - b).abs() < 1e-12, "{edge:?} {off}: {a} {b}");
                }
            }
        }
    }
}
