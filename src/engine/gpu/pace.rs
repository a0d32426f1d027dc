//! Number of cells of a submission: decided from times, without a device.

use std::time::Duration;

/// Time of a submission: long against its overhead, short against the two seconds after which some systems reset a GPU.
const GOAL: Duration = Duration::from_millis(75);

/// Cells of the first submission, before any time is known: about 10 ms on two cores of a CPU.
const FIRST: usize = 4096;

/// Maximum number of cells of a submission: 48 MiB of results; larger submissions are no faster.
const MOST: usize = 1 << 20;

/// Number of cells per submission, adapted to the times of the previous ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pace {
    /// Number of cells of the next submission.
    pub cells: usize,
    most: usize,
    warm: bool,
}

impl Pace {
    /// Returns the pace for buffers of at most `most_bytes` with `cell_bytes` per cell, and for `most_groups` groups of `group` cells.
    pub fn new(most_bytes: u64, cell_bytes: usize, most_groups: u32, group: u32) -> Self {
        let by_bytes = usize::try_from(most_bytes).unwrap_or(usize::MAX) / cell_bytes;
        let by_groups = most_groups as usize * group as usize;
        let most = by_bytes.min(by_groups).min(MOST);
        Self { cells: FIRST.min(most), most, warm: false }
    }

    /// Adapts the pace to a submission of `cells` that took at most `time`. The first one of a pipeline is ignored, since it compiles the
    /// pipeline; the last one of a batch, which is not full, can only slow the pace down.
    pub fn learn(&mut self, cells: usize, is_last: bool, time: Duration) {
        if std::mem::replace(&mut self.warm, true) && (!is_last || time > GOAL) {
            let fitting = cells as f64 * GOAL.as_secs_f64() / time.as_secs_f64().max(1e-6);
            self.cells = (fitting as usize).clamp(1, 4 * self.cells).min(self.most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warm() -> Pace {
        let mut pace = Pace::new(128 << 20, 40, 65_535, 64);
        pace.learn(FIRST, false, Duration::from_secs(1));
        pace
    }

    #[test]
    fn the_first_submission_is_ignored() {
        assert_eq!(warm().cells, FIRST);
    }

    #[test]
    fn limits_hold_whatever_the_times_are() {
        for (bytes, groups, most) in
            [(1000, 65_535, 25), (128 << 20, 2, 128), (u64::MAX, u32::MAX, MOST)]
        {
            let mut pace = Pace::new(bytes, 40, groups, 64);
            for _ in 0..20 {
                pace.learn(pace.cells, false, Duration::ZERO);
            }
            assert_eq!(pace.cells, most);
            pace.learn(pace.cells, false, Duration::from_secs(3600));
            assert_eq!(pace.cells, (most / 48_000).max(1));
        }
    }

    #[test]
    fn full_submissions_settle_at_the_goal() {
        let mut pace = warm();
        for _ in 0..10 {
            pace.learn(pace.cells, false, Duration::from_micros(pace.cells as u64));
        }
        assert_eq!(pace.cells, 75_000);
    }

    #[test]
    fn a_part_can_only_slow_down() {
        let mut pace = warm();
        pace.learn(1, true, Duration::from_micros(1));
        assert_eq!(pace.cells, FIRST);
        pace.learn(1000, true, Duration::from_millis(150));
        assert_eq!(pace.cells, 500);
    }
}
