//! Newton's method on many shooting problems at once: a round shoots one trajectory for each problem that is open.
//!
//! The loop knows no sheet, no edge and no level curve. A [`Problem`] proposes steps and says when a state solves it. The loop gathers the
//! initial conditions, keeps the iterates, extrapolates short last steps, bounds the number of trajectories and names the outcome.

use crate::rod::Rod;
use crate::shooting::batch::{Batch, InitialCondition, Method, OutputSet};
use crate::shooting::{FirstVariation, FullState, SecondVariation};
use glam::DVec2;

/// What a problem makes of the trajectory at an iterate.
#[derive(Clone, Copy, Debug)]
pub enum NewtonStep {
    /// The state at the iterate solves the problem.
    Accept,
    /// The state after this step in `(tau, load)` solves it. The step is so short that its end is extrapolated, not integrated.
    Extrapolate(DVec2),
    /// The next trajectory starts at this `(tau, load)`.
    Shoot(DVec2),
    /// No step leads to a solution.
    Fail,
}

/// A root to find in the plane of contact and load.
pub trait Problem<'a> {
    /// What a trajectory computes.
    type Output: Extrapolate;

    /// The rod that is shot.
    fn rod(&self) -> &'a Rod;

    /// Decides what follows from the trajectory `here`, which starts at `at = (tau, load)`.
    fn step(&mut self, at: DVec2, here: &Self::Output) -> NewtonStep;
}

/// An output of trajectories whose state can be extrapolated.
pub trait Extrapolate: OutputSet {
    /// The state that an iterate keeps.
    type State: Copy + Default;

    /// The state at the trajectory's initial condition.
    fn state(&self) -> Self::State;

    /// The state after `step` in `(tau, load)`.
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

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewtonOutcome {
    /// The last trajectory's state, or its extrapolation, solves the problem.
    Converged,
    /// The trajectories allowed did not suffice.
    OutOfTrajectories,
    /// A step led to a number that is not finite, or to `tau <= 0`.
    OutsideDomain,
    /// The problem gave up.
    Failed,
}

/// The last iterate of a problem.
#[derive(Clone, Copy, Debug)]
pub struct Iterate<S> {
    /// `(tau, load)`.
    pub point: DVec2,
    /// The state there.
    pub state: S,
    /// Steps taken, the extrapolated one included.
    pub steps: u32,
    /// How the iteration ended.
    pub outcome: NewtonOutcome,
}

/// Which trajectories share blocks of lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// Trajectories of equal steps only: no result depends on the other problems.
    EqualSteps,
    /// All open problems, in padded blocks ([`Batch::padded`]).
    Open,
    /// All problems in padded blocks, solved ones included, so that blocks take as many steps in every round.
    All,
}

/// The loop.
#[derive(Clone, Copy, Debug)]
pub struct BatchNewton {
    /// How trajectories are integrated.
    pub method: Method,
    /// Which trajectories share blocks.
    pub sharing: Sharing,
    /// Rounds at the coarse resolution, which come first and accept no state.
    pub coarse_rounds: u32,
    /// Most trajectories of a problem.
    pub most_trajectories: u32,
}

impl BatchNewton {
    /// At most `most_trajectories` for each problem by `method`; no result depends on the other problems.
    pub const fn new(method: Method, most_trajectories: u32) -> Self {
        Self {
            method,
            sharing: Sharing::EqualSteps,
            coarse_rounds: 0,
            most_trajectories,
        }
    }

    /// Iterates each of the `problems` from its start in `(tau, load)`, on this thread unless blocks are padded.
    pub fn solve<'a, P: Problem<'a>>(
        &self,
        problems: &mut [P],
        starts: impl IntoIterator<Item = DVec2>,
    ) -> Vec<Iterate<<P::Output as Extrapolate>::State>> {
        let first = |point| Iterate {
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
            let is_coarse = round < self.coarse_rounds;
            let conditions = open.iter().map(|&i| InitialCondition {
                rod: problems[i].rod(),
                tau: points[i].x,
                load: points[i].y,
            });
            let conditions: Vec<InitialCondition> = conditions.collect();
            self.shoot(is_coarse, &conditions, |place, here: &P::Output| {
                let i = open[place];
                if !is_open[i] {
                    return;
                }
                let (at, iterate) = (points[i], &mut iterates[i]);
                let step = problems[i].step(at, here);
                (iterate.point, iterate.state, iterate.steps) = (at, here.state(), round);
                let next = match step {
                    NewtonStep::Extrapolate(step) if is_coarse => Ok(at + step),
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
            if self.sharing != Sharing::All {
                open.retain(|i| is_open[*i]);
            } else if !is_open.contains(&true) {
                break;
            }
        }
        iterates
    }

    /// Shoots `conditions` and passes the index and the output of each to `take`, in any order.
    fn shoot<O: OutputSet>(
        &self,
        is_coarse: bool,
        conditions: &[InitialCondition],
        mut take: impl FnMut(usize, &O),
    ) {
        let method = match is_coarse {
            true => self.method.coarsely(),
            false => self.method,
        };
        let batch = Batch::new(method);
        if self.sharing == Sharing::EqualSteps {
            batch.for_each(conditions.iter().copied(), take);
        } else {
            let outputs: Vec<O> = batch.padded().shoot(conditions);
            let mut numbered = outputs.iter().enumerate();
            numbered.by_ref().for_each(|(i, output)| take(i, output));
        }
    }
}
