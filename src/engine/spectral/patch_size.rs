//! Sizes of patches: the first one, the usual one, and those that the decay of coefficients calls for.

use super::expansion_tail::ExpansionTail;
use super::row::larger;
use crate::numerics::expansion::{MOST_POINTS, TAIL};
use crate::plan::USUAL_PATCH;

/// Part of the bound that the coefficients left out are expected to take. At most `1 / MARGIN` is allowed.
const LEFT_OUT: f64 = 0.1;

/// Expected error, in whisker lengths, above which coefficients do not yet fall at their final rate.
const HOPELESS: f64 = 1.0;

/// Size of a patch: its number of rows, and of states along each.
#[derive(Clone, Copy, Debug)]
pub struct PatchSize {
    /// Number of rows of the patch with exact states.
    pub rows: usize,
    /// Number of exact states along each row of the patch.
    pub states: usize,
}

impl PatchSize {
    /// Size of the first patch over an interval: the decay of its coefficients shows how many more are needed.
    pub const FIRST: Self = Self {
        rows: 12,
        states: 16,
    };

    /// Size of most certified patches.
    pub const USUAL: Self = Self {
        rows: USUAL_PATCH[0],
        states: USUAL_PATCH[1],
    };

    /// Returns the number of exact states of a patch of this size: rows times states along each.
    pub const fn count(self) -> usize {
        self.rows * self.states
    }

    /// Next size with more rows and more states along each; `None` if there is none.
    pub fn larger(self) -> Option<Self> {
        let [rows, states] = [self.rows, self.states].map(|count| count + TAIL);
        (rows.max(states) <= MOST_POINTS).then_some(Self { rows, states })
    }

    /// Size whose expansions are expected to keep the bound `most`, where those of this size have these `tails` from row to row and along
    /// rows; `None` if there is none.
    pub fn enough(self, tails: [ExpansionTail; 2], most: f64) -> Option<Self> {
        if larger(tails[0].last, tails[1].last) > HOPELESS {
            return None;
        }
        Some(Self {
            rows: tails[0].points(self.rows, LEFT_OUT * most)?,
            states: tails[1].points(self.states, LEFT_OUT * most)?,
        })
    }
}
