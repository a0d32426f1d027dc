//! Engines: what solves whole cells in place of the refinement, thousands at once.
//!
//! A row of a map comes with [`BasePoint`]s, exact states along it. An engine integrates what is different in a cell, takes
//! Newton's step from there, and answers with the difference of everything that people want to know, and with a bound on the
//! miss. Cells that it does not vouch for, it hands over by an [`Outcome`]: they are refined in `f64`. So are rows without
//! references, and a sample of all others.

#[cfg(feature = "gpu")]
pub mod gpu;
mod question;
mod worker;

pub use question::{MOST_TRAJECTORY_STEPS, Question, Trajectory};
pub use worker::Worker;

use crate::numerics::Unit;
use crate::plan::STATE_CHANNELS;
use crate::rod::{Effects, Rod, arclength};
use crate::shooting::{FirstVariation, Resolution};
use std::ops::Range;
use std::sync::Arc;

/// Coefficients of a Taylor polynomial along a row.
pub const POWERS: usize = 12;

/// What is known along a row: push angle, `tau`, the direction of the point of the resting whisker that is as far from the base as the
/// contact, and the derivatives of `(ln D, phi)` by `tau` and by load.
pub type RowTerms = [f64; 7];

/// A state of a row of cells, exact, and its neighbourhood on the row.
#[derive(Clone, Debug)]
pub struct BasePoint {
    /// Which of the rods of the question.
    pub rod: u32,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Signed push angle since first touch, in radians.
    pub push: f64,
    /// The state, seen from the contact.
    pub state: FirstVariation,
    /// The signed load over the row parameter, which is `load tau^2` over that at the end of the row.
    pub per_way: f64,
    /// Taylor polynomials of the row in the row parameter, less its value here.
    pub row: [RowTerms; POWERS],
    /// The cells next to it: those at these of the question's push angles.
    pub cells: Range<u32>,
}

/// By how much the state of a cell differs from that of its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellDifference {
    /// In the order of [`STATE_CHANNELS`], in whisker lengths, radians, `E I_base/L_w^2`, `E I_base/L_w`; forces are signed and whole.
    pub numbers: [f32; STATE_CHANNELS.len()],
    /// Bound on the distance of the pole from the wanted place, in whisker lengths.
    pub residual: f32,
    /// Whether the engine vouches for it.
    pub outcome: Outcome,
}

impl CellDifference {
    /// `(tau, load)` of a cell of `reference`, whose rod is `rod`.
    #[must_use]
    pub fn point(&self, rod: &Rod, reference: &BasePoint) -> (f64, f64) {
        let [arc, _, force, ..] = self.numbers.map(f64::from);
        let tau = rod.tau(arclength(rod, reference.tau) + arc);
        let load = (reference.state.full.force + force) / rod.radius(tau).powi(2);
        (tau, load)
    }
}

/// Whether shaders integrate these effects; if not, why the CPU does.
///
/// # Errors
/// The reason.
pub const fn on_gpu(effects: Effects) -> Result<(), &'static str> {
    if effects.profile {
        Err("measured radii are integrated on the CPU")
    } else if effects.gradient {
        Err("a modulus gradient is integrated on the CPU")
    } else {
        Ok(())
    }
}

/// What became of a cell. A failed one is data, not an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A number was not finite, or nothing was written.
    NotFinite,
    /// A stable state.
    Solved,
    /// Handed over: next to the fold or to the tip.
    NearEdge,
    /// Handed over: too different from its reference.
    Far,
    /// Handed over: the bound on its miss is too large.
    Missed,
}

impl Outcome {
    /// Whether the engine answers for it.
    #[must_use]
    pub const fn is_vouched_for(self) -> bool {
        matches!(self, Self::Solved)
    }
}

/// What solves a map, for people and for the record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EngineDescription {
    /// `cpu f64`, `gpu f32`, `gpu f64`.
    pub engine: String,
    /// Processor or adapter, with driver.
    pub adapter: String,
}

impl EngineDescription {
    /// Of `engine`, or of the CPU alone.
    #[must_use]
    pub fn of(engine: Option<&dyn Engine>) -> Self {
        let cpu = || Self {
            engine: "cpu f64".to_owned(),
            adapter: Unit::detect().to_string(),
        };
        engine.map_or_else(cpu, Engine::describe)
    }
}

/// Something that solves cells, on any thread.
pub trait Engine: Send {
    /// Which engine this is.
    fn describe(&self) -> EngineDescription;

    /// The largest bound on the miss of a cell that it vouches for, in whisker lengths.
    fn goal(&self) -> f64;

    /// The resolution of the references' trajectories where the CPU has this one.
    fn resolution(&self, resolution: Resolution) -> Resolution;

    /// Takes on a `question`, and works on it as far as it can without being waited for.
    ///
    /// # Errors
    /// When the device fails; from then on every call fails.
    fn ask(&mut self, question: Arc<Question>) -> Result<(), EngineError>;

    /// The answers to the oldest question that has none yet, one for each cell; none if there is no such question.
    ///
    /// # Errors
    /// When the device fails; a cell that is handed over is no error.
    fn answer(&mut self) -> Result<Vec<CellDifference>, EngineError>;

    /// The answers to a question, asked alone.
    ///
    /// # Errors
    /// When the device fails.
    fn solve(&mut self, question: Arc<Question>) -> Result<Vec<CellDifference>, EngineError> {
        self.ask(question)?;
        self.answer()
    }
}

/// A device that failed.
#[derive(Clone, Debug, thiserror::Error)]
pub enum EngineError {
    /// There is no adapter.
    #[error("no GPU adapter found: {0}")]
    NoAdapter(String),
    /// The adapter lacks what was asked for.
    #[error("adapter {adapter} cannot {what}")]
    Unsupported {
        /// Its name.
        adapter: String,
        /// What it lacks.
        what: String,
    },
    /// A call failed.
    #[error("GPU: {0}")]
    Device(String),
    /// Its answers are not what they should be.
    #[error(
        "GPU: {differing} of {cells} cells that were computed once more differed by more than they may"
    )]
    Distrusted {
        /// Cells that differed.
        differing: u64,
        /// Cells computed once more together with them.
        cells: u64,
    },
}
