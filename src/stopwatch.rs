//! Stopwatch: wall time of the parts of a run.

use std::time::Duration;
#[cfg(not(target_family = "wasm"))]
use std::time::Instant;

/// Stopwatch that runs from its start. In WebAssembly there is no clock: it stays at zero, and the page measures the times that it shows.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    #[cfg(not(target_family = "wasm"))]
    begun: Instant,
}

impl Stopwatch {
    /// Starts a stopwatch.
    pub fn start() -> Self {
        Self {
            #[cfg(not(target_family = "wasm"))]
            begun: Instant::now(),
        }
    }

    /// Returns the wall time since the start.
    pub fn elapsed(self) -> Duration {
        #[cfg(not(target_family = "wasm"))]
        return self.begun.elapsed();
        #[cfg(target_family = "wasm")]
        Duration::ZERO
    }
}
