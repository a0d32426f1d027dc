//! Functions of the library that compute in memory.

mod map;
mod traces;

pub use map::{Map, MapCell, for_each_panel, map};
#[cfg(feature = "fit")]
pub use traces::fit;
pub use traces::{branch, curve, shape};

use crate::accuracy::cheapest;
use crate::engine::{EngineError, Precision};
use crate::plan::PlanError;
use crate::rod::Side;
use crate::scene::Scene;
use crate::shooting::Resolution;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Accuracy, engine, progress and cancellation of a computation.
///
/// ```
/// use whiskmap::{MapEngine, Options};
///
/// let mut options = Options::default();
/// options.tolerance_deg = Some(1e-6);
/// options.engine = MapEngine::Spectral;
/// options.on_progress = Some(std::sync::Arc::new(|done, all| eprintln!("{done} of {all} cells")));
/// ```
#[derive(Clone, Default)]
#[non_exhaustive]
pub struct Options {
    /// Maximum push-angle error, in degrees. Without it, the finest steps are used.
    pub tolerance_deg: Option<f64>,
    /// Engine that solves the cells of maps.
    pub engine: MapEngine,
    /// Called with the number of finished cells and of all cells of a map, on the thread that computes it.
    pub on_progress: Option<Arc<dyn Fn(usize, usize) + Send + Sync>>,
    /// If true, a map ends with [`Error::Cancelled`] after the current row batch.
    pub cancel: Option<Arc<AtomicBool>>,
}

/// Engine that solves the cells of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum MapEngine {
    /// A trajectory for each cell, in `f64` on all cores.
    #[default]
    Cpu,
    /// Certified polynomials along rows, in `f64` on all cores. Rows without a certificate fall back to the CPU engine, and so do all rows
    /// with measured radii.
    Spectral,
    /// The preferred GPU in this precision; an error without the feature `gpu`.
    Gpu(Precision),
}

/// Failure of a computation. An unresolved cell is no error.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The map takes too much memory.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The GPU cannot be opened.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// [`Options::cancel`] was set.
    #[error("cancelled")]
    Cancelled,
    /// No resolution keeps the tolerance.
    #[error("tolerance_deg {tolerance_deg:e}: must be at least {least:e} for this scene")]
    Tolerance {
        /// The tolerance.
        tolerance_deg: f64,
        /// Estimated error of the finest steps.
        least: f64,
    },
}

/// The cheapest resolution that keeps the tolerance of `options`, or the finest without one.
fn resolution(scene: &Scene, options: &Options, sides: &[Side]) -> Result<Resolution, Error> {
    let Some(tolerance_deg) = options.tolerance_deg else {
        return Ok(Resolution::FINE);
    };
    let accuracy = cheapest(scene, sides, tolerance_deg).map_err(|finest| Error::Tolerance {
        tolerance_deg,
        least: finest.error_deg,
    })?;
    Ok(accuracy.resolution)
}
