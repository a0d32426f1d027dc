//! Engines: what shoots before the refinement, thousands of shooting problems at once.
//!
//! A [`Shot`] asks for the contact and the load under which the pole is at a wanted place; an engine takes
//! Newton steps, each one trajectory with its sensitivities. What comes back is a start for the refinement in
//! `f64`, which alone decides what is a solution: an engine can be fast, but it cannot make a map wrong.
//! On the CPU nothing would be spared: the refinement takes the same steps, from the guesses.

mod fallback;
#[cfg(feature = "gpu")]
pub mod gpu;

pub use fallback::Fallback;

use crate::numerics::Unit;
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

impl Hit {
    /// The guess of `shot`, before any step.
    #[must_use]
    pub const fn untouched(shot: &Shot) -> Self {
        Self {
            tau: shot.tau,
            load: shot.load,
            residual: f64::INFINITY,
            steps: 0,
            outcome: Outcome::Stalled,
        }
    }
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

/// What solves a map, for people and for the record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Description {
    /// `cpu f64`, `gpu f32`, `gpu f64`.
    pub engine: String,
    /// Processor or adapter, with driver.
    pub adapter: String,
}

impl Description {
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

/// Something that solves shots before the refinement.
pub trait Engine {
    /// Which engine this is.
    fn describe(&self) -> Description;

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
