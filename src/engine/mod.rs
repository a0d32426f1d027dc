//! Engines solve the cells of row batches under one contract: by trajectories on the CPU, or from expansions of rows on the CPU or the GPU.
//!
//! An [`Engine`] takes a [`RowBatch`] and returns [`Cells`]: for each cell channel values in map units, a bound on the residual, and an
//! [`Outcome`](crate::classify::Outcome). Cells that an engine cannot certify fall back to the CPU engine, which also audits a sample of all others.
//!
//! A `push` is the magnitude of a push angle, in radians. A `signed_push` is positive on CB and negative on CF.

mod batch;
mod cells;
mod columns;
mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
mod nodes;
mod row;
mod side;
mod spectral;
mod thread;
mod worker;

pub use batch::{BatchRow, RowBatch, needs_values};
pub(crate) use cells::RowCells;
pub use cells::{Cell, Cells};
pub use columns::SideColumns;
pub use cpu::Cpu;
pub use nodes::Nodes;
pub use row::{KnownRow, RowExpansion};
pub use side::{Values, WhiskerSide};
pub use spectral::Spectral;
pub use worker::Worker;

use crate::names::names;
use std::fmt;
use std::sync::Arc;
use whiskmap_mechanics::numerics::Unit;
use whiskmap_mechanics::rod::Effects;
use whiskmap_mechanics::shooting::PlainState;

/// Floating-point type of the GPU engine's shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Precision {
    /// Single precision, which every adapter supports.
    F32,
    /// Double precision, on Vulkan adapters with shaderFloat64.
    F64,
}

names!(Precision { F32 = "f32", F64 = "f64" });

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Description of an engine: name and hardware, as printed and stored.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EngineDescription {
    /// Name of the engine: `cpu f64`, `spectral f64`, `gpu f32` or `gpu f64`.
    pub engine: String,
    /// Hardware of the engine: SIMD unit of the processor, or adapter with driver.
    pub adapter: String,
}

impl EngineDescription {
    /// Describes an engine of this name on the CPU.
    fn on_cpu(engine: &str) -> Self {
        Self { engine: engine.to_owned(), adapter: Unit::detect().to_string() }
    }

    /// Describes `engine`, or the CPU engine without one.
    #[must_use]
    pub fn of(engine: Option<&dyn Engine>) -> Self {
        engine.map_or_else(|| Cpu::default().describe(), Engine::describe)
    }
}

/// Engine: solves the cells of row batches, on any thread.
pub trait Engine: Send {
    /// Returns name and hardware of the engine.
    fn describe(&self) -> EngineDescription;

    /// Returns the maximum residual bound of a solved cell, in whisker lengths.
    fn residual_bound(&self) -> f64;

    /// Returns the maximum residual of the rows that this engine evaluates, in whisker lengths; by default all of the bound.
    fn row_residual(&self) -> f64 {
        self.residual_bound()
    }

    /// Returns true if the engine waits for a device, so that it works on a thread of its own.
    fn has_device(&self) -> bool {
        false
    }

    /// Returns true if the engine integrates the trajectories of nets of whiskers with these effects ([`Engine::shoot_nodes`]); by default it
    /// does not.
    fn integrates_nodes(&self, effects: Effects) -> bool {
        let _ = effects;
        false
    }

    /// Returns the states of the trajectories of `nodes`, `[trajectory]`, rod by rod.
    ///
    /// # Errors
    /// When the device fails; every later call then fails. By default always.
    fn shoot_nodes(&mut self, nodes: &Nodes) -> Result<Vec<PlainState>, EngineError> {
        Err(EngineError::Unsupported {
            adapter: self.describe().adapter,
            what: format!("integrate {} trajectories of nets", nodes.count()),
        })
    }

    /// Submits a batch to the engine, which starts without waiting for a device.
    ///
    /// # Errors
    /// When the device fails; every later call then fails.
    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError>;

    /// Returns the cells of the oldest batch that was submitted and not collected; no cells without such a batch.
    ///
    /// # Errors
    /// When the device fails; a cell that is not certified is no error.
    fn collect(&mut self) -> Result<Cells, EngineError>;
}

/// Returns `Ok` if the GPU evaluates rows of whiskers with these effects.
///
/// # Errors
/// The effect with which only the CPU computes cells.
pub const fn on_gpu(effects: Effects) -> Result<(), &'static str> {
    match effects.profile {
        true => Err("whiskers with measured radii have no net, and are integrated on the CPU"),
        false => Ok(()),
    }
}

/// Failure of an engine's device.
#[non_exhaustive]
#[derive(Clone, Debug, thiserror::Error)]
pub enum EngineError {
    /// No GPU adapter was found.
    #[error("no GPU adapter found: {0}")]
    NoAdapter(String),
    /// The GPU adapter lacks a required feature.
    #[error("adapter {adapter} cannot {what}")]
    Unsupported {
        /// Name of the GPU adapter.
        adapter: String,
        /// Feature that the GPU adapter lacks.
        what: String,
    },
    /// A call of the device failed.
    #[error("GPU: {0}")]
    Device(String),
    /// Audited cells of the engine differ from the cells of the CPU.
    #[error("{differing} of {cells} audited cells of the engine differ by more than the tolerance")]
    FailedAudit {
        /// Number of audited cells that differ.
        differing: u64,
        /// Number of cells audited.
        cells: u64,
    },
}
