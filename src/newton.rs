//! Newton's method for many shooting problems at once: a round shoots one trajectory for each open problem.
//!
//! The loop is independent of sheets, edges and level curves. A [`NewtonProblem`] proposes steps and accepts a state as its solution. The loop
//! gathers the initial conditions, stores the iterates, extrapolates short last steps, limits the number of trajectories and returns the
//! outcome.

use glam::DVec2;
use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method, OutputSet};
use whiskmap_mechanics::shooting::{FirstVariation, FullState, SecondVariation};

/// Step of a Newton iteration: what follows from the trajectory at an iterate.
#[derive(Clone, Copy, Debug)]
pub enum NewtonStep {
    /// The state at the iterate solves the Newton problem.
    Accept,
    /// The state after this step in `(tau, load)` solves the Newton problem. The step is so short that its end is extrapolated, not
    /// integrated.
    Extrapolate(DVec2),
    /// The next trajectory of the Newton problem starts at this `(tau, load)`.
    Shoot(DVec2),
    /// No step leads to a solution of the Newton problem.
    Fail,
}

/// Newton problem: root-finding in the plane of contact and load.
pub trait NewtonProblem<'a> {
    /// Output of the trajectories that the Newton problem needs.
    type Output: Extrapolate;

    /// Returns the rod whose trajectories the Newton problem needs.
    fn rod(&self) -> &'a Rod;

    /// Decides what follows from the trajectory `here`, which starts at `at = (tau, load)`.
    fn step(&mut self, at: DVec2, here: &Self::Output) -> NewtonStep;
}

/// Output of a trajectory from which nearby states can be extrapolated.
pub trait Extrapolate: OutputSet {
    /// State that is stored in an iterate of the Newton loop.
    type State: Copy + Default;

    /// Returns the state at the trajectory's initial condition.
    fn state(&self) -> Self::State;

    /// Returns the extrapolated state after `step` in `(tau, load)`.
    fn state_after(&self, step: DVec2) -> Self::State;
}

impl Extrapolate for FirstVariation {
    type State = FullState;

    fn state(&self) -> FullState {
        self.full
    }

    fn state_after(&self, step: DVec2) -> FullState {
        self.extrapolated(step)
    }
}

impl Extrapolate for SecondVariation {
    type State = Self;

    fn state(&self) -> Self {
        *self
    }

    fn state_after(&self, step: DVec2) -> Self {
        self.extrapolated(step)
    }
}

/// Outcome of a Newton iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewtonOutcome {
    /// The state of the last trajectory, or its extrapolation, solves the problem.
    Converged,
    /// The Newton iteration reached the limit on trajectories.
    OutOfTrajectories,
    /// A Newton step led to a number that is not finite, or to `tau <= 0`.
    OutsideDomain,
    /// The Newton iteration failed: the problem returned [`NewtonStep::Fail`].
    Failed,
}

/// Last iterate of a Newton problem.
#[derive(Clone, Copy, Debug)]
pub struct NewtonIterate<S> {
    /// Contact coordinate and signed load of the iterate, `(tau, load)`, dimensionless.
    pub point: DVec2,
    /// State of the last iterate: of the trajectory at `point`, or extrapolated from it.
    pub state: S,
    /// Number of Newton steps to the iterate, including the extrapolated one.
    pub steps: u32,
    /// Outcome of the Newton iteration.
    pub outcome: NewtonOutcome,
}

/// Which trajectories of the Newton loop may share a block of SIMD lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneSharing {
    /// Only trajectories with the same number of steps share a block. Results do not depend on the other problems.
    EqualSteps,
    /// All open Newton problems share padded blocks ([`Batch::padded`]).
    Open,
    /// All Newton problems share padded blocks, including solved ones, so that blocks take the same number of steps in every round.
    All,
}

/// Newton loop over a batch of problems: method, sharing of lanes and limits.
#[derive(Clone, Copy, Debug)]
pub struct BatchNewton {
    /// Integration method of the loop's trajectories.
    pub method: Method,
    /// Rule for the sharing of lanes in the loop.
    pub sharing: LaneSharing,
    /// Maximum number of trajectories for each Newton problem.
    pub most_trajectories: u32,
}

impl BatchNewton {
    /// Creates a Newton loop with at most `most_trajectories` for each problem by `method`. Results do not depend on the other problems.
    pub const fn new(method: Method, most_trajectories: u32) -> Self {
        Self { method, sharing: LaneSharing::EqualSteps, most_trajectories }
    }

    /// Iterates each of the `problems` from its start in `(tau, load)`, on the calling thread unless blocks are padded. Returns one
    /// iterate for each problem, `[problem]`, in the same order.
    pub fn solve<'a, P: NewtonProblem<'a>>(
        &self,
        problems: &mut [P],
        starts: impl IntoIterator<Item = DVec2>,
    ) -> Vec<NewtonIterate<<P::Output as Extrapolate>::State>> {
        let first = |point| NewtonIterate {
            point,
            state: Default::default(),
            steps: 0,
            outcome: NewtonOutcome::OutOfTrajectories,
        };
        let mut points: Vec<DVec2> = starts.into_iter().collect();
        let mut iterates: Vec<_> = points.iter().copied().map(first).collect();
        let mut open: Vec<usize> = (0..problems.len()).collect();
        let mut is_open = vec![true; problems.len()];
        for round in 0..self.most_trajectories {
            if open.is_empty() {
                break;
            }
            let condition = |i: &usize| InitialCondition::new(problems[*i].rod(), points[*i]);
            let conditions = open.iter().map(condition);
            let conditions: Vec<InitialCondition> = conditions.collect();
            self.shoot(&conditions, |place, here: &P::Output| {
                let i = open[place];
                if !is_open[i] {
                    return;
                }
                let (at, iterate) = (points[i], &mut iterates[i]);
                let step = problems[i].step(at, here);
                (iterate.point, iterate.state, iterate.steps) = (at, here.state(), round);
                let next = match step {
                    NewtonStep::Shoot(next) => Ok(next),
                    NewtonStep::Extrapolate(step) => {
                        points[i] = at + step;
                        iterate.point = points[i];
                        iterate.state = here.state_after(step);
                        iterate.steps += 1;
                        Err(NewtonOutcome::Converged)
                    }
                    NewtonStep::Accept => Err(NewtonOutcome::Converged),
                    NewtonStep::Fail => Err(NewtonOutcome::Failed),
                };
                match next {
                    Ok(next) if next.is_finite() && next.x > 0.0 => points[i] = next,
                    ended => {
                        is_open[i] = false;
                        iterate.outcome = ended.err().unwrap_or(NewtonOutcome::OutsideDomain);
                    }
                }
            });
            if self.sharing != LaneSharing::All {
                open.retain(|i| is_open[*i]);
            } else if !is_open.contains(&true) {
                break;
            }
        }
        iterates
    }

    /// Shoots `conditions` and passes the index and output of each trajectory to `take`, in any order.
    fn shoot<O: OutputSet>(
        &self,
        conditions: &[InitialCondition],
        mut take: impl FnMut(usize, &O),
    ) {
        let batch = Batch::new(self.method);
        if self.sharing == LaneSharing::EqualSteps {
            batch.for_each(conditions.iter().copied(), take);
        } else {
            let outputs: Vec<O> = batch.padded().shoot(conditions);
            let mut numbered = outputs.iter().enumerate();
            numbered.by_ref().for_each(|(i, output)| take(i, output));
        }
    }
}
