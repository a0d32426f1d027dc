//! Collocation at Gauss and Legendre's nodes: polynomials through them, integrated with a weight of any shape.

use crate::numerics::Real;

/// Nodes in a step.
pub const NODES: usize = 5;

/// The nodes on `[0, 1]`.
pub const AT: [f64; NODES] = [
    0.046_910_077_030_668,
    0.230_765_344_947_158_45,
    0.5,
    0.769_234_655_052_841_5,
    0.953_089_922_969_332,
];

/// Integrals from the start of a step to every node, and to its end, of the polynomials that are 1 at one node and 0 at the others.
pub type Integrals<T> = [[T; NODES]; NODES + 1];

/// What polynomials are integrated with.
pub trait Weight<T> {
    /// The weight at `x` in `[0, 1]`.
    fn at(&self, x: f64) -> T;
}

/// Nodes and weights on `[0, 1]` of the quadrature between neighbouring nodes.
const WITHIN: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];

/// Where the quadrature looks between a node and the one before it (the start, before the first; the end, after the last), and
/// there the polynomials times its weight.
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

/// The integrals where the weight is 1.
pub const FLAT: Integrals<f64> = {
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

/// The integrals with a `weight`.
#[inline(always)]
pub fn integrals<T: Real>(weight: &impl Weight<T>) -> Integrals<T> {
    let mut integrals = [[T::of(0.0); NODES]; NODES + 1];
    let mut sum = [T::of(0.0); NODES];
    for (looks, integrals) in LOOKS.iter().zip(&mut integrals) {
        for look in looks {
            let here = weight.at(look.at);
            for (sum, basis) in sum.iter_mut().zip(&look.basis) {
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
