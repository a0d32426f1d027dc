//! Counts and times of a run.

use super::times::StageTimes;
use super::{Panel, Stage};
use crate::classify::{Outcome, Regime, Status, cells_by_code};
use crate::engine::{EngineDescription, EngineError};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Numbers of cells of a run by their outcome in the engine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EngineCells {
    /// Number of cells that the engine solved.
    pub solved: u64,
    /// Number of cells that fell back to the CPU because they lie next to the tip, or to the end of a known row.
    pub near_edge: u64,
    /// Number of cells that fell back to the CPU because the bound on the residual was too large.
    pub missed: u64,
    /// Number of cells that fell back to the CPU because of numbers that are not finite.
    pub not_finite: u64,
    /// Number of cells that the engine did not get: their row has no expansions, or ends before them.
    #[serde(rename = "without_reference")]
    pub without_row: u64,
    /// Number of cells that the CPU solved because the engine had failed.
    pub on_cpu_instead: u64,
}

impl EngineCells {
    /// Returns the number of cells that fell back to the CPU because the engine could not certify them.
    #[must_use]
    pub const fn fallback(&self) -> u64 {
        self.near_edge + self.missed + self.not_finite
    }

    /// Counts one cell that the engine returned with this `outcome`. [`EngineCells::add_others`] counts the cells without
    /// a row.
    pub(super) fn count(&mut self, outcome: Outcome) {
        match outcome {
            Outcome::Solved => self.solved += 1,
            Outcome::NearEdge => self.near_edge += 1,
            Outcome::Missed => self.missed += 1,
            Outcome::NoRow | Outcome::BeyondTip | Outcome::OffSheet => {}
            _ => self.not_finite += 1,
        }
    }

    /// Counts cells that the engine did not get, because it had failed or they had no row.
    pub(super) const fn add_others(&mut self, cells: u64, has_failed: bool) {
        match has_failed {
            true => self.on_cpu_instead += cells,
            false => self.without_row += cells,
        }
    }
}

/// Result of the audit of an engine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Audit {
    /// Number of audited cells, which the CPU solved once more.
    pub cells: u64,
    /// Number of audited cells that differ by more than the tolerance.
    pub differing: u64,
    /// Number of cells that the CPU solved instead of the engine because an audited one differed.
    pub turned_over: u64,
}

impl std::ops::AddAssign for Audit {
    fn add_assign(&mut self, more: Self) {
        self.cells += more.cells;
        self.differing += more.differing;
        self.turned_over += more.turned_over;
    }
}

/// Cells that are counted together: they stay in a core's innermost cache.
const AT_ONCE: usize = 2048;

/// Counts and times of a run.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Number of cells of the run with each regime, in the order of [`Regime::ALL`].
    pub regimes: [u64; Regime::ALL.len()],
    /// Number of cells of the run with a state.
    pub refined: u64,
    /// Number of Newton steps, summed over all cells.
    pub steps: u64,
    /// Largest residual of a cell with a state, in whisker lengths; 0 if no cell has one.
    pub worst_residual: f64,
    /// Number of cells whose own verdict contradicts the boundary of their row.
    pub disagreements: u64,
    /// Number of cells of rows of the table that have no whisker; they are unresolved, too.
    pub without_whisker: u64,
    /// Number of cells with a state whose contact slides toward the base.
    pub toward_base: u64,
    /// Number of cells with a state whose contact sticks.
    pub sticking: u64,
    /// Number of cells in contact whose state with friction was not found.
    pub without_state: u64,
    /// Number of cells beyond the yield strain; 0 if the largest strains are not computed, or the scene has no yield strain.
    pub yielding: u64,
    /// Engine of the run, and its hardware.
    pub engine: EngineDescription,
    /// Numbers of cells of the run by their outcome in the engine.
    pub engine_cells: EngineCells,
    /// Number of trajectories of nets that the engine integrated.
    pub trajectories: u64,
    /// Result of the audit of the run's engine.
    pub audit: Audit,
    /// Failure of the engine, after which the CPU solved all cells; `None` without one.
    pub engine_failure: Option<EngineError>,
    /// True if the run was cancelled: its last panels are missing.
    pub is_cancelled: bool,
    /// Wall seconds of the run, from the first sheet to the last panel kept.
    pub wall_seconds: f64,
    /// CPU seconds of the process during the run, over all its threads; `None` where the system has no such clock.
    pub cpu_seconds: Option<f64>,
    /// Busy seconds of an engine with a thread of its own, beside the stages.
    pub device_seconds: f64,
    /// Seconds of [`Self::device_seconds`] for which the threads waited for the engine.
    pub waiting_seconds: f64,
    pub(super) stages: StageTimes,
}

impl Summary {
    /// Adds the cells of a finished panel of a whisker with this yield strain to the counts.
    pub(super) fn count(&mut self, panel: &Panel, yield_strain: Option<f64>) {
        if let Some(most) = yield_strain {
            let strains = panel.peak_strain.par_iter();
            let beyond = strains.filter(|strain| f64::from(**strain) > most);
            self.yielding += beyond.count() as u64;
        }
        let codes = [&panel.regime, &panel.status, &panel.newton_steps];
        let [regimes, statuses, steps] = codes.map(|codes| codes.par_chunks(AT_ONCE));
        let chunks = (regimes, statuses, panel.residual.par_chunks(AT_ONCE), steps);
        let parts: Vec<Self> = chunks
            .into_par_iter()
            .map(|(regimes, statuses, residuals, steps)| {
                let mut part = Self::default();
                part.count_cells(regimes, statuses, residuals, steps);
                part
            })
            .collect();
        for part in parts {
            for (cells, more) in self.regimes.iter_mut().zip(part.regimes) {
                *cells += more;
            }
            self.refined += part.refined;
            self.steps += part.steps;
            self.worst_residual = self.worst_residual.max(part.worst_residual);
            self.disagreements += part.disagreements;
            self.without_whisker += part.without_whisker;
            self.toward_base += part.toward_base;
            self.sticking += part.sticking;
            self.without_state += part.without_state;
        }
    }

    /// Counts cells by their codes of regime and status, their residuals and steps.
    fn count_cells(&mut self, regimes: &[u32], statuses: &[u32], residuals: &[f32], steps: &[u32]) {
        let [regime_counts, status_counts] = [regimes, statuses].map(cells_by_code);
        let of = |counts: &BTreeMap<u32, u64>, code| counts.get(&code).copied().unwrap_or(0);
        self.regimes = Regime::ALL.map(|regime| of(&regime_counts, regime.code()));
        let mut worst = 0.0_f32;
        for (residual, regime) in residuals.iter().zip(regimes) {
            let has_state = residual.is_finite() && *regime != Regime::Unresolved.code();
            self.refined += u64::from(has_state);
            worst = worst.max(if has_state { *residual } else { 0.0 });
        }
        self.worst_residual = worst.into();
        self.disagreements = of(&status_counts, Status::Disagreement.code());
        self.without_whisker = of(&status_counts, Status::NoWhisker.code());
        self.toward_base = of(&status_counts, Status::TowardBase.code());
        self.sticking = of(&status_counts, Status::Sticking.code());
        self.without_state = of(&status_counts, Status::NoState.code());
        self.steps = steps.iter().copied().map(u64::from).sum();
    }

    /// Returns the number of cells of the map.
    #[must_use]
    pub fn cells(&self) -> u64 {
        self.regimes.iter().sum()
    }

    /// Returns the number of cells of the map without a regime.
    #[must_use]
    pub fn unresolved(&self) -> u64 {
        self.regimes[Regime::ALL.len() - 1]
    }

    /// Returns the numbers of cells without a regime and of all cells of existing whiskers: `[unresolved, all]`.
    #[must_use]
    pub fn unresolved_of_all(&self) -> [u64; 2] {
        [self.unresolved(), self.cells()].map(|cells| cells - self.without_whisker)
    }

    /// Returns the wall seconds of `stage`. All stages but [`Stage::Packing`] follow each other.
    #[must_use]
    pub const fn stage_seconds(&self, stage: Stage) -> f64 {
        self.stages.0[stage as usize].as_secs_f64()
    }
}
