//! Collocation for measured radii, with the compliance as a weight.
//!
//! Measured radii are rough, and the inverse of their fourth power bends the rod. A method for smooth equations would need many
//! steps along each piece. But the levers `X` are smooth: they change by the cosine of an angle that bending turns a little
//! within a step. The levers are therefore polynomials through Gauss-Legendre nodes, and the rotation `dtheta/da = f X/S` is
//! their integral with the weight `r^-4`. The smooth modulus divides the levers at the nodes. Derivatives by a parameter have
//! equations of the same form.
//!
//! Levers turn angles, and angles move levers. The iteration between them converges fast, because bending within a step moves a
//! lever by a small part of itself.

use crate::numerics::gauss::{AT, FLAT, Integrals, NODES, Weight, integrals};
use crate::numerics::{Real, Vector, rotated_by_small};
use crate::shooting::integrator::{Levers, upright};
use crate::shooting::{
    Intrinsic, Measured, RodSystem, Section, Sensitivity, StepStage, TrajectoryState,
};

/// Iterations after the first prediction, in each of which levers follow from angles.
const ITERATIONS: usize = 2;

/// Compliance of a material from an arclength toward the base, as a weight.
pub struct BackwardCompliance<'a, T> {
    /// Material whose compliance is the weight.
    pub material: &'a Measured<T>,
    /// Arclength at the start of the step, in whisker lengths.
    pub from: T,
    /// Length of the step along the rod, in whisker lengths.
    pub length: T,
}

impl<T: Real> Weight<T> for BackwardCompliance<'_, T> {
    #[inline(always)]
    fn at(&self, x: f64) -> T {
        self.material.compliance(self.from - self.length * T::of(x))
    }
}

impl<T: Real> BackwardCompliance<'_, T> {
    /// Returns the collocation integrals with the compliance as their weight, over the arclength in whisker lengths.
    #[inline(always)]
    pub fn weights(&self) -> Integrals<T> {
        let mut weights = integrals(self);
        for weights in &mut weights {
            for weight in weights {
                *weight = self.length * *weight;
            }
        }
        weights
    }
}

/// Takes one collocation step of `system` from the section `from` to the stage `end`. `weights` are the collocation integrals with the
/// compliance.
#[inline(always)]
pub fn collocate<T: Real, I: Intrinsic<T>, S: Sensitivity<T>>(
    system: &RodSystem<T, I, Measured<T>>,
    end: &StepStage<T>,
    from: &Section<T>,
    weights: &Integrals<T>,
    (rest, (rod, (angles, (levers, sums)))): TrajectoryState<T, I, S>,
) -> TrajectoryState<T, I, S> {
    let [c, s, x, y, bent] = rod;
    let length = from.rho * end.along;
    let course = system.intrinsic.course(from, rest);
    let force = system.force;
    let start: Levers<T, S> = ([x], levers);
    let (pull, _) = S::pull(c, s, bent, angles);
    let pull: Levers<T, S> = ([-c], pull);
    let mut at_nodes = [start; NODES];
    for (levers, at) in at_nodes.iter_mut().zip(AT) {
        *levers = levers.plus(length * T::of(at), pull);
    }
    let mut rest_turns = [I::turn(&course, end.along); NODES + 1];
    for (turn, at) in rest_turns.iter_mut().zip(AT) {
        *turn = I::turn(&course, end.along * T::of(at));
    }
    // Inverse modulus at the nodes.
    let mut left = [None; NODES];
    if let Some(gradient) = system.material.gradient {
        for (left, at) in left.iter_mut().zip(AT) {
            let here = from.arclength - length * T::of(at);
            *left = Some(T::of(1.0) / gradient.mul_add(here, T::of(1.0)));
        }
    }
    let mut moments = [start; NODES];
    macro_rules! find_moments {
        () => {
            for i in 0..NODES {
                let ([x], levers) = at_nodes[i];
                moments[i] = ([force * x], S::moments(force, x, levers));
                if let Some(left) = left[i] {
                    moments[i] = moments[i].times(left);
                }
            }
        };
    }
    let mut pulls = at_nodes;
    let mut climbs = [([-s], sums); NODES];
    // Tangent, bend and angles at a node or at the end.
    macro_rules! turned {
        ($i:expr) => {{
            let weights = &weights[$i];
            let mut turned: Levers<T, S> = moments[0].times(weights[0]);
            for j in 1..NODES {
                turned = turned.plus(weights[j], moments[j]);
            }
            let ([bend], changes) = turned;
            let turn = match rest_turns[$i] {
                Some(turn) => turn + bend,
                None => bend,
            };
            let angles = angles.plus(T::of(1.0), changes);
            (rotated_by_small([c, s], turn), bent + bend, angles)
        }};
    }
    // The prediction: the pull changes linearly from the start to the end of the step.
    find_moments!();
    let ([c_end, s_end], bent_end, angles_end) = turned!(NODES);
    let (pull_end, _) = S::pull(c_end, s_end, bent_end, angles_end);
    let change: Levers<T, S> = ([-c_end], pull_end);
    let change = change.plus(T::of(-1.0), pull);
    for (levers, at) in at_nodes.iter_mut().zip(AT) {
        *levers = levers.plus(length * T::of(0.5 * at * at), change);
    }
    for iteration in 0..=ITERATIONS {
        if iteration > 0 {
            for i in 0..NODES {
                at_nodes[i] = start;
                for j in 0..NODES {
                    at_nodes[i] = at_nodes[i].plus(length * T::of(FLAT[i][j]), pulls[j]);
                }
            }
        }
        find_moments!();
        for i in 0..NODES {
            let ([c, s], bent, angles) = turned!(i);
            let (pull, climb) = S::pull(c, s, bent, angles);
            pulls[i] = ([-c], pull);
            climbs[i] = ([-s], climb);
        }
    }
    let ([c, s], bent, angles) = turned!(NODES);
    let mut levers = start;
    let mut sums = ([y], sums);
    for j in 0..NODES {
        let weight = length * T::of(FLAT[NODES][j]);
        levers = levers.plus(weight, pulls[j]);
        sums = sums.plus(weight, climbs[j]);
    }
    let (([x], levers), ([y], sums)) = (levers, sums);
    (I::after(&course, end.along), (upright([c, s, x, y, bent]), (angles, (levers, sums))))
}
