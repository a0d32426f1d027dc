//! Numbers of a trajectory and of its rod as dual numbers, with the derivative by one variable in each lane.

use super::TrajectoryVariable;
use crate::numerics::{Dual, Lanes, WIDTH};
use crate::rod::{Rod, RodDerivative};
use crate::shooting::batch::InitialCondition;

/// Initial condition of a trajectory, and the variables by which it is differentiated, one for each lane.
pub struct VariedCondition<'a> {
    pub condition: &'a InitialCondition<'a>,
    pub variables: &'a [TrajectoryVariable<'a>],
}

impl VariedCondition<'_> {
    /// A value with its derivative by the variable of each lane.
    #[inline(always)]
    pub fn dual<T: Lanes>(
        &self,
        value: f64,
        derivative: impl Fn(TrajectoryVariable) -> f64,
    ) -> Dual<T> {
        let mut lanes = [0.0; WIDTH];
        for (lane, variable) in lanes.iter_mut().zip(self.variables) {
            *lane = derivative(*variable);
        }
        Dual { value: T::of(value), derivative: T::pack(lanes) }
    }

    /// A number of the rod.
    #[inline(always)]
    pub fn number<T: Lanes>(
        &self,
        value: impl Fn(&Rod) -> f64,
        derivative: impl Fn(&RodDerivative) -> f64,
    ) -> Dual<T> {
        self.dual(value(self.condition.rod), |variable| match variable {
            TrajectoryVariable::Rod(by) => derivative(by),
            TrajectoryVariable::Tau | TrajectoryVariable::Load => 0.0,
        })
    }
}
