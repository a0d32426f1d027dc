//! The loads at which a column is sampled, as parts of its fold's load: Chebyshev's extreme points between no load and the
//! fold, so that one polynomial through all of them is as good at its ends as in its middle. (One through a part of them is not: a row
//! that leaves the lattice takes the nodes around.)

use crate::numerics::newton_form::Polynomial;
use crate::numerics::{Lanes, SimdTask, Unit};
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Loads per column, first touch and the fold among them.
pub const LOADS: usize = 16;

/// The last step of Newton's method along a level curve: its square is left, and interpolation leaves more than that.
pub const LAST_STEP: f64 = 1e-5;

/// The loads, growing, as parts of the fold's.
pub static PARTS: LazyLock<[f64; LOADS]> = LazyLock::new(|| {
    let part = |m: usize| (FRAC_PI_2 * m as f64 / (LOADS - 1) as f64).sin().powi(2);
    std::array::from_fn(part)
});

/// One over the distance of the load `i` from the load `level` further on, by `level`; 0 where there is none.
static INVERSE_DISTANCES: LazyLock<[[f64; 2 * LOADS]; LOADS]> = LazyLock::new(|| {
    let mut inverse = [[0.0; 2 * LOADS]; LOADS];
    for (level, inverse) in inverse.iter_mut().enumerate().skip(1) {
        for (inverse, pair) in inverse.iter_mut().zip(PARTS.windows(level + 1)) {
            *inverse = 1.0 / (pair[level] - pair[0]);
        }
    }
    inverse
});

/// Along a row, by the load.
pub type Curve = Polynomial<LOADS>;

/// The curves through the first `count` of some values each, `values[0]` at the load `first`, `values[1]` at the next one, ...
#[must_use]
pub fn through<const N: usize>(
    first: usize,
    count: usize,
    values: [[f64; LOADS]; N],
) -> [Curve; N] {
    let mut places = [0.0; LOADS];
    places[..count].copy_from_slice(&PARTS[first..first + count]);
    let inverse_distances = &INVERSE_DISTANCES;
    let differences = Unit::detect().run(Differences {
        first,
        count,
        inverse_distances,
        values,
    });
    differences.map(|differences| Curve {
        places,
        differences,
    })
}

/// Divided differences of values at neighbouring loads.
struct Differences<const N: usize> {
    first: usize,
    count: usize,
    inverse_distances: &'static [[f64; 2 * LOADS]; LOADS],
    values: [[f64; LOADS]; N],
}

impl<const N: usize> SimdTask for Differences<N> {
    type Output = [[f64; LOADS]; N];

    /// In no lanes of ours: loops over all loads, whatever the count, which the compiler turns into the unit's vectors.
    #[inline(always)]
    fn run<T: Lanes>(self) -> [[f64; LOADS]; N] {
        let mut differences = [[0.0; LOADS]; N];
        for (differences, values) in differences.iter_mut().zip(&self.values) {
            let mut column = [0.0; LOADS + 1];
            column[..LOADS].copy_from_slice(values);
            differences[0] = column[0];
            let levels = differences.iter_mut().zip(self.inverse_distances);
            for (difference, inverse) in levels.take(self.count).skip(1) {
                let inverse = &inverse[self.first..self.first + LOADS];
                let before = column;
                for i in 0..LOADS {
                    column[i] = (before[i + 1] - before[i]) * inverse[i];
                }
                *difference = column[0];
            }
        }
        differences
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_go_through_their_values() {
        let f = |part: f64| (2.0 * part).sin();
        for first in [0, 3, LOADS - 2] {
            let count = LOADS - first;
            let mut values = [0.0; LOADS];
            for (value, part) in values.iter_mut().zip(&PARTS[first..]) {
                *value = f(*part);
            }
            let [curve] = through(first, count, [values]);
            for (part, value) in PARTS[first..].iter().zip(&values) {
                assert!((curve.at(*part).0 - value).abs() < 1e-13, "{first} {part}");
            }
            if count == LOADS {
                for i in 0..=100 {
                    let part = 0.01 * f64::from(i);
                    let (value, slope) = curve.at(part);
                    assert!((value - f(part)).abs() < 1e-12, "{part}");
                    assert!((slope - 2.0 * (2.0 * part).cos()).abs() < 1e-10, "{part}");
                }
            }
        }
    }
}
