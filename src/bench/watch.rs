//! Seconds, often enough to trust them.

use serde::Serialize;
use std::time::Instant;

/// What several runs took.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Timing {
    /// The median of the runs.
    pub median: f64,
    /// The slowest less the fastest, over the median.
    pub spread: f64,
}

/// Times `work` in `runs` runs, after one that does not count, and returns what the last one found.
pub fn watch<T, E>(runs: usize, mut work: impl FnMut() -> Result<T, E>) -> Result<(Timing, T), E> {
    let mut found = work()?;
    let mut seconds = Vec::with_capacity(runs);
    for _ in 0..runs {
        let start = Instant::now();
        found = work()?;
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds.sort_by(f64::total_cmp);
    let median = seconds[seconds.len() / 2];
    let spread = (seconds[seconds.len() - 1] - seconds[0]) / median;
    Ok((Timing { median, spread }, found))
}
