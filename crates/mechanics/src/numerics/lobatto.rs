//! Polynomials through Chebyshev-Lobatto nodes on `[0, 1]`: the extrema of a Chebyshev polynomial, with both ends.
//!
//! A polynomial through all nodes is as accurate at the ends as in the middle. A polynomial through some of them is not.

use crate::numerics::newton_form::Polynomial;
use crate::numerics::{Lanes, SimdTask, Unit};
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Number of nodes.
pub const LOBATTO_COUNT: usize = 16;

/// The nodes on `[0, 1]`, growing.
pub static LOBATTO_NODES: LazyLock<[f64; LOBATTO_COUNT]> = LazyLock::new(|| {
    let node = |m: usize| libm::sin(FRAC_PI_2 * m as f64 / (LOBATTO_COUNT - 1) as f64).powi(2);
    std::array::from_fn(node)
});

/// `[level][i]`: the inverse distance of the node `i` from the node `i + level`; 0 where there is none.
static INVERSE_DISTANCES: LazyLock<[[f64; 2 * LOBATTO_COUNT]; LOBATTO_COUNT]> =
    LazyLock::new(|| {
        let mut inverse = [[0.0; 2 * LOBATTO_COUNT]; LOBATTO_COUNT];
        for (level, inverse) in inverse.iter_mut().enumerate().skip(1) {
            for (inverse, pair) in inverse.iter_mut().zip(LOBATTO_NODES.windows(level + 1)) {
                *inverse = 1.0 / (pair[level] - pair[0]);
            }
        }
        inverse
    });

/// A polynomial through all nodes, or through some that are neighbours.
pub type LobattoPolynomial = Polynomial<LOBATTO_COUNT>;

/// The polynomials through the first `count` of `values[function]`, which are known at the nodes `first`, `first + 1`, ...
#[must_use]
pub fn through_lobatto<const N: usize>(
    first: usize,
    count: usize,
    values: [[f64; LOBATTO_COUNT]; N],
) -> [LobattoPolynomial; N] {
    let mut nodes = [0.0; LOBATTO_COUNT];
    nodes[..count].copy_from_slice(&LOBATTO_NODES[first..first + count]);
    let inverse_distances = &INVERSE_DISTANCES;
    let differences = Unit::detect().run(Differences {
        first,
        count,
        inverse_distances,
        values,
    });
    differences.map(|differences| LobattoPolynomial { nodes, differences })
}

/// Task that computes the divided differences of `N` functions known at neighbouring nodes.
struct Differences<const N: usize> {
    first: usize,
    count: usize,
    inverse_distances: &'static [[f64; 2 * LOBATTO_COUNT]; LOBATTO_COUNT],
    values: [[f64; LOBATTO_COUNT]; N],
}

impl<const N: usize> SimdTask for Differences<N> {
    type Output = [[f64; LOBATTO_COUNT]; N];

    /// The loops go over all nodes, whatever the count, so that the compiler turns them into the unit's vectors.
    #[inline(always)]
    fn run<T: Lanes>(self) -> [[f64; LOBATTO_COUNT]; N] {
        let mut differences = [[0.0; LOBATTO_COUNT]; N];
        for (differences, values) in differences.iter_mut().zip(&self.values) {
            let mut column = [0.0; LOBATTO_COUNT + 1];
            column[..LOBATTO_COUNT].copy_from_slice(values);
            differences[0] = column[0];
            let levels = differences.iter_mut().zip(self.inverse_distances);
            for (difference, inverse) in levels.take(self.count).skip(1) {
                let inverse = &inverse[self.first..self.first + LOBATTO_COUNT];
                let before = column;
                for i in 0..LOBATTO_COUNT {
                    column[i] = (before[i + 1] - before[i]) * inverse[i];
                }
                *difference = column[0];
            }
        }
        differences
    }
}
