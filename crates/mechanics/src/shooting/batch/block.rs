//! Block of trajectories that are integrated together, and their numbers of steps.

use super::gather::{Conditions, numbers};
use super::{InitialCondition, Method};
use crate::numerics::{Lanes, SimdTask, WIDTH};
use crate::rod::radius_and_arclength;

/// Block of initial conditions of trajectories that are integrated together, at most as many as there are lanes.
pub struct Block<'a> {
    pub method: Method,
    /// The lanes after the last condition repeat it.
    conditions: Conditions<'a>,
    count: usize,
}

impl<'a> Block<'a> {
    /// Creates a block of the first `count` conditions, at least 1, to integrate by `method`.
    pub fn new(
        method: Method,
        count: usize,
        condition: impl Fn(usize) -> &'a InitialCondition<'a>,
    ) -> Self {
        Self {
            method,
            conditions: std::array::from_fn(|lane| condition(lane.min(count - 1))),
            count,
        }
    }

    /// Returns the results of `compute` for all conditions, which it gets in parts of as many as `T` has lanes.
    #[inline(always)]
    pub fn in_parts<T: Lanes, A: Copy + Default>(
        &self,
        compute: impl Fn(&Conditions) -> [A; WIDTH],
    ) -> [A; WIDTH] {
        if T::LANES == WIDTH {
            return compute(&self.conditions);
        }
        let mut outputs = [A::default(); WIDTH];
        for (conditions, outputs) in
            self.conditions[..self.count].chunks(T::LANES).zip(outputs.chunks_mut(T::LANES))
        {
            let part =
                compute(&std::array::from_fn(|lane| conditions[lane.min(conditions.len() - 1)]));
            outputs.copy_from_slice(&part[..outputs.len()]);
        }
        outputs
    }
}

/// Task that computes the number of steps of each trajectory of a block: `[lane]`; 0 along a profile.
pub struct StepCounts<'a>(pub &'a Block<'a>);

impl SimdTask for StepCounts<'_> {
    type Output = [u32; WIDTH];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let Self(block) = self;
        block.in_parts::<T, _>(|conditions| steps::<T>(block.method, conditions))
    }
}

#[inline(always)]
fn steps<T: Lanes>(method: Method, conditions: &Conditions) -> [u32; WIDTH] {
    let resolution = method.resolution;
    let taper = numbers(conditions, |condition| condition.rod.taper);
    let tau = numbers(conditions, |condition| condition.tau);
    let [_, s] = radius_and_arclength(T::pack(taper), T::pack(tau));
    let s = s.unpack();
    let mut steps = [0; WIDTH];
    if conditions.iter().any(|c| !c.rod.is_uniform_cone()) {
        for (lane, condition) in conditions.iter().enumerate() {
            let InitialCondition { rod, tau, load } = condition;
            if rod.profile.is_none() {
                steps[lane] = resolution.steps_from(rod, *tau, *load, s[lane]);
            }
        }
    } else {
        let bend = numbers(conditions, |condition| condition.rod.sharpest_bend());
        let load = numbers(conditions, |condition| condition.load);
        for lane in 0..WIDTH {
            let at = [tau[lane], load[lane], s[lane]];
            steps[lane] = resolution.steps_on_uniform(taper[lane], bend[lane], at);
        }
    }
    steps
}
