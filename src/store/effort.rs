//! What packing costs.

use std::ops::AddAssign;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// CPU time that threads have spent on something.
#[derive(Debug, Default)]
pub(super) struct Effort(AtomicU64);

impl Effort {
    /// Does `work`, all of it on this thread, and adds its time.
    pub(super) fn of<R>(&self, work: impl FnOnce() -> R) -> R {
        let start = thread_time();
        let result = work();
        let nanos = thread_time().saturating_sub(start).as_nanos() as u64;
        self.0.fetch_add(nanos, Ordering::Relaxed);
        result
    }

    /// All of it.
    pub(super) fn time(&self) -> Duration {
        Duration::from_nanos(self.0.load(Ordering::Relaxed))
    }
}

/// What files of some panels would take.
#[derive(Clone, Copy, Debug, Default)]
pub struct Packed {
    /// Bytes on disk, but for headers.
    pub bytes: u64,
    /// CPU time of the packing.
    pub time: Duration,
}

impl AddAssign for Packed {
    fn add_assign(&mut self, other: Self) {
        self.bytes += other.bytes;
        self.time += other.time;
    }
}

/// CPU time of this thread.
#[cfg(unix)]
pub(crate) fn thread_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Without such a clock, any time.
#[cfg(not(unix))]
pub(crate) fn thread_time() -> Duration {
    static START: std::sync::LazyLock<std::time::Instant> =
        std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed()
}
