//! Where along a row to look for a push angle.

use crate::numerics::newton_form::oriented;
use crate::numerics::newton_form_simd::Numbers;

/// How far beyond the lattice's own detachment angle, in radians, a guess is still made: on most whiskers many times the
/// interpolation error. A row with a cell that is missed for all that is walked.
pub const MARGIN: f64 = 1e-4;

/// Where a row is asked for push angles.
pub struct Nodes {
    /// The loads, as parts of the fold's.
    pub part: Numbers,
    /// The push angles.
    pub push: Numbers,
    /// The largest of them.
    pub summit: f64,
    /// The roots of how far they are below it: at the fold the push angle is flat, and the place goes with this root.
    pub below: Numbers,
}

/// A push angle that is looked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Search {
    /// The push angle.
    pub target: f64,
    /// Where to start.
    pub near: f64,
    /// Two places, the second one with the larger push angle.
    pub between: [f64; 2],
}

impl Nodes {
    /// Where to look for a push angle between the node `i` and the next one; `None` where it is not near them.
    pub fn search(&self, i: usize, push: f64) -> Option<Search> {
        let pair = |numbers: &Numbers| [numbers[i], numbers[i + 1]];
        let ([low, high], [from, to]) = (pair(&self.part), pair(&self.push));
        if push < from - MARGIN || push > to + MARGIN {
            return None;
        }
        let target = push.max(from).min(to);
        let [below_low, below_high] = pair(&self.below);
        let below = (self.summit - target).max(0.0).sqrt();
        let part = if below_high < below_low {
            (below_low - below) / (below_low - below_high)
        } else {
            1.0
        };
        Some(Search {
            target,
            near: low + part * (high - low),
            between: oriented([low, high], [from, to]),
        })
    }
}
