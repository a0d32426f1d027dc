//! Polynomials through Chebyshev-Lobatto nodes on `[0, 1]`: the extrema of a Chebyshev polynomial, with both ends.
//!
//! A polynomial through all nodes is as accurate at the ends as in the middle. A polynomial through some of them is not.

use crate::numerics::newton_form::Polynomial;
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Number of nodes.
pub const LOBATTO_COUNT: usize = 16;

/// The nodes on `[0, 1]`, growing.
pub static LOBATTO_NODES: LazyLock<[f64; LOBATTO_COUNT]> = LazyLock::new(|| {
    let node = |m: usize| libm::sin(FRAC_PI_2 * m as f64 / (LOBATTO_COUNT - 1) as f64).powi(2);
    std::array::from_fn(node)
});

/// A polynomial through all nodes, or through some that are neighbours.
pub type LobattoPolynomial = Polynomial<LOBATTO_COUNT>;
