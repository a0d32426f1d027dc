//! Engines solve the cells of row batches under one contract: by trajectories or expansions on the CPU, or on the GPU.
//!
//! An [`Engine`] takes a [`RowBatch`] and returns [`Cells`]: for each cell channel values in map units, a bound on the residual, and an
//! [`Outcome`]. Cells that an engine cannot certify fall back to the CPU engine, which also audits a sample of all others.

mod batch;
mod cells;
mod columns;
mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
mod side;
mod spectral;
mod worker;

pub use batch::{
    BasePoint, BasePointAccuracy, BaseTrajectory, BatchRow, JACOBIAN_POWERS, JacobianTerms,
    MOST_TRAJECTORY_STEPS, POWERS, RESTING_POWERS, RowBatch, RowTerms,
};
pub use cells::{Cell, CellRun, Cells, Outcome};
pub use columns::{Column, SideColumns};
pub use cpu::Cpu;
pub use side::{FORCE, Values, WhiskerSide};
pub use spectral::{Spectral, SpectralSheet};
pub use worker::Worker;

use crate::rod::Effects;
use crate::shooting::Resolution;
use std::fmt;
use std::sync::Arc;

/// Floating-point type of the GPU engine's shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum Precision {
    /// Every adapter.
    F32,
    /// Vulkan adapters with shaderFloat64.
    F64,
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        })
    }
}

/// Name and hardware of an engine, as printed and stored.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EngineDescription {
    /// `cpu f64`, `spectral f64`, `gpu f32` or `gpu f64`.
    pub engine: String,
    /// SIMD unit of the processor, or adapter with driver.
    pub adapter: String,
}

impl EngineDescription {
    /// Describes `engine`, or the CPU engine without one.
    #[must_use]
    pub fn of(engine: Option<&dyn Engine>) -> Self {
        engine.map_or_else(|| Cpu::default().describe(), Engine::describe)
    }
}

/// What row batches carry for an engine.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EngineInput {
    /// Base points of this accuracy. The engine works on a thread of its own.
    BasePoints(BasePointAccuracy),
    /// The spectral sheets of whisker sides. The engine works on the threads of the current pool.
    SpectralSheets,
}

/// Largest motion of base and pole from a base point to a cell for an engine without rounding, in whisker lengths.
const MOST_MOTION: f64 = 0.4;

/// Solves the cells of row batches, on any thread.
pub trait Engine: Send {
    /// Name and hardware.
    fn describe(&self) -> EngineDescription;

    /// Maximum residual bound of a solved cell, in whisker lengths.
    fn residual_bound(&self) -> f64;

    /// What batches carry for this engine where the CPU integrates with `resolution`.
    fn input(&self, resolution: Resolution) -> EngineInput {
        EngineInput::BasePoints(BasePointAccuracy {
            resolution,
            residual: self.residual_bound(),
            least: 2,
            motion: MOST_MOTION,
        })
    }

    /// Takes a batch, and starts on it without waiting for a device.
    ///
    /// # Errors
    /// When the device fails; every later call then fails.
    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError>;

    /// Returns the cells of the oldest batch submitted and not collected; no cells without such a batch.
    ///
    /// # Errors
    /// When the device fails; a cell that is not certified is no error.
    fn collect(&mut self) -> Result<Cells, EngineError>;
}

/// Returns `Ok` if the shaders integrate these effects.
///
/// # Errors
/// The effect that only the CPU integrates.
pub const fn on_gpu(effects: Effects) -> Result<(), &'static str> {
    if effects.profile {
        Err("measured radii are integrated on the CPU")
    } else if effects.gradient {
        Err("a modulus gradient is integrated on the CPU")
    } else {
        Ok(())
    }
}

/// Failure of a device.
#[non_exhaustive]
#[derive(Clone, Debug, thiserror::Error)]
pub enum EngineError {
    /// No adapter was found.
    #[error("no GPU adapter found: {0}")]
    NoAdapter(String),
    /// The adapter lacks a required feature.
    #[error("adapter {adapter} cannot {what}")]
    Unsupported {
        /// Name of the adapter.
        adapter: String,
        /// The missing feature.
        what: String,
    },
    /// A call failed.
    #[error("GPU: {0}")]
    Device(String),
    /// Audited cells differ from the CPU's.
    #[error("{differing} of {cells} audited cells of the engine differ by more than the tolerance")]
    FailedAudit {
        /// Cells that differ.
        differing: u64,
        /// Cells audited.
        cells: u64,
    },
}
