//! Chebyshev expansions of functions of two variables on `[0, 1]^2`, through values on the tensor of both [`chebyshev_points`].
//!
//! Fixing the first variable gives an expansion in the second one.
//!
//! [`chebyshev_points`]: crate::numerics::expansion::chebyshev_points

use crate::numerics::expansion::{Chebyshev, MOST_POINTS};
use crate::numerics::{Lanes, SimdTask, Unit};

/// Expansion of `D` functions of `(x, y)` on `[0, 1]^2`.
#[derive(Clone, Debug)]
pub struct ChebyshevTensor<const D: usize> {
    /// Coefficients of the expansion in `x` and `y`, `[polynomial of y]`: each is an expansion in `x`.
    pub in_y: Vec<Chebyshev<D>>,
}

impl<const D: usize> ChebyshevTensor<D> {
    /// Creates the expansion in `x` and `y` through `rows`: expansions in `y` at the Chebyshev points of `x`, all of one length.
    ///
    /// # Panics
    ///
    /// If there are no rows, or more than [`MOST_POINTS`].
    #[must_use]
    pub fn through(rows: &[Chebyshev<D>]) -> Self {
        let powers = 0..rows[0].coefficients.len();
        let in_y = powers.map(|power| {
            let values: Vec<[f64; D]> = rows.iter().map(|row| row.coefficients[power]).collect();
            Chebyshev::through(&values)
        });
        Self {
            in_y: in_y.collect(),
        }
    }

    /// Returns the expansion in `y` at a fixed `x` in `[0, 1]`.
    #[must_use]
    pub fn at(&self, x: f64) -> Chebyshev<D> {
        let y = 2.0 * x - 1.0;
        let mut polynomials = [1.0; MOST_POINTS];
        polynomials[1] = y;
        for i in 2..MOST_POINTS {
            polynomials[i] = 2.0 * y * polynomials[i - 1] - polynomials[i - 2];
        }
        let coefficients = Unit::detect().run(Contraction {
            in_y: &self.in_y,
            polynomials: &polynomials,
        });
        Chebyshev { coefficients }
    }

    /// Returns the sums over the powers of `y` of the last coefficients in `x` ([`Chebyshev::tails`]), `[group][function]`: they estimate the error
    /// in `x`.
    #[must_use]
    pub fn tails_in_x(&self) -> [[f64; D]; 2] {
        let tails = self.in_y.iter().map(Chebyshev::tails);
        tails.fold([[0.0; D]; 2], |sum, tails| {
            std::array::from_fn(|group| std::array::from_fn(|i| sum[group][i] + tails[group][i]))
        })
    }
}

/// Sum of the coefficients times the Chebyshev polynomials of `x`: plain loops, which a compiler turns into vectors of any unit.
struct Contraction<'a, const D: usize> {
    in_y: &'a [Chebyshev<D>],
    polynomials: &'a [f64; MOST_POINTS],
}

impl<const D: usize> SimdTask for Contraction<'_, D> {
    type Output = Vec<[f64; D]>;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Vec<[f64; D]> {
        let sum = |in_x: &Chebyshev<D>| {
            let mut sum = [0.0; D];
            for (coefficients, polynomial) in in_x.coefficients.iter().zip(self.polynomials) {
                for (sum, coefficient) in sum.iter_mut().zip(coefficients) {
                    *sum += polynomial * coefficient;
                }
            }
            sum
        };
        self.in_y.iter().map(sum).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::expansion::chebyshev_points;

    #[test]
    fn a_function_of_two_variables_is_found_between_the_points() {
        let function = |x: f64, y: f64| [(x + 2.0 * y).sin(), 1.0 / (2.0 + x * y)];
        let rows = chebyshev_points(20).iter().map(|x| {
            let values: Vec<[f64; 2]> = chebyshev_points(24)
                .iter()
                .map(|y| function(*x, *y))
                .collect();
            Chebyshev::through(&values)
        });
        let tensor = ChebyshevTensor::through(&rows.collect::<Vec<_>>());
        for i in 0..=20 {
            let x = f64::from(i) / 20.0;
            let row = tensor.at(x);
            for j in 0..=20 {
                let y = f64::from(j) / 20.0;
                let (found, wanted) = (row.at(y), function(x, y));
                assert!(
                    (found[0] - wanted[0]).abs() < 1e-14 && (found[1] - wanted[1]).abs() < 1e-14
                );
            }
        }
        assert!(tensor.tails_in_x()[0].iter().all(|tail| *tail < 1e-12));
    }
}
