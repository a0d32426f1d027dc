//! The regimes of a map cell, and how each cell came to its own.
//!
//! [`RowBoundary::judge`] is total: every push angle and every status has a regime, `unresolved` included.

mod row;

pub use row::{RowBoundary, Span, TIE};

/// What becomes of a whisker at `(push angle, distance)`. The discriminants are the codes of the stored map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum Regime {
    /// No touch at this distance, and no stable state.
    OutOfReach = 0,
    /// In contact, connected to first touch at constant pole distance.
    Contact = 1,
    /// Beyond the fold: the whisker has slipped off.
    SlipOff = 2,
    /// The tip reached the pole before the fold.
    PullOff = 3,
    /// A stable state that no push from rest reaches.
    Unreachable = 4,
    /// No answer; the cell's status says why.
    Unresolved = 255,
}

impl Regime {
    /// Every regime, in the order of its code.
    pub const ALL: [Self; 6] = [
        Self::OutOfReach,
        Self::Contact,
        Self::SlipOff,
        Self::PullOff,
        Self::Unreachable,
        Self::Unresolved,
    ];

    /// The code written to files.
    #[must_use]
    pub const fn code(self) -> u32 {
        self as u32
    }

    /// The name written to files and shown to people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::OutOfReach => "out of reach",
            Self::Contact => "contact",
            Self::SlipOff => "slip-off",
            Self::PullOff => "pull-off",
            Self::Unreachable => "contact, not reachable by pushing",
            Self::Unresolved => "unresolved",
        }
    }
}

/// How a cell was settled, or why it was not. The discriminants are the codes of the stored map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum Status {
    /// A state was found on the stable sheet.
    Solved = 0,
    /// The lattice has no solution near: no trajectory was needed.
    Outside = 1,
    /// The fold at this distance lies before the push angle.
    BeyondFold = 2,
    /// The state found lies beyond the tip.
    BeyondTip = 3,
    /// Unresolved: Newton's method failed, and the fold did not decide.
    NotConverged = 101,
    /// Unresolved: the cell and the boundary of its row contradict each other.
    Disagreement = 102,
    /// Unresolved: the boundary of the row was not found.
    NoBoundary = 103,
    /// Unresolved: the whisker has no fold at some contact.
    NoFold = 104,
}

impl Status {
    /// Every status, in the order of its code.
    pub const ALL: [Self; 8] = [
        Self::Solved,
        Self::Outside,
        Self::BeyondFold,
        Self::BeyondTip,
        Self::NotConverged,
        Self::Disagreement,
        Self::NoBoundary,
        Self::NoFold,
    ];

    /// The code written to files.
    #[must_use]
    pub const fn code(self) -> u32 {
        self as u32
    }

    /// The name written to files and shown to people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Solved => "state found",
            Self::Outside => "outside the sheet",
            Self::BeyondFold => "beyond the fold",
            Self::BeyondTip => "beyond the tip",
            Self::NotConverged => "unresolved: Newton's method did not converge",
            Self::Disagreement => "unresolved: cell and boundary disagree",
            Self::NoBoundary => "unresolved: boundary not found",
            Self::NoFold => "unresolved: no fold found",
        }
    }
}
