//! Times of a run: wall seconds of its stages, and CPU seconds.

use crate::stopwatch::Stopwatch;
use std::time::Duration;

/// Stage of a run. Stages follow each other for one row batch; only packing runs beside the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Stage of the sheets: folds, nets and exact row boundaries.
    Sheets,
    /// Stage of the expansions of rows for an engine.
    Rows,
    /// Stage in which an engine on the CPU evaluates rows.
    Cells,
    /// Stage in which the net provides guesses.
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
        (Self::Rows, "rows"),
        (Self::Cells, "cells"),
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
#[must_use]
pub fn process_seconds() -> Option<f64> {
    #[cfg(unix)]
    return Some(seconds(rustix::time::ClockId::ProcessCPUTime));
    #[cfg(windows)]
    return windows::process_seconds();
    #[cfg(not(any(unix, windows)))]
    None
}

/// Returns the CPU seconds of this thread since it started; `None` where the system has no such clock.
#[must_use]
pub fn thread_seconds() -> Option<f64> {
    #[cfg(unix)]
    return Some(seconds(rustix::time::ClockId::ThreadCPUTime));
    #[cfg(windows)]
    return windows::thread_seconds();
    #[cfg(not(any(unix, windows)))]
    None
}

#[cfg(unix)]
fn seconds(clock: rustix::time::ClockId) -> f64 {
    let time = rustix::time::clock_gettime(clock);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

#[cfg(windows)]
#[allow(unsafe_code, reason = "only calls of the system return CPU times")]
mod windows {
    /// Times of a process or a thread: in 100 ns, of its start, its end, and what it spent in the system and outside.
    type Times = unsafe extern "system" fn(isize, *mut u64, *mut u64, *mut u64, *mut u64) -> i32;

    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn GetProcessTimes(
            process: isize,
            start: *mut u64,
            end: *mut u64,
            system: *mut u64,
            user: *mut u64,
        ) -> i32;
        fn GetThreadTimes(
            thread: isize,
            start: *mut u64,
            end: *mut u64,
            system: *mut u64,
            user: *mut u64,
        ) -> i32;
    }

    const CURRENT_PROCESS: isize = -1;
    const CURRENT_THREAD: isize = -2;

    pub fn process_seconds() -> Option<f64> {
        seconds(GetProcessTimes, CURRENT_PROCESS)
    }

    pub fn thread_seconds() -> Option<f64> {
        seconds(GetThreadTimes, CURRENT_THREAD)
    }

    fn seconds(times: Times, handle: isize) -> Option<f64> {
        let [mut start, mut end, mut system, mut user] = [0; 4];
        // SAFETY: each pointer is to a number of 64 bits, and the handle is that of the caller itself.
        let is_known =
            unsafe { times(handle, &raw mut start, &raw mut end, &raw mut system, &raw mut user) }
                != 0;
        is_known.then(|| 1e-7 * (system + user) as f64)
    }
}
