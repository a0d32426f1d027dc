//! An engine that cannot fail: from its first error on, the CPU engine shoots in its stead.
//!
//! A device that has failed once is not asked again, so that a run ends after one failure however many shots it has left.

use super::{Cpu, Engine, EngineError, Hit, Shot};
use crate::model::{Effects, Rod};

/// An engine, with the CPU engine behind it.
pub struct Fallback<'a> {
    engine: &'a mut dyn Engine,
    failure: Option<EngineError>,
}

impl<'a> Fallback<'a> {
    /// Lets `engine` shoot for as long as it can.
    pub fn new(engine: &'a mut dyn Engine) -> Self {
        Self {
            engine,
            failure: None,
        }
    }

    /// Why the CPU shoots, if it does.
    #[must_use]
    pub const fn failure(&self) -> Option<&EngineError> {
        self.failure.as_ref()
    }

    /// [`Engine::shots_at_once`].
    #[must_use]
    pub fn shots_at_once(&self) -> usize {
        self.engine.shots_at_once()
    }

    /// [`Engine::shoot`]. Shots are solved by one engine or the other, all of a call by the same.
    pub fn shoot(&mut self, effects: Effects, rods: &[Rod], shots: &[Shot]) -> Vec<Hit> {
        if self.failure.is_none() {
            match self.engine.shoot(effects, rods, shots) {
                Ok(hits) => return hits,
                Err(failure) => self.failure = Some(failure),
            }
        }
        Cpu.solve(effects, rods, shots)
    }
}
