//! What a run says about itself when it is done.

use crate::classify::{Regime, Status};
use crate::integrate::EngineError;
use crate::store::{Panel, Shots};
use std::time::{Duration, Instant};

/// The stages of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Folds, lattices and boundaries.
    Sheets,
    /// Guesses from the lattice.
    Guesses,
    /// The engine.
    Shooting,
    /// Newton's method in `f64`.
    Refinement,
    /// Regimes and units.
    Regimes,
    /// Packing and writing.
    Files,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::Sheets, "sheets"),
        (Self::Guesses, "guesses"),
        (Self::Shooting, "shooting"),
        (Self::Refinement, "refinement"),
        (Self::Regimes, "regimes"),
        (Self::Files, "files"),
    ];
}

/// Counts and times of a run.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Cells per regime, in the order of [`Regime::ALL`].
    pub regimes: [u64; Regime::ALL.len()],
    /// Cells with a state, refined in `f64`.
    pub refined: u64,
    /// Newton steps over all cells.
    pub steps: u64,
    /// Largest residual of a cell with a state, in whisker lengths.
    pub worst_residual: f64,
    /// Cells whose own verdict contradicts the boundary of their row.
    pub disagreements: u64,
    /// What became of the engine's shots.
    pub shots: Shots,
    /// Why the CPU went on in the engine's stead, if it did.
    pub engine_failure: Option<EngineError>,
    times: [Duration; Stage::ALL.len()],
}

impl Summary {
    /// Runs `work` on the clock of `stage`.
    pub(super) fn time<R>(&mut self, stage: Stage, work: impl FnOnce() -> R) -> R {
        let start = Instant::now();
        let result = work();
        self.times[stage as usize] += start.elapsed();
        result
    }

    /// Adds a finished panel.
    pub(super) fn count(&mut self, panel: &Panel) {
        for (slot, regime) in self.regimes.iter_mut().zip(Regime::ALL) {
            *slot += panel
                .regime
                .iter()
                .filter(|code| **code == regime.code())
                .count() as u64;
        }
        let verdicts = panel.regime.iter().zip(&panel.status);
        for (residual, (regime, status)) in panel.residual.iter().zip(verdicts) {
            if residual.is_finite() && *regime != Regime::Unresolved.code() {
                self.refined += 1;
                self.worst_residual = self.worst_residual.max(f64::from(*residual));
            }
            self.disagreements += u64::from(*status == Status::Disagreement.code());
        }
        self.steps += panel
            .newton_steps
            .iter()
            .map(|steps| u64::from(*steps))
            .sum::<u64>();
    }

    /// Cells of the map.
    #[must_use]
    pub fn cells(&self) -> u64 {
        self.regimes.iter().sum()
    }

    /// Cells without an answer.
    #[must_use]
    pub fn unresolved(&self) -> u64 {
        self.regimes[Regime::ALL.len() - 1]
    }

    /// Seconds per stage, in order, with their names.
    pub fn seconds(&self) -> impl Iterator<Item = (&'static str, f64)> {
        Stage::ALL
            .iter()
            .zip(self.times)
            .map(|((_, name), time)| (*name, time.as_secs_f64()))
    }
}
