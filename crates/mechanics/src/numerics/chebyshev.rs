//! Chebyshev points on `[0, 1]`, and Taylor expansions of the polynomial through them.
//!
//! A polynomial through Chebyshev points is nearly the best of its degree, and as accurate at the ends as in the middle (L. N. Trefethen,
//! *Approximation Theory and Approximation Practice*, SIAM 2013, chapters 3 and 8). A polynomial through some of the points is not.

use crate::numerics::{Lanes, SimdTask, Unit, WIDTH};
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Number of Chebyshev points: one for each lane.
pub const CHEBYSHEV_COUNT: usize = WIDTH;

/// Chebyshev points of the second kind (Chebyshev-Lobatto) on `[0, 1]`, growing: the extrema of a Chebyshev polynomial, with both ends.
pub static LOBATTO_NODES: LazyLock<[f64; CHEBYSHEV_COUNT]> = LazyLock::new(|| {
    let node = |m: usize| libm::sin(FRAC_PI_2 * m as f64 / (CHEBYSHEV_COUNT - 1) as f64).powi(2);
    std::array::from_fn(node)
});

/// Chebyshev points of the first kind on `[0, 1]`, growing: the zeros of a Chebyshev polynomial. The ends of the interval are not among
/// them, so a function may be unknown there.
pub static CHEBYSHEV_POINTS: LazyLock<[f64; CHEBYSHEV_COUNT]> = LazyLock::new(|| {
    let angle = |j: usize| FRAC_PI_2 * (2 * j + 1) as f64 / (2 * CHEBYSHEV_COUNT) as f64;
    std::array::from_fn(|j| libm::sin(angle(j)).powi(2))
});

/// Weights `[power][at][around]`: Taylor coefficients around the point `around` of the polynomial that is 1 at the point `at` and 0 at
/// the others.
static TAYLOR_WEIGHTS: LazyLock<Vec<[[f64; CHEBYSHEV_COUNT]; CHEBYSHEV_COUNT]>> =
    LazyLock::new(|| {
        let points = &*CHEBYSHEV_POINTS;
        let mut weights = vec![[[0.0; CHEBYSHEV_COUNT]; CHEBYSHEV_COUNT]; CHEBYSHEV_COUNT];
        for at in 0..CHEBYSHEV_COUNT {
            for around in 0..CHEBYSHEV_COUNT {
                let mut series = [0.0; CHEBYSHEV_COUNT];
                series[0] = 1.0;
                for other in (0..CHEBYSHEV_COUNT).filter(|other| *other != at) {
                    let [to_other, apart] = [around, at].map(|i| points[i] - points[other]);
                    for power in (0..CHEBYSHEV_COUNT).rev() {
                        let lower = if power == 0 { 0.0 } else { series[power - 1] };
                        series[power] = (series[power] * to_other + lower) / apart;
                    }
                }
                for (weights, term) in weights.iter_mut().zip(series) {
                    weights[at][around] = term;
                }
            }
        }
        weights
    });

/// Returns the Taylor coefficients `[around][power][function]` at each of the [`CHEBYSHEV_POINTS`], of the polynomials through `values`
/// `[point][function]` there. The coefficient of the `i`-th power is the `i`-th derivative over `i!`.
#[must_use]
pub fn taylor_at_points<const D: usize, const P: usize>(
    values: &[[f64; D]; CHEBYSHEV_COUNT],
) -> [[[f64; D]; P]; CHEBYSHEV_COUNT] {
    let weights = &TAYLOR_WEIGHTS[..P];
    Unit::detect().run(TaylorSums { values, weights })
}

/// Sums of weighted values: plain loops, which a compiler turns into vectors of any unit, without fused products.
struct TaylorSums<'a, const D: usize, const P: usize> {
    values: &'a [[f64; D]; CHEBYSHEV_COUNT],
    weights: &'a [[[f64; CHEBYSHEV_COUNT]; CHEBYSHEV_COUNT]],
}

impl<const D: usize, const P: usize> SimdTask for TaylorSums<'_, D, P> {
    type Output = [[[f64; D]; P]; CHEBYSHEV_COUNT];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let mut terms = [[[0.0; D]; P]; CHEBYSHEV_COUNT];
        for (power, weights) in self.weights.iter().enumerate() {
            for function in 0..D {
                let mut sums = [0.0; CHEBYSHEV_COUNT];
                for (weights, values) in weights.iter().zip(self.values) {
                    for (sum, weight) in sums.iter_mut().zip(weights) {
                        *sum += weight * values[function];
                    }
                }
                for (terms, sum) in terms.iter_mut().zip(sums) {
                    terms[power][function] = sum;
                }
            }
        }
        terms
    }
}
