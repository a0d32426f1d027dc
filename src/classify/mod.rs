//! The regimes of a map cell, and how each cell came to its own.
//!
//! [`RowBoundary::judge`] is total: every push angle and every status has a regime, `unresolved` included.

mod dragged;
mod limit;
mod row;
mod sliding;

pub use dragged::Dragged;
pub use row::{RowBoundary, Span, TIE};
pub use sliding::Sliding;

/// An enum whose variants each have a code, for files, and a name, for files and people.
macro_rules! named {
    ($(#[$outer:meta])* pub enum $kind:ident {
        $($(#[$inner:meta])* $variant:ident = $code:literal, $name:literal;)*
    }) => {
        $(#[$outer])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u32)]
        pub enum $kind { $($(#[$inner])* $variant = $code,)* }

        impl $kind {
            /// All of them, in the order of their codes.
            pub const ALL: [Self; [$($code),*].len()] = [$(Self::$variant),*];

            /// The code written to files.
            #[must_use]
            pub const fn code(self) -> u32 {
                self as u32
            }

            /// The name written to files and shown to people.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),* }
            }
        }
    };
}

named! {
    /// What becomes of a whisker at `(push angle, distance)`. The discriminants are the codes of the stored map.
    pub enum Regime {
        /// No touch at this distance, and no stable state.
        OutOfReach = 0, "out of reach";
        /// In contact, connected to first touch at constant pole distance.
        Contact = 1, "contact";
        /// Beyond the fold: the whisker has slipped off.
        SlipOff = 2, "slip-off";
        /// The tip reached the pole before the fold.
        PullOff = 3, "pull-off";
        /// A stable state that no push from rest reaches.
        Unreachable = 4, "contact, not reachable by pushing";
        /// No answer; the cell's status says why.
        Unresolved = 255, "unresolved";
    }
}

named! {
    /// How a cell was settled, or why it was not. The discriminants are the codes of the stored map.
    pub enum Status {
        /// A state was found on the stable sheet.
        Solved = 0, "state found";
        /// The lattice has no solution near: no trajectory was needed.
        Outside = 1, "outside the sheet";
        /// The fold at this distance lies before the push angle.
        BeyondFold = 2, "beyond the fold";
        /// The state found lies beyond the tip.
        BeyondTip = 3, "beyond the tip";
        /// A state was found, but its contact slides toward the base, and friction was computed as of one that slides
        /// toward the tip: regime and margin hold, force and moment are off.
        TowardBase = 4, "state found, but it slides toward the base, against the friction assumed";
        /// A state was found, but after sliding toward the base its contact sticks, with less friction than one that slides
        /// has, and depends on what was before: regime and margin hold, contact, force and moment are off.
        Sticking = 5, "state found, but it sticks where it was dragged before, with less friction than assumed";
        /// Newton's method failed, and the fold did not decide.
        NotConverged = 101, "unresolved: Newton's method did not converge";
        /// The cell and the boundary of its row contradict each other.
        Disagreement = 102, "unresolved: cell and boundary disagree";
        /// The boundary of the row was not found, or not all of it.
        NoBoundary = 103, "unresolved: boundary not found";
    }
}

impl Status {
    /// Statuses of states whose friction is not the one assumed: contact, force and moment are off.
    pub const MARKS: [Self; 2] = [Self::TowardBase, Self::Sticking];
}
