//! Outcomes, regimes and statuses of map cells.
//!
//! [`RowBoundary::classify`] is total: every push angle and every outcome has a regime, possibly `unresolved`.

mod outcome;
mod row;

pub use outcome::Outcome;
pub use row::{PushSpan, RowBoundary, TIE};

use std::collections::BTreeMap;

/// Returns the number of cells of each code of a regime or status among the `codes` of cells. It counts runs, as neighbouring cells mostly have the same code.
#[must_use]
pub fn cells_by_code(codes: &[u32]) -> BTreeMap<u32, u64> {
    let mut cells = BTreeMap::new();
    for run in codes.chunk_by(|a, b| a == b) {
        *cells.entry(run[0]).or_default() += run.len() as u64;
    }
    cells
}

/// Defines an enum whose variants each have a code, for files, and a name, for files and messages.
macro_rules! named {
    ($(#[$outer:meta])* pub enum $kind:ident {
        $($(#[$inner:meta])* $variant:ident = $code:literal, $name:literal;)*
    }) => {
        $(#[$outer])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u32)]
        #[non_exhaustive]
        pub enum $kind { $($(#[$inner])* $variant = $code,)* }

        $crate::names::names!($kind { $($variant = $name),* });

        impl $kind {
            /// Returns the code of the regime or status in files.
            #[must_use]
            pub const fn code(self) -> u32 {
                self as u32
            }
        }
    };
}

named! {
    /// Regime of a cell: state or loss of contact of a whisker at one push angle and distance. The discriminants are the codes of the
    /// stored map.
    pub enum Regime {
        /// The resting whisker does not touch the pole at this distance, and no stable state exists.
        OutOfReach = 0, "out of reach";
        /// In contact: the state is connected to first touch at constant pole distance.
        Contact = 1, "contact";
        /// The whisker has slipped off: the push angle lies beyond the fold.
        SlipOff = 2, "slip-off";
        /// The whisker has been pulled off: the contact reached the tip before a fold.
        PullOff = 3, "pull-off";
        /// A stable state exists, but no push from rest reaches it.
        Unreachable = 4, "contact, not reachable by pushing";
        /// No regime was determined; the status of the cell names the reason.
        Unresolved = 255, "unresolved";
    }
}

named! {
    /// Status of a cell in a map: how it was solved, or why it was not. The discriminants are the codes of the stored map. A status follows from
    /// the [`Outcome`] of the cell and the boundary of its row, and with friction from the history of the contact.
    pub enum Status {
        /// A state of the cell was found on the stable sheet.
        Solved = 0, "state found";
        /// The sheet has no solution near the cell, so no trajectory was computed.
        Outside = 1, "outside the sheet";
        /// The cell has no state: the fold at this distance lies before the push angle.
        BeyondFold = 2, "beyond the fold";
        /// The state found for the cell lies beyond the tip.
        BeyondTip = 3, "beyond the tip";
        /// A state of the cell was found, and its contact slides toward the base.
        TowardBase = 4, "state found, it slides toward the base";
        /// A state of the cell was found, and its contact sticks where its last sliding ended.
        Sticking = 5, "state found, it sticks";
        /// The whisker is in contact, but with friction the state depends on a course of the contact that was not found.
        NoState = 6, "in contact, its state with friction not found";
        /// The push ends where a contact that slides toward the tip detaches, but with friction the contact does not slide there.
        AssumedEnd = 7, "beyond an end to which the contact does not slide";
        /// Newton's method failed for the cell, and the fold did not decide.
        NotConverged = 101, "unresolved: Newton's method did not converge";
        /// The cell and the boundary of its row contradict each other.
        Disagreement = 102, "unresolved: cell and boundary disagree";
        /// The boundary of the cell's row was not found, or only in part.
        NoBoundary = 103, "unresolved: boundary not found";
        /// The row of the table of whiskers has no whisker; the scene names the reason.
        NoWhisker = 104, "unresolved: no whisker";
    }
}

impl Status {
    /// Statuses of states whose contact does not slide toward the tip.
    pub const NOT_TOWARD_TIP: [Self; 2] = [Self::TowardBase, Self::Sticking];
}
