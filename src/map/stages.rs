//! The stages of a run and their wall seconds.

use std::time::{Duration, Instant};

/// A stage of a run. Stages follow each other for one row batch; only packing runs beside the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Folds, lattices and exact row boundaries.
    Sheets,
    /// Base points of rows and the trajectories that an engine gets with them.
    BasePoints,
    /// Guesses from the lattice.
    Guesses,
    /// Newton's method in `f64`.
    Refinement,
    /// Audit, regimes, and values in map units.
    Classification,
    /// Packing and writing of finished panels while the next ones are computed.
    Packing,
}

impl Stage {
    /// Every stage with its name, in order.
    pub const ALL: [(Self, &str); 6] = [
        (Self::Sheets, "sheets"),
        (Self::BasePoints, "base points"),
        (Self::Guesses, "guesses"),
        (Self::Refinement, "refinement"),
        (Self::Classification, "classification"),
        (Self::Packing, "packing"),
    ];
}

/// Wall time per stage, in the order of [`Stage::ALL`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StageTimes([Duration; Stage::ALL.len()]);

impl StageTimes {
    /// Does `work` and adds its wall time to `stage`.
    pub fn time<R>(&mut self, stage: Stage, work: impl FnOnce() -> R) -> R {
        let begun = Instant::now();
        let done = work();
        self.add(stage, begun.elapsed());
        done
    }

    /// Adds wall time to `stage`.
    pub fn add(&mut self, stage: Stage, time: Duration) {
        self.0[stage as usize] += time;
    }

    /// Wall time of `stage`.
    pub const fn of(&self, stage: Stage) -> Duration {
        self.0[stage as usize]
    }
}

/// CPU time of this process since it started; `None` where the system has no such clock.
#[cfg(unix)]
pub(super) fn process_time() -> Option<Duration> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(Duration::new(time.tv_sec as u64, time.tv_nsec as u32))
}

#[cfg(not(unix))]
pub(super) const fn process_time() -> Option<Duration> {
    None
}
