//! Polynomials in Newton's form through values at growing nodes, for several functions on the same nodes.

use crate::numerics::newton_form::Polynomial;
use crate::numerics::{Lanes, SimdTask, Unit, WIDTH};

/// The polynomials of `F` functions through their values at at most `N` growing `nodes`, of degree less than the number of nodes.
///
/// # Panics
///
/// If there are more nodes than `N`, or `N` is larger than [`WIDTH`].
///
/// ```
/// use whiskmap_mechanics::numerics::divided_differences::through_nodes;
///
/// let [square] = through_nodes::<4, 1>(&[0.0, 1.0, 3.0], [&[0.0, 1.0, 9.0]]);
/// assert_eq!(square.at(2.0), (4.0, 4.0)); // value and slope
/// ```
#[must_use]
pub fn through_nodes<const N: usize, const F: usize>(
    nodes: &[f64],
    values: [&[f64]; F],
) -> [Polynomial<N>; F] {
    let count = nodes.len();
    assert!(count <= N && N <= WIDTH, "{count} nodes for {N} terms");
    let mut padded = [0.0; 2 * WIDTH];
    padded[..count].copy_from_slice(nodes);
    let columns = values.map(|values| {
        let mut column = [0.0; WIDTH + 1];
        column[..count].copy_from_slice(values);
        column
    });
    let differences = Unit::detect().run(Differences {
        count,
        nodes: &padded,
        columns,
    });
    let mut own = [0.0; N];
    own[..count].copy_from_slice(nodes);
    differences.map(|differences| Polynomial {
        nodes: own,
        differences: std::array::from_fn(|i| differences[i]),
    })
}

/// Divided differences: plain loops, which a compiler turns into vectors of any unit, without fused products.
struct Differences<'a, const F: usize> {
    count: usize,
    nodes: &'a [f64; 2 * WIDTH],
    columns: [[f64; WIDTH + 1]; F],
}

impl<const F: usize> SimdTask for Differences<'_, F> {
    type Output = [[f64; WIDTH]; F];

    #[inline(always)]
    fn run<T: Lanes>(mut self) -> [[f64; WIDTH]; F] {
        let mut differences = [[0.0; WIDTH]; F];
        for (differences, column) in differences.iter_mut().zip(&self.columns) {
            differences[0] = column[0];
        }
        for level in 1..self.count {
            let mut inverse = [0.0; WIDTH];
            let far = &self.nodes[level..level + WIDTH];
            for (inverse, (far, near)) in inverse.iter_mut().zip(far.iter().zip(self.nodes)) {
                *inverse = 1.0 / (far - near);
            }
            for (differences, column) in differences.iter_mut().zip(&mut self.columns) {
                for i in 0..WIDTH {
                    column[i] = (column[i + 1] - column[i]) * inverse[i];
                }
                differences[level] = column[0];
            }
        }
        differences
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values at the nodes, and between them those of the function.
    #[test]
    fn uneven_nodes_give_the_polynomial_through_them() {
        let f = |x: f64| [1.0 / (2.0 + x), (3.0 * x).sin()];
        for count in [1, 2, 5, 7] {
            let nodes: Vec<f64> = (0..count).map(|i| 0.1 * f64::from(i * i + i)).collect();
            let values = [0, 1].map(|i| nodes.iter().map(|x| f(*x)[i]).collect::<Vec<_>>());
            let polynomials = through_nodes::<7, 2>(&nodes, values.each_ref().map(|v| &v[..]));
            for (node, i) in nodes.iter().zip(0..) {
                for (polynomial, values) in polynomials.iter().zip(&values) {
                    let off = (polynomial.at(*node).0 - values[i]).abs();
                    // Measured 1e-13 at the last of seven nodes.
                    assert!(off < 3e-13, "{count} {node}: {off:e}");
                }
            }
        }
        let even: Vec<f64> = (0..16).map(|i| f64::from(i) / 15.0).collect();
        let values: Vec<f64> = even.iter().map(|x| f(*x)[0]).collect();
        let [polynomial] = through_nodes::<16, 1>(&even, [&values]);
        for x in [0.01, 0.4, 0.97] {
            assert!((polynomial.at(x).0 - f(x)[0]).abs() < 1e-13, "{x}");
        }
    }
}
