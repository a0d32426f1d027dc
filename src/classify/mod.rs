//! The regimes of a map cell, and how each cell came to its own.

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
