//! The stages of a run. They overlap, so that each has CPU time and none a time of its own on the wall.

use crate::account::Account;
use std::time::Duration;

/// The stages of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Folds, lattices and boundaries.
    Sheets,
    /// Guesses from the lattice.
    Guesses,
    /// References of rows, and the CPU's part in asking an engine about their cells.
    References,
    /// Newton's method in `f64`.
    Refinement,
    /// Regimes and units, and the audit's verdicts on an engine's cells.
    Judging,
    /// What keeps the panels: it packs and writes them while the next ones are computed.
    Packing,
}

impl Stage {
    /// Every stage, in order, and its name.
    pub const ALL: [(Self, &str); 6] = [
        (Self::Sheets, "sheets"),
        (Self::Guesses, "guesses"),
        (Self::References, "references"),
        (Self::Refinement, "refinement"),
        (Self::Judging, "judging"),
        (Self::Packing, "packing"),
    ];
}

/// CPU time of the stages of a run under way.
#[derive(Default)]
pub struct Stages([Account; Stage::ALL.len()]);

impl Stages {
    /// Does `work` for `stage`.
    pub fn of<R>(&self, stage: Stage, work: impl FnOnce() -> R) -> R {
        self.0[stage as usize].of(work)
    }

    /// That of `stage`.
    pub const fn account(&self, stage: Stage) -> &Account {
        &self.0[stage as usize]
    }

    /// What each stage has taken up to now.
    pub fn times(&self) -> [Duration; Stage::ALL.len()] {
        self.0.each_ref().map(Account::time)
    }
}
