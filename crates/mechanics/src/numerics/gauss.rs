//! Collocation at five Gauss-Legendre nodes: integrals of the polynomials through them with a weight of any shape.

use crate::numerics::Real;

/// Number of collocation nodes in a step.
pub const NODES: usize = 5;

/// Collocation nodes of a step, `[node]`: the Gauss-Legendre nodes on `[0, 1]`.
pub const AT: [f64; NODES] = [
    0.046_910_077_030_668,
    0.230_765_344_947_158_45,
    0.5,
    0.769_234_655_052_841_5,
    0.953_089_922_969_332,
];

/// Integrals of the Lagrange polynomials of the nodes, with a weight: `[to][polynomial]`, from the start of the step to each
/// node and, last, to the end of the step.
pub type Integrals<T> = [[T; NODES]; NODES + 1];

/// A weight function on `[0, 1]`, with which collocation integrals are taken.
pub trait Weight<T> {
    /// Returns the value of the weight function at `x` in `[0, 1]`.
    fn at(&self, x: f64) -> T;
}

/// Nodes and weights of the Gauss-Legendre quadrature with four nodes on `[0, 1]`, exact up to degree 7: `[point][node, weight]`.
pub const QUADRATURE: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];

/// A quadrature node between two neighbouring collocation nodes (or an end of the step), and the Lagrange polynomials there
/// times the quadrature's weight.
struct QuadratureNode {
    at: f64,
    basis: [f64; NODES],
}

const QUADRATURE_NODES: [[QuadratureNode; QUADRATURE.len()]; NODES + 1] = {
    const NONE: QuadratureNode = QuadratureNode { at: 0.0, basis: [0.0; NODES] };
    let mut nodes = [const { [NONE; QUADRATURE.len()] }; NODES + 1];
    let mut gap = 0;
    while gap <= NODES {
        let from = if gap == 0 { 0.0 } else { AT[gap - 1] };
        let to = if gap == NODES { 1.0 } else { AT[gap] };
        let mut i = 0;
        while i < QUADRATURE.len() {
            let [node, weight] = QUADRATURE[i];
            let at = from + node * (to - from);
            nodes[gap][i].at = at;
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
                nodes[gap][i].basis[j] = basis;
                j += 1;
            }
            i += 1;
        }
        gap += 1;
    }
    nodes
};

/// Collocation integrals over a step of length 1 with the weight 1: `[to][polynomial]`.
pub const FLAT: Integrals<f64> = {
    let mut flat = [[0.0; NODES]; NODES + 1];
    let mut sum = [0.0; NODES];
    let mut gap = 0;
    while gap <= NODES {
        let mut j = 0;
        while j < NODES {
            let mut i = 0;
            while i < QUADRATURE.len() {
                sum[j] += QUADRATURE_NODES[gap][i].basis[j];
                i += 1;
            }
            j += 1;
        }
        flat[gap] = sum;
        gap += 1;
    }
    flat
};

/// Returns the collocation integrals over a step of length 1 with this `weight` function: `[to][polynomial]`.
#[inline(always)]
pub fn integrals<T: Real>(weight: &impl Weight<T>) -> Integrals<T> {
    let mut integrals = [[T::of(0.0); NODES]; NODES + 1];
    let mut sum = [T::of(0.0); NODES];
    for (nodes, integrals) in QUADRATURE_NODES.iter().zip(&mut integrals) {
        for node in nodes {
            let here = weight.at(node.at);
            for (sum, basis) in sum.iter_mut().zip(&node.basis) {
                *sum = here.mul_add(T::of(*basis), *sum);
            }
        }
        *integrals = sum;
    }
    integrals
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Power(i32);

    impl Weight<f64> for Power {
        fn at(&self, x: f64) -> f64 {
            x.powi(self.0)
        }
    }

    #[test]
    fn polynomials_are_integrated_exactly() {
        for power in 0..=3 {
            let integrals = integrals(&Power(power));
            for (row, to) in integrals.iter().zip(AT.iter().chain([&1.0])) {
                for degree in 0..NODES as i32 {
                    let integral: f64 = row.iter().zip(AT).map(|(w, x)| w * x.powi(degree)).sum();
                    let above = power + degree + 1;
                    let exact = to.powi(above) / f64::from(above);
                    assert!((integral - exact).abs() < 2e-16, "{power} {degree} {to}");
                }
            }
        }
        assert_eq!(integrals(&Power(0)), FLAT);
    }
}
