//! Timings: wall times of repeated runs.

use crate::quantile::median;
use serde::Serialize;
use std::time::Instant;

/// Largest [`Timing::spread`] of a timing that is not noisy.
pub const NOISY: f64 = 0.2;

/// Timing: wall times of several runs, in seconds.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Timing {
    /// Median time of the runs, in seconds.
    pub median: f64,
    /// Time of the fastest run, in seconds.
    pub fastest: f64,
    /// Time of the slowest run, in seconds.
    pub slowest: f64,
    /// Spread of the timing, dimensionless: difference of the slowest and the fastest run, over the median.
    pub spread: f64,
    /// True if the spread of the timing is above [`NOISY`].
    pub is_noisy: bool,
}

impl Timing {
    /// Returns the timing of runs that took these `seconds`.
    pub fn of(seconds: impl Iterator<Item = f64> + Clone) -> Self {
        let [fastest, slowest] =
            [f64::min, f64::max].map(|pick| seconds.clone().fold(f64::NAN, pick));
        let median = median(seconds);
        let spread = (slowest - fastest) / median;
        Self { median, fastest, slowest, spread, is_noisy: spread > NOISY }
    }
}

/// Times `work` in `runs` runs after one that does not count, and returns the result of the last one.
pub fn timed<T, E>(runs: usize, mut work: impl FnMut() -> Result<T, E>) -> Result<(Timing, T), E> {
    let mut result = work()?;
    let mut seconds = Vec::with_capacity(runs);
    for _ in 0..runs {
        let start = Instant::now();
        result = work()?;
        seconds.push(start.elapsed().as_secs_f64());
    }
    Ok((Timing::of(seconds.into_iter()), result))
}
