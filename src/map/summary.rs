//! What a run says about itself when it is done.

use super::Panel;
use crate::classify::{Regime, Status};
use crate::integrate::EngineError;
use serde::{Deserialize, Serialize};
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
    /// Waiting for what keeps the panels: it packs and writes them while the next ones are computed.
    Files,
}

impl Stage {
    /// Every stage, in order, and its name.
    pub const ALL: [(Self, &str); 6] = [
        (Self::Sheets, "sheets"),
        (Self::Guesses, "guesses"),
        (Self::Shooting, "shooting"),
        (Self::Refinement, "refinement"),
        (Self::Regimes, "regimes"),
        (Self::Files, "files"),
    ];
}

/// What became of the shots of a run, one for each cell with a guess.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shots {
    /// How many there were.
    pub all: u64,
    /// Those that ended without a solution, or with numbers that are not finite: the refinement in `f64` started them
    /// again from their guess.
    pub restarted: u64,
    /// Those that no engine solved because that of the run had failed: the refinement started from their guesses.
    pub on_cpu_instead: u64,
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
    /// Cells with a state whose contact slides toward the base, against the friction assumed.
    pub toward_base: u64,
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
        self.add(stage, start.elapsed());
        result
    }

    /// Adds to the time of `stage`.
    pub(super) fn add(&mut self, stage: Stage, time: Duration) {
        self.times[stage as usize] += time;
    }

    /// Adds a finished panel.
    pub(super) fn count(&mut self, panel: &Panel) {
        for (cells, regime) in self.regimes.iter_mut().zip(Regime::ALL) {
            let codes = panel.regime.iter();
            *cells += codes.filter(|code| **code == regime.code()).count() as u64;
        }
        let verdicts = panel.regime.iter().zip(&panel.status);
        for (residual, (regime, status)) in panel.residual.iter().zip(verdicts) {
            if residual.is_finite() && *regime != Regime::Unresolved.code() {
                self.refined += 1;
                self.worst_residual = self.worst_residual.max(f64::from(*residual));
            }
            self.disagreements += u64::from(*status == Status::Disagreement.code());
            self.toward_base += u64::from(*status == Status::TowardBase.code());
        }
        let steps = panel.newton_steps.iter().copied();
        self.steps += steps.map(u64::from).sum::<u64>();
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

    /// What `stage` took.
    #[must_use]
    pub fn seconds(&self, stage: Stage) -> f64 {
        self.times[stage as usize].as_secs_f64()
    }
}
