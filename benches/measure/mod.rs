//! Median times of functions, as a table.
#![allow(dead_code, reason = "each benchmark uses its own share")]

use std::fmt::Display;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Number of samples; their median is printed.
const SAMPLES: usize = 21;

/// Least time of a sample: a short function runs several times.
const LEAST_TIME: Duration = Duration::from_millis(50);

/// Benchmarks with a common name.
pub struct Group {
    name: &'static str,
    /// Part of the names of the benchmarks that run: the first argument of the program.
    filter: String,
}

impl Group {
    /// Returns a group with the filter of the command line.
    pub fn new(name: &'static str) -> Self {
        let mut arguments = std::env::args().skip(1);
        let filter = arguments.find(|text| !text.starts_with('-'));
        Self { name, filter: filter.unwrap_or_default() }
    }

    /// Prints the median time of `function` in microseconds.
    pub fn time<R>(&self, name: impl Display, function: impl FnMut() -> R) {
        if let Some((name, micros)) = self.measured(&name, function) {
            println!("{micros:>14.2} us  {name}");
        }
    }

    /// Prints the median time of `function` in microseconds, and the number of `elements` per second.
    pub fn rate<R>(&self, name: impl Display, elements: usize, function: impl FnMut() -> R) {
        if let Some((name, micros)) = self.measured(&name, function) {
            let millions = elements as f64 / micros;
            println!("{micros:>14.2} us  {millions:>10.3} million/s  {name}");
        }
    }

    /// Returns the full name and the median time in microseconds of `function`, or nothing if the filter refuses it.
    fn measured<R>(
        &self,
        name: &dyn Display,
        mut function: impl FnMut() -> R,
    ) -> Option<(String, f64)> {
        let name = format!("{}: {name}", self.name);
        if !name.contains(&self.filter) {
            return None;
        }
        let mut seconds = |runs: u32| {
            let start = Instant::now();
            for _ in 0..runs {
                black_box(function());
            }
            start.elapsed().as_secs_f64()
        };
        // The first run fills caches.
        let once = seconds(1).min(seconds(1)).max(1e-9);
        let runs = (LEAST_TIME.as_secs_f64() / once).ceil().max(1.0) as u32;
        let mut samples: Vec<f64> = (0..SAMPLES).map(|_| seconds(runs) / f64::from(runs)).collect();
        samples.sort_by(f64::total_cmp);
        Some((name, 1e6 * samples[SAMPLES / 2]))
    }
}
