//! An engine that cannot fail: from its first error on, the refinement starts from the guesses.
//!
//! A device that has failed once is not asked again, so that a run ends after one failure however many shots it has left.

use super::{Engine, EngineError, Hit, Shot};
use crate::rod::{Effects, Rod};

/// An engine that may be missing.
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

    /// Why the CPU does it alone, if it does.
    #[must_use]
    pub const fn failure(&self) -> Option<&EngineError> {
        self.failure.as_ref()
    }

    /// [`Engine::shots_at_once`].
    #[must_use]
    pub fn shots_at_once(&self) -> usize {
        self.engine.shots_at_once()
    }

    /// [`Engine::shoot`]; `None` where that spares the refinement nothing, or fails.
    pub fn shoot(&mut self, effects: Effects, rods: &[Rod], shots: &[Shot]) -> Option<Vec<Hit>> {
        if self.failure.is_some() || !self.engine.spares_work() {
            return None;
        }
        match self.engine.shoot(effects, rods, shots) {
            Ok(hits) => Some(hits),
            Err(failure) => {
                self.failure = Some(failure);
                None
            }
        }
    }
}
