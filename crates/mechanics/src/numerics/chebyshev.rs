//! Chebyshev points of the second kind on `[0, 1]`.
//!
//! A polynomial through Chebyshev points is nearly the best of its degree, and as accurate at the ends as in the middle (L. N. Trefethen,
//! *Approximation Theory and Approximation Practice*, SIAM 2013, chapters 3 and 8). A polynomial through some of the points is not.

use crate::numerics::WIDTH;
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Number of Chebyshev points: one for each lane.
pub const CHEBYSHEV_COUNT: usize = WIDTH;

/// Chebyshev points of the second kind (Chebyshev-Lobatto) on `[0, 1]`, growing: the extrema of a Chebyshev polynomial, with both ends.
pub static LOBATTO_NODES: LazyLock<[f64; CHEBYSHEV_COUNT]> = LazyLock::new(|| {
    let node = |m: usize| libm::sin(FRAC_PI_2 * m as f64 / (CHEBYSHEV_COUNT - 1) as f64).powi(2);
    std::array::from_fn(node)
});
