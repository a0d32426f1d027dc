//! Collocation for measured radii: the compliance is a weight of its own.
//!
//! Measured radii are rough. Their fourth power is what bends the rod, and no method that takes it for smooth gets along with a
//! step a piece. But the levers `X` hardly feel it: they change by the cosine of an angle that bending turns a little within a
//! step. So the levers are taken for polynomials through Gauss's nodes, and what turns the rod, `dtheta/da = f X/S`, is their
//! integral with `1/S` as its weight, whatever its shape. The derivatives by a parameter have the same equations.
//!
//! Levers turn angles, and angles move levers: a few turns of this iteration suffice, because within a step bending moves a lever
//! by a small part of itself.

use crate::numerics::{Real, Vector, rotated_by_small};
use crate::shooting::integrator::upright;
use crate::shooting::{Intrinsic, Measured, RodSystem, Section, Sensitivity, Stage, State};

/// Gauss's nodes in a step.
const NODES: usize = 5;

/// Gauss and Legendre's nodes on `[0, 1]`.
const AT: [f64; NODES] = [
    0.046_910_077_030_668,
    0.230_765_344_947_158_45,
    0.5,
    0.769_234_655_052_841_5,
    0.953_089_922_969_332,
];

/// Nodes and weights on `[0, 1]` of the quadrature of the compliance between neighbouring nodes.
const WITHIN: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];

/// Rounds in which levers follow from angles, after the first prediction.
const ITERATIONS: usize = 2;

/// Where the quadrature looks between a node and the one before it (the start, before the first; the end, after the last), and
/// there the polynomials that are 1 at one node and 0 at the others, times the weight.
struct Look {
    at: f64,
    basis: [f64; NODES],
}

const LOOKS: [[Look; WITHIN.len()]; NODES + 1] = {
    const NONE: Look = Look {
        at: 0.0,
        basis: [0.0; NODES],
    };
    let mut looks = [const { [NONE; WITHIN.len()] }; NODES + 1];
    let mut gap = 0;
    while gap <= NODES {
        let from = if gap == 0 { 0.0 } else { AT[gap - 1] };
        let to = if gap == NODES { 1.0 } else { AT[gap] };
        let mut i = 0;
        while i < WITHIN.len() {
            let [node, weight] = WITHIN[i];
            let at = from + node * (to - from);
            looks[gap][i].at = at;
            let mut j = 0;
            while j < NODES {
                let mut basis = weight * (to - from);
                let mut k = 0;
                while k < NODES {
                    if k != j {
                        basis *= (at - AT[k]) / (AT[j] - AT[k]);
                    }
                    k += 1;
                }
                looks[gap][i].basis[j] = basis;
                j += 1;
            }
            i += 1;
        }
        gap += 1;
    }
    looks
};

/// Integrals of the basis from the start to every node, and to the end.
const FLAT: [[f64; NODES]; NODES + 1] = {
    let mut flat = [[0.0; NODES]; NODES + 1];
    let mut sum = [0.0; NODES];
    let mut gap = 0;
    while gap <= NODES {
        let mut j = 0;
        while j < NODES {
            let mut i = 0;
            while i < WITHIN.len() {
                sum[j] += LOOKS[gap][i].basis[j];
                i += 1;
            }
            j += 1;
        }
        flat[gap] = sum;
        gap += 1;
    }
    flat
};

/// The same with the compliance over `length` as a weight, backward from the arclength `from`.
#[inline(always)]
fn weights<T: Real>(material: &Measured<T>, from: T, length: T) -> [[T; NODES]; NODES + 1] {
    let mut weights = [[T::of(0.0); NODES]; NODES + 1];
    let mut sum = [T::of(0.0); NODES];
    for (gap, weights) in weights.iter_mut().enumerate() {
        for look in &LOOKS[gap] {
            let compliance = material.compliance(from - length * T::of(look.at));
            for (sum, basis) in sum.iter_mut().zip(&look.basis) {
                *sum = compliance.mul_add(T::of(*basis), *sum);
            }
        }
        for (weight, sum) in weights.iter_mut().zip(&sum) {
            *weight = length * *sum;
        }
    }
    weights
}

/// Integrates `system` in `steps` steps from the section `from`; each of them changes the rod as `end` says.
#[inline(always)]
pub fn collocate<T: Real, I: Intrinsic<T>, S: Sensitivity<T>>(
    system: &RodSystem<T, I, Measured<T>>,
    end: &Stage<T>,
    from: Section<T>,
    steps: u32,
    mut state: State<T, I, S>,
) -> State<T, I, S> {
    let mut section = from;
    for _ in 0..steps {
        state = step::<T, I, S>(system, end, &section, state);
        section = section.at(end);
    }
    state
}

/// What turns the rod, and its derivatives: `X` and the levers of the sensitivities. Their moments turn the angles.
type Levers<T, S> = ([T; 1], <S as Sensitivity<T>>::Pairs);

#[inline(always)]
fn step<T: Real, I: Intrinsic<T>, S: Sensitivity<T>>(
    system: &RodSystem<T, I, Measured<T>>,
    end: &Stage<T>,
    from: &Section<T>,
    (rest, (rod, (angles, (levers, sums)))): State<T, I, S>,
) -> State<T, I, S> {
    let [c, s, x, y, bent] = rod;
    let length = from.rho * end.along;
    let weights = weights(&system.material, from.arclength, length);
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
    let mut moments = [start; NODES];
    macro_rules! find_moments {
        () => {
            for i in 0..NODES {
                let ([x], levers) = at_nodes[i];
                moments[i] = ([force * x], S::moments(force, x, levers));
            }
        };
    }
    let mut pulls = at_nodes;
    let mut climbs = [([-s], sums); NODES];
    // Tangent, bend and angles at a node, or at the end.
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
    // As if the pull changed evenly from the start to the end of the step.
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
    (
        I::after(&course, end.along),
        (upright([c, s, x, y, bent]), (angles, (levers, sums))),
    )
}
