//! The engines: two ways to solve thousands of shooting problems at once, behind one trait.
//!
//! A [`Shot`] asks for the contact and the load under which the pole is at a wanted place; the engine takes
//! Newton steps, each one trajectory with its sensitivities. What comes back is a start for the refinement in
//! `f64`, which alone decides what is a solution: an engine can be fast, but it cannot make a map wrong.

mod cpu;
mod fallback;
pub mod gpu;

pub use cpu::{Cpu, Solver};
pub use fallback::Fallback;

use crate::rod::{Effects, Rod};
use glam::DVec2;

/// A shooting problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// Which of the rods of the call.
    pub rod: u32,
    /// Guess for `tau` of the contact.
    pub tau: f64,
    /// Guess for the signed load `f/rho^2`.
    pub load: f64,
    /// Wanted centre of the pole in the frame of the base, in whisker lengths.
    pub pole: DVec2,
}

/// What an engine made of a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Distance of the pole from the wanted place at the last trajectory, in whisker lengths.
    pub residual: f64,
    /// Newton steps taken.
    pub steps: u32,
    /// How it ended.
    pub outcome: Outcome,
}

/// How a shot ended. A failed shot is data, not an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The residual is below the engine's tolerance.
    Converged,
    /// The steps were used up.
    Stalled,
    /// A number was not finite.
    NotFinite,
}

/// Newton steps that an engine may take per shot.
pub const MOST_STEPS: u32 = 4;

/// Which engine, for people and for the record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Description {
    /// `cpu f64`, `gpu f32`, `gpu f64`.
    pub engine: String,
    /// Processor or adapter, with driver.
    pub adapter: String,
}

/// Something that solves shots.
pub trait Engine {
    /// Which engine this is.
    fn describe(&self) -> Description;

    /// How many shots it needs at once to be as fast as it gets; more only take more memory.
    fn shots_at_once(&self) -> usize {
        usize::MAX
    }

    /// Whether what it finds spares the refinement, which could start from the guesses as well, more than it costs.
    fn spares_work(&self) -> bool {
        true
    }

    /// Solves `shots`, each on one of `rods`; answers in the same order. `effects` are those of the scene, a
    /// superset of every rod's own.
    ///
    /// # Errors
    /// When the device fails; a shot that does not converge is no error.
    fn shoot(
        &mut self,
        effects: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError>;
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
}
