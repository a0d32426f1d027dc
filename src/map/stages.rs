//! Stages of a run and their wall seconds.

use crate::stopwatch::Stopwatch;
use std::time::Duration;

/// Stage of a run. Stages follow each other for one row batch; only packing runs beside the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Stage of the sheets: folds, lattices, exact row boundaries, and the expansions of a spectral engine.
    Sheets,
    /// Stage of the base points of rows and the trajectories that an engine gets with them.
    BasePoints,
    /// Stage in which the spectral engine solves cells.
    Expansions,
    /// Stage in which the lattice provides guesses.
    Guesses,
    /// Stage of Newton's method in `f64`.
    Refinement,
    /// Stage of audit, regimes, and values in map units.
    Classification,
    /// Stage in which finished panels are packed and written while the next ones are computed.
    Packing,
}

impl Stage {
    /// All stages of a run with their names, in order.
    pub const ALL: [(Self, &str); 7] = [
        (Self::Sheets, "sheets"),
        (Self::BasePoints, "base points"),
        (Self::Expansions, "expansions"),
        (Self::Guesses, "guesses"),
        (Self::Refinement, "refinement"),
        (Self::Classification, "classification"),
        (Self::Packing, "packing"),
    ];
}

/// Wall time of each stage of a run, in the order of [`Stage::ALL`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StageTimes(pub [Duration; Stage::ALL.len()]);

impl StageTimes {
    /// Calls `work` and adds its wall time to `stage`. Returns its result.
    pub fn time<R>(&mut self, stage: Stage, work: impl FnOnce() -> R) -> R {
        let begun = Stopwatch::start();
        let done = work();
        self.0[stage as usize] += begun.elapsed();
        done
    }
}

/// Returns the CPU seconds of this process since it started; `None` if the system has no such clock.
pub(super) fn process_seconds() -> Option<f64> {
    #[cfg(unix)]
    return Some(seconds(rustix::time::ClockId::ProcessCPUTime));
    #[cfg(not(unix))]
    None
}

/// Returns the CPU seconds of this thread since it started; `None` where the system has no such clock.
#[must_use]
pub fn thread_seconds() -> Option<f64> {
    #[cfg(unix)]
    return Some(seconds(rustix::time::ClockId::ThreadCPUTime));
    #[cfg(not(unix))]
    None
}

#[cfg(unix)]
fn seconds(clock: rustix::time::ClockId) -> f64 {
    let time = rustix::time::clock_gettime(clock);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}
