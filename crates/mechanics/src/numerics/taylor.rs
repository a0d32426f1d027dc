//! Taylor polynomials of an interpolating polynomial around each of its nodes, side by side in SIMD lanes.

use crate::numerics::newton_form_simd::{Numbers, keep, pack};
use crate::numerics::{Lanes, SimdTask, Unit, WIDTH};

/// Taylor coefficients `[node][power][function]` around each of the growing `nodes`, of the polynomials through the
/// `values[node][function]` of `F` functions.
#[must_use]
pub fn around_nodes<const F: usize, const P: usize>(
    nodes: &Numbers,
    values: &[[f64; F]; WIDTH],
) -> [[[f64; F]; P]; WIDTH] {
    let expanded = Unit::detect().run(Expansion {
        nodes,
        differences: &divided_differences(nodes, *values),
        series: [[[0.0; WIDTH]; P]; F],
    });
    let term = |node: usize, power: usize| expanded.each_ref().map(|series| series[power][node]);
    std::array::from_fn(|node| std::array::from_fn(|power| term(node, power)))
}

/// Newton's divided differences.
fn divided_differences<const F: usize>(
    nodes: &Numbers,
    mut values: [[f64; F]; WIDTH],
) -> [[f64; F]; WIDTH] {
    for level in 1..WIDTH {
        for i in (level..WIDTH).rev() {
            let inverse = 1.0 / (nodes[i] - nodes[i - level]);
            let before = values[i - 1];
            for (value, before) in values[i].iter_mut().zip(before) {
                *value = (*value - before) * inverse;
            }
        }
    }
    values
}

/// Task: Horner's rule with polynomials in place of numbers, around one node in each lane.
struct Expansion<'a, const F: usize, const P: usize> {
    nodes: &'a Numbers,
    differences: &'a [[f64; F]; WIDTH],
    series: [[Numbers; P]; F],
}

impl<const F: usize, const P: usize> SimdTask for Expansion<'_, F, P> {
    type Output = [[Numbers; P]; F];

    #[inline(always)]
    fn run<T: Lanes>(mut self) -> Self::Output {
        for from in (0..WIDTH).step_by(T::LANES) {
            let at: T = pack(self.nodes, from);
            for (function, series) in self.series.iter_mut().enumerate() {
                let mut terms = [T::of(0.0); P];
                for (node, differences) in self.nodes.iter().zip(self.differences).rev() {
                    let shift = at - T::of(*node);
                    for power in (1..P).rev() {
                        terms[power] = terms[power].mul_add(shift, terms[power - 1]);
                    }
                    terms[0] = terms[0].mul_add(shift, T::of(differences[function]));
                }
                for (numbers, term) in series.iter_mut().zip(terms) {
                    keep(numbers, from, term);
                }
            }
        }
        self.series
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three times what rounding makes of each power: nodes as near as a fiftieth divide it.
    const ERRORS: [f64; 6] = [1e-15, 8e-14, 5e-12, 1.5e-10, 2e-9, 1.8e-8];

    /// `exp(x)` and `exp(-2 x)`, whose coefficients are known.
    #[test]
    fn coefficients_are_those_of_the_function() {
        let nodes: Numbers = std::array::from_fn(|i| {
            0.5 - 0.5 * (std::f64::consts::PI * (i as f64 + 0.5) / WIDTH as f64).cos()
        });
        let rates = [1.0, -2.0];
        let series = around_nodes::<2, 6>(&nodes, &nodes.map(|x| rates.map(|a| (a * x).exp())));
        for (x, terms) in nodes.iter().zip(series) {
            let mut exact = rates.map(|a| (a * x).exp());
            for (power, term) in terms.iter().enumerate() {
                for ((exact, rate), term) in exact.iter_mut().zip(rates).zip(term) {
                    let error = ERRORS[power];
                    assert!((term - *exact).abs() < error, "{x} {power}: {term} {exact}");
                    *exact *= rate / (power + 1) as f64;
                }
            }
        }
    }
}
