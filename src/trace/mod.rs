//! Exact lines through the parameter space, in `f64`: detachment curves, solution branches, shapes.
//!
//! A detachment curve is the image of two edges of the stable sheet, so it comes from [`crate::sheet`]. A branch goes
//! on where the sheet ends, past the fold and along the unstable states, and is followed by continuation.

mod branch;
mod columns;
mod curve;
mod resample;
mod shape;
mod state;

pub use branch::{Branch, BranchPoint};
pub use curve::{Corner, Detachment, DetachmentKind, NoCorner, corner, curve, curve_at};
pub use shape::{Part, Shape, ShapePoint};
pub use state::Found;

pub(crate) use columns::row;

use crate::rod::Side;
use crate::scene::{SweepPlace, SweptWhisker};
use crate::shooting::Resolution;
use rayon::prelude::*;
use serde::Serialize;

/// Twice as fine as [`Resolution::FINE`]: unstable states carry larger loads.
const FINER: Resolution = Resolution::FINE.doubled();

/// What is special about a point of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mark {
    /// The resting whisker touches the pole.
    FirstTouch,
    /// The saddle-node, where the stable states end.
    SlipOff,
    /// The stable states end with the contact at the tip.
    PullOff,
    /// The unstable states do.
    Tip,
    /// The unstable states end at a fold of their own.
    SecondFold,
}

/// Ends of pushes held at a time, of some 250 bytes each.
const ENDS_AT_ONCE: usize = 1 << 19;

/// Most whiskers whose curves are computed together: enough for several threads.
const MOST_WHISKERS: usize = 64;

/// Whiskers to compute together where each has ends at so many `distances` on both sides.
#[must_use]
pub fn whiskers_at_once(distances: usize) -> usize {
    (ENDS_AT_ONCE / (2 * distances)).clamp(1, MOST_WHISKERS)
}

/// What `of_side` makes of each side of each whisker, in their order, CF before CB.
pub fn sides<R: Send>(
    whiskers: &[SweptWhisker],
    of_side: impl Fn(&SweptWhisker, Side) -> Vec<R> + Sync,
) -> Vec<(SweepPlace, R)> {
    let both = |swept| Side::BOTH.map(|side| (swept, side));
    let faces: Vec<(&SweptWhisker, Side)> = whiskers.iter().flat_map(both).collect();
    let of_face = |(swept, side): (&SweptWhisker, Side)| {
        let place = swept.place.clone();
        let rows = of_side(swept, side).into_iter();
        rows.map(move |row| (place.clone(), row))
    };
    faces.into_par_iter().flat_map_iter(of_face).collect()
}

/// Why there is no state.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoState {
    /// The whisker at rest does not reach the pole.
    #[error("out of reach: the tip of the resting whisker is {reach_mm:.9} mm from its base")]
    OutOfReach {
        /// The farthest first touch of a point contact.
        reach_mm: f64,
    },
    /// The base has turned away from the pole.
    #[error(
        "lost touch: the whisker has moved away from the pole; must be between {:.9} and {:.9} deg", .stays_deg[0], .stays_deg[1]
    )]
    LostTouch {
        /// The push angles that keep it on the pole, from the smaller to the larger.
        stays_deg: [f64; 2],
    },
    /// The push goes beyond the fold.
    #[error("slipped off at {at_deg:.9} deg")]
    SlippedOff {
        /// Signed push angle of the fold.
        at_deg: f64,
    },
    /// The push goes beyond the tip.
    #[error("pulled off at {at_deg:.9} deg")]
    PulledOff {
        /// Signed push angle at which the tip reaches the pole.
        at_deg: f64,
    },
    /// There are no unstable states.
    #[error("no unstable state: pulled off at {at_deg:.9} deg, before any fold")]
    NoFold {
        /// Signed push angle at which the tip reaches the pole.
        at_deg: f64,
    },
    /// The unstable states lie elsewhere.
    #[error("the unstable states lie between {:.9} and {:.9} deg", .ends_deg[0], .ends_deg[1])]
    NotUnstable {
        /// Signed push angles of the fold and of the branch's end.
        ends_deg: [f64; 2],
    },
    /// The continuation failed.
    #[error("the continuation of the branch got lost near {push_deg} deg")]
    Lost {
        /// Signed push angle.
        push_deg: f64,
    },
}
