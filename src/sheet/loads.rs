//! The loads at which a column is sampled, as parts of its fold's load: Chebyshev's extreme points between no load and the
//! fold, so that one polynomial through all of them is as good at its ends as in its middle. (One through a part of them is not: a row
//! that leaves the lattice takes the nodes around.)

use super::polynomial::Polynomial;
use crate::model::{Landing, nearest_turn};
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

/// One over the distance of the load `i` from the load `level` further on, by `level`.
static INVERSE_DISTANCES: LazyLock<[[f64; LOADS]; LOADS]> = LazyLock::new(|| {
    let mut inverse = [[0.0; LOADS]; LOADS];
    for (level, inverse) in inverse.iter_mut().enumerate().skip(1) {
        for (inverse, pair) in inverse.iter_mut().zip(PARTS.windows(level + 1)) {
            *inverse = 1.0 / (pair[level] - pair[0]);
        }
    }
    inverse
});

/// Along a row, by the load.
pub type Curve = Polynomial<LOADS>;

/// The curve through `values[0]` at the load `first`, `values[1]` at the next one, ...
#[must_use]
pub fn through(first: usize, values: &[f64]) -> Curve {
    let mut places = [0.0; LOADS];
    let count = values.len();
    places[..count].copy_from_slice(&PARTS[first..first + count]);
    let mut column = [0.0; LOADS];
    column[..count].copy_from_slice(values);
    let mut differences = [0.0; LOADS];
    differences[0] = column[0];
    for level in 1..count {
        let inverse = &INVERSE_DISTANCES[level][first..];
        for i in 0..count - level {
            column[i] = (column[i + 1] - column[i]) * inverse[i];
        }
        differences[level] = column[0];
    }
    Curve {
        places,
        differences,
    }
}

/// Directions of the pole, continuous from first touch, of `landings` of one contact under these parts of its fold's `load`.
pub fn directions<'a>(load: f64, landings: impl Iterator<Item = &'a Landing>) -> [f64; LOADS] {
    let mut phis = [0.0; LOADS];
    let mut before: Option<(&Landing, f64, f64)> = None;
    for (slot, (landing, part)) in phis.iter_mut().zip(landings.zip(PARTS.iter())) {
        let near = before.map_or(0.0, |(there, phi, part_there)| {
            let slopes = there.by_load.y + landing.by_load.y;
            0.5f64.mul_add(slopes * load * (part - part_there), phi)
        });
        let phi = nearest_turn(landing.pole.to_angle(), near);
        before = Some((landing, phi, *part));
        *slot = phi;
    }
    phis
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_go_through_their_values() {
        let f = |part: f64| (2.0 * part).sin();
        for first in [0, 3, LOADS - 2] {
            let count = LOADS - first;
            let values: Vec<f64> = PARTS[first..].iter().map(|part| f(*part)).collect();
            let curve = through(first, &values);
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
