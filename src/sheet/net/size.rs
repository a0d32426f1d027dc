//! Sizes of panels: the first size for a bound, and the next sizes by the decay of coefficients.

use super::bound::MARGIN;
use whiskmap_mechanics::numerics::expansion::{MOST_POINTS, TAIL};

/// Part of the bound that the coefficients left out are expected to take. At most `1 / MARGIN` is allowed.
const LEFT_OUT: f64 = 0.5 / MARGIN;

/// Factor by which more points are taken than the rate at the last coefficients calls for.
const SAFETY: f64 = 1.1;

/// Contacts and loads of the first panel, to which those for each decimal digit of the bound are added.
const FIRST: [f64; 2] = [4.0, 2.0];

/// Contacts for each decimal digit of the bound, and for each in a range of 1 in `u`. For a bound of 1e-10, 24 are mostly enough for a range of
/// 4, and 31 for one of 7.
const CONTACTS: [f64; 2] = [1.0, 0.25];

/// Loads for each decimal digit of the bound.
const LOADS: f64 = 2.0;

/// Columns of a row beside the loads of its panel. Components of the force are products of functions of the panel, and need more terms than
/// these: on the cone of the paper, 4 columns more leave an error of up to 3e-11 whisker lengths, and 6 one of 2e-12.
const MORE_COLUMNS: usize = 6;

/// Size of a panel.
#[derive(Clone, Copy, Debug)]
pub struct NetSize {
    /// Number of contacts with trajectories.
    pub contacts: usize,
    /// Number of loads at each contact.
    pub loads: usize,
}

/// Weighted sizes of the last coefficients of a panel in one coordinate, in whisker lengths.
#[derive(Clone, Copy, Debug)]
pub struct NetTail {
    /// Largest of the last coefficients, in whisker lengths: the expected error of the panel.
    pub last: f64,
    /// Largest of as many coefficients before.
    pub before: f64,
}

impl NetSize {
    /// Returns the size of the first panel over this `range` of `u` for a bound of `most` whisker lengths: its coefficients show how many states
    /// more are needed.
    pub fn first(most: f64, range: f64) -> Self {
        let digits = -libm::log10(most);
        let [constant, each] = CONTACTS;
        let counts = [constant + each * range, LOADS];
        let [contacts, loads] = std::array::from_fn(|i| {
            // A bound has at most 12 digits.
            let count = (FIRST[i] + counts[i] * digits).ceil() as usize;
            count.clamp(2 * TAIL + 1, MOST_POINTS)
        });
        Self { contacts, loads }
    }

    /// Returns the number of states of a panel of this size.
    pub const fn states(self) -> usize {
        self.contacts * self.loads
    }

    /// Returns the number of columns of a row.
    pub fn columns(self) -> usize {
        (self.loads + MORE_COLUMNS).min(MOST_POINTS)
    }

    /// Returns the next size with more contacts and more loads; `None` for the largest size.
    pub fn larger(self) -> Option<Self> {
        let [contacts, loads] = [self.contacts, self.loads].map(|count| count + TAIL);
        (contacts.max(loads) <= MOST_POINTS).then_some(Self { contacts, loads })
    }

    /// Returns the size that is expected to keep the bound `most`, where a panel of this size has these tails in both coordinates. `None`
    /// without such a size.
    pub fn enough(self, [in_u, in_p]: [NetTail; 2], most: f64) -> Option<Self> {
        Some(Self {
            contacts: in_u.points(self.contacts, LEFT_OUT * most)?,
            loads: in_p.points(self.loads, LEFT_OUT * most)?,
        })
    }
}

impl NetTail {
    /// Returns the number of points whose last coefficients are expected to be `goal`, if coefficients go on to fall at the same rate. This tail
    /// belongs to an expansion through `count` points. `None` above [`MOST_POINTS`].
    fn points(self, count: usize, goal: f64) -> Option<usize> {
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
        let tail = NetTail { last: tail(13), before: tail(10) };
        let points = tail.points(16, 1e-11);
        // 0.3^21.04 is 1e-11: 8.04 more, and a tenth.
        assert_eq!(points, Some(16 + 9));
        assert_eq!(tail.points(16, 1e-6), Some(16));
        let flat = NetTail { last: 1e-3, before: 1e-3 };
        assert_eq!(flat.points(16, 1e-11), None);
        assert_eq!(tail.points(36, 1e-11), None);
        let unknown = NetTail { last: f64::NAN, ..flat };
        assert_eq!(unknown.points(16, 1e-11), None);
    }
}
