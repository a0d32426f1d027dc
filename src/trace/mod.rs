//! Detachment curves, solution branches and whisker shapes, in `f64`.
//!
//! A detachment curve is the image of two edges of the stable sheet, which [`crate::sheet`] computes. A branch is computed by
//! continuation: it includes the unstable states beyond the fold, where the sheet ends.

mod branch;
mod columns;
mod corner;
mod curve;
mod peak;
mod resample;
mod shape;
mod stable;
mod state;

pub use branch::{BRANCH_POINTS, Branch, BranchPoint};
pub use corner::{Corner, NoCorner, corner};
pub use curve::{
    Detachment, DetachmentKind, EndDetail, PushedWhisker, curve, curve_at, ends_at, reach_mm,
};
pub(crate) use curve::{RowEnd, crossings, detachments, snaps_deg};
pub use peak::{PushLoad, PushPeak};
pub use shape::{SHAPE_POINTS, ShapePoint, WhiskerPart, WhiskerShape};
pub use stable::StableBranch;
pub use state::StateAtPush;

pub use columns::{ContactColumns, StateRow};
pub(crate) use columns::{column, row};

use crate::scene::{RefusedWhisker, SweepPlace, SweptWhisker};
use rayon::prelude::*;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Resolution;

/// Resolution of branches and shapes, twice as fine as [`Resolution::FINE`]: unstable states have larger loads.
pub(crate) const FINER: Resolution = Resolution::FINE.doubled();

/// Mark of a branch point that is special, such as its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BranchMark {
    /// Start of the branch: the resting whisker touches the pole.
    FirstTouch,
    /// Fold (saddle-node) of the branch, at which the stable states end.
    SlipOff,
    /// End of the branch's stable states with the contact at the tip.
    PullOff,
    /// End of the branch's unstable states with the contact at the tip.
    Tip,
    /// End of the branch's unstable states at a second fold.
    SecondFold,
}

/// Maximum number of ends of pushes in memory, of about 250 bytes each.
const ENDS_AT_ONCE: usize = 1 << 19;

/// Maximum number of whiskers whose ends are in memory together, enough for many threads.
const MOST_WHISKERS: usize = 1024;

/// Number of ends of pushes whose trajectories share batches. Most ends then have full lanes, whatever their numbers of steps. For one distance,
/// these are as many sheets of about 100 KiB.
const ENDS_OF_BATCH: usize = 128;

/// Returns the number of whiskers to compute together if each has ends at `distances` distances on both sides.
#[must_use]
pub fn whiskers_at_once(distances: usize) -> usize {
    (ENDS_AT_ONCE / (2 * distances.max(1))).clamp(1, MOST_WHISKERS)
}

/// Returns the number of sides, of `count` in total, whose ends at `distances` distances share batches. Each thread gets a batch.
#[must_use]
pub fn sides_at_once(count: usize, distances: usize) -> usize {
    let of_thread = count.div_ceil(rayon::current_num_threads());
    (ENDS_OF_BATCH / distances.max(1)).clamp(1, of_thread.max(1))
}

/// One side of a whisker of a sweep, or of a row of a table without a whisker.
#[derive(Clone, Copy, Debug)]
pub struct SweptSide<'a> {
    /// Whisker, or the row of the table without one.
    pub swept: Result<&'a SweptWhisker, &'a RefusedWhisker>,
    /// Whisker side.
    pub side: Side,
}

/// Returns the results for each side of each whisker, in the order of `whiskers`, CF before CB. Rows of a table without a whisker have results,
/// too. `of_sides` computes sides with ends at `distances` distances together, `[side][result]`.
pub fn sides<R: Send>(
    whiskers: &[Result<SweptWhisker, RefusedWhisker>],
    distances: usize,
    of_sides: impl Fn(&[SweptSide]) -> Vec<Vec<R>> + Sync,
) -> Vec<(SweepPlace, R)> {
    let whiskers = whiskers.iter().map(Result::as_ref);
    let both = |swept| Side::BOTH.map(|side| SweptSide { swept, side });
    let sides: Vec<SweptSide> = whiskers.flat_map(both).collect();
    let placed = |sides: &[SweptSide]| {
        let rows = sides.iter().zip(of_sides(sides)).flat_map(|(side, rows)| {
            let place = match side.swept {
                Ok(swept) => &swept.place,
                Err(refused) => &refused.place,
            };
            rows.into_iter().map(|row| (place.clone(), row))
        });
        rows.collect::<Vec<_>>()
    };
    let at_once = sides_at_once(sides.len(), distances);
    let chunks = sides.par_chunks(at_once);
    chunks.flat_map_iter(placed).collect()
}

/// Reason why a branch or a state does not exist, or was not computed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoState {
    /// The resting whisker does not reach the pole.
    #[error("out of reach: the tip of the resting whisker is {reach_mm:.9} mm from its base")]
    OutOfReach {
        /// Distance from the base to the tip of the resting whisker, in mm.
        reach_mm: f64,
    },
    /// The whisker has lost touch: the base is turned away from the pole.
    #[error(
        "lost touch: the whisker has moved away from the pole; must be between {:.9} and {:.9} deg", .stays_deg[0], .stays_deg[1]
    )]
    LostTouch {
        /// Smallest and largest push angle in contact, in degrees: `[smallest, largest]`.
        stays_deg: [f64; 2],
    },
    /// The whisker has slipped off: the push angle lies beyond the fold.
    #[error("slipped off at {at_deg:.9} deg")]
    SlippedOff {
        /// Signed push angle of the fold, in degrees.
        at_deg: f64,
    },
    /// The whisker has been pulled off: the push angle lies beyond the one at which the contact reaches the tip.
    #[error("pulled off at {at_deg:.9} deg")]
    PulledOff {
        /// Signed push angle at which the contact reaches the tip, in degrees.
        at_deg: f64,
    },
    /// The branch has no unstable states.
    #[error("no unstable state: pulled off at {at_deg:.9} deg, before any fold")]
    NoFold {
        /// Signed push angle at which the contact reaches the tip, in degrees.
        at_deg: f64,
    },
    /// The branch has unstable states, but not at this push angle.
    #[error("the unstable states lie between {:.9} and {:.9} deg", .ends_deg[0], .ends_deg[1])]
    NotUnstable {
        /// Signed push angles of the fold and of the end of the branch, in degrees: `[fold, end]`.
        ends_deg: [f64; 2],
    },
    /// With friction, the course of the contact up to the push angle was not found.
    #[error("the course of the contact up to {push_deg:.9} deg was not found")]
    NoCourse {
        /// Signed push angle of the state, in degrees.
        push_deg: f64,
    },
    /// The stable states do not end within nine turns of the base.
    #[error(
        "the stable states do not end within nine turns of the base (3240 deg), as where a follicle is much softer than its whisker"
    )]
    BeyondTurns,
    /// The continuation of the branch failed.
    #[error("the continuation of the branch failed near {push_deg} deg")]
    Failed {
        /// Signed push angle of the last node of the continuation, in degrees.
        push_deg: f64,
    },
    /// The computation was cancelled.
    #[error("cancelled")]
    Cancelled,
}
