//! Computations of a scene by one call: maps, curves, branches and shapes in memory, and maps that are computed when they are read.

mod map;
mod planned;
mod regime_map;
mod traces;

pub use map::{for_each_panel, lazy_map, map};
pub use planned::PlannedMap;
pub use regime_map::{Map, MapCell};
pub use traces::{branch, curve, shape};

use crate::accuracy::{Accuracy, cheapest};
use crate::engine::{EngineError, Precision};
use crate::plan::{Channels, PlanError};
use crate::scene::Scene;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::Side;

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
    /// Maximum push-angle error, in degrees. `None` selects the finest steps.
    pub tolerance_deg: Option<f64>,
    /// Engine that solves the cells of maps.
    pub engine: MapEngine,
    /// Channels of maps to compute; `None` for all.
    pub channels: Option<Channels>,
    /// Function that is called with the numbers of finished and of all cells of a map, on the thread that computes it. `None` for no calls.
    pub on_progress: Option<Arc<dyn Fn(usize, usize) + Send + Sync>>,
    /// Flag that cancels: if true, a map or a curve soon ends with [`Error::Cancelled`], within the whiskers that it computes. `None` if nothing
    /// cancels.
    pub cancel: Option<Arc<AtomicBool>>,
}

impl Options {
    /// Returns true if the computation is cancelled.
    fn is_cancelled(&self) -> bool {
        let cancel = self.cancel.as_ref();
        cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }
}

/// Engine that solves the cells of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum MapEngine {
    /// The CPU engine: a trajectory for each cell, in `f64` on all cores.
    #[default]
    Cpu,
    /// The spectral engine: certified polynomials along rows, in `f64` on all cores. Rows without a certificate fall back to the CPU
    /// engine, and so do all rows with measured radii.
    Spectral,
    /// The spectral engine, or the CPU engine where its trajectories take less time than expansions. The choice depends on the scene alone.
    Auto,
    /// The GPU engine: the preferred GPU in this precision; an error without the feature `gpu`. For a map without numbers of states, whose regimes
    /// follow from the ends of rows, this is [`MapEngine::Auto`].
    Gpu(Precision),
}

/// Error of a computation in memory. An unresolved cell is no error.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The map takes more memory than is allowed.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The GPU cannot be opened.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The computation was cancelled by [`Options::cancel`].
    #[error("cancelled")]
    Cancelled,
    /// No resolution meets the tolerance.
    #[error("tolerance_deg {tolerance_deg:e}: must be at least {least:e} for this scene")]
    Tolerance {
        /// Requested maximum push-angle error, in degrees.
        tolerance_deg: f64,
        /// Estimated push-angle error of the finest steps, in degrees.
        least: f64,
    },
}

/// Returns the cheapest steps that keep push angles on `sides` of the scene within `tolerance_deg`, with their estimated error; `None`
/// without a tolerance.
///
/// # Errors
/// If no steps keep the tolerance.
pub fn accuracy(
    scene: &Scene,
    tolerance_deg: Option<f64>,
    sides: &[Side],
) -> Result<Option<Accuracy>, Error> {
    let accuracy = tolerance_deg.map(|tolerance_deg| {
        cheapest(scene, sides, tolerance_deg)
            .map_err(|finest| Error::Tolerance { tolerance_deg, least: finest.error_deg })
    });
    accuracy.transpose()
}
