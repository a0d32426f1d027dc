//! Last coefficients of expansions: the expected error, and the number of points that would lower it.

use super::row::{Numbers, Weights, larger, largest};
use crate::numerics::expansion::{MOST_POINTS, TAIL};

/// Factor by which more points are taken than the rate at the last coefficients calls for.
const SAFETY: f64 = 1.1;

/// Weighted sizes of the last coefficients of expansions, in whisker lengths.
#[derive(Clone, Copy, Debug)]
pub struct ExpansionTail {
    /// Largest of the last coefficients, in whisker lengths: the expected error of the expansions.
    pub last: f64,
    /// Largest of as many coefficients before.
    before: f64,
}

impl ExpansionTail {
    /// Creates the tail of expansions from their [`tails`](Chebyshev::tails) and the `weights` to whisker lengths.
    pub fn new(tails: &[Numbers; 2], weights: &Weights) -> Self {
        let [last, before] = tails.each_ref().map(|tail| largest(tail, weights));
        Self { last, before }
    }

    /// Returns the larger of the tails of two expansions.
    pub fn larger(self, other: Self) -> Self {
        Self {
            last: larger(self.last, other.last),
            before: larger(self.before, other.before),
        }
    }

    /// Returns the number of points whose last coefficients are expected to be `goal`, if coefficients go on to fall at the same rate. This tail is
    /// that of `count` points. `None` above [`MOST_POINTS`].
    pub fn points(self, count: usize, goal: f64) -> Option<usize> {
        if self.last <= goal {
            return Some(count);
        }
        let falls = libm::log(self.before / self.last) / TAIL as f64;
        let more = SAFETY * libm::log(self.last / goal) / falls;
        let is_possible = falls > 0.0 && more <= (MOST_POINTS - count) as f64;
        is_possible.then(|| (count + more as usize + 1).min(MOST_POINTS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of points of an expansion with coefficients `0.3^k` that leaves out 1e-11, from one of 16 points.
    #[test]
    fn the_decay_gives_the_number_of_points() {
        let tail = |first: i32| 0.3_f64.powi(first);
        let tail = ExpansionTail {
            last: tail(13),
            before: tail(10),
        };
        let points = tail.points(16, 1e-11);
        // 0.3^21.04 is 1e-11: 8.04 more, and a tenth.
        assert_eq!(points, Some(16 + 9));
        assert_eq!(tail.points(16, 1e-6), Some(16));
        let flat = ExpansionTail {
            last: 1e-3,
            before: 1e-3,
        };
        assert_eq!(flat.points(16, 1e-11), None);
        assert_eq!(tail.points(36, 1e-11), None);
        let unknown = ExpansionTail {
            last: f64::NAN,
            ..flat
        };
        assert_eq!(unknown.points(16, 1e-11), None);
    }
}
