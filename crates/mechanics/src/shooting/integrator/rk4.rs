//! The classical Runge-Kutta method of order 4, directly from the right-hand sides. Tests compare
//! [`Nystrom8`](super::Nystrom8) with it.

use crate::numerics::{Real, Vector};
use crate::shooting::integrator::{Integrator, STAGES, Scales};
use crate::shooting::{Intrinsic, Material, RodSystem, Section, Sensitivity, State};

/// The Runge-Kutta method of order 4 with 4 stages.
#[derive(Clone, Copy, Debug)]
pub struct Rk4;

impl Integrator for Rk4 {
    // The two middle stages share a node.
    const NODES: [f64; STAGES] = [0.0, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];

    #[inline(always)]
    fn step<T: Real, I: Intrinsic<T>, C: Material<T>, S: Sensitivity<T>>(
        system: &RodSystem<T, I, C>,
        scales: &Scales<T>,
        from: Section<T>,
        y: State<T, I, S>,
    ) -> State<T, I, S> {
        let h = scales.end().sigma;
        let half = T::of(0.5) * h;
        let (middle, end) = (from.at(scales.stage(1)), from.at(scales.end()));
        let k1 = system.rhs::<S>(from, y);
        let k2 = system.rhs::<S>(middle, y.plus(half, k1));
        let k3 = system.rhs::<S>(middle, y.plus(half, k2));
        let k4 = system.rhs::<S>(end, y.plus(h, k3));
        let sixth = T::of(1.0 / 6.0) * h;
        let third = T::of(1.0 / 3.0) * h;
        y.plus(sixth, k1)
            .plus(third, k2)
            .plus(third, k3)
            .plus(sixth, k4)
    }
}
