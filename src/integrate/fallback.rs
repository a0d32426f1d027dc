//! An engine that may be missing: without one, and from its first error on, the refinement starts from the guesses.
//!
//! A device that has failed once is not asked again, so that a run ends after one failure however many shots it has left.

use super::{Engine, EngineError, Hit, Shot};
use crate::rod::{Effects, Rod};

/// An engine for as long as it works.
pub struct Fallback<'a> {
    /// What shoots, if anything does.
    pub engine: Option<&'a mut dyn Engine>,
    /// Why the CPU goes on alone, if an engine failed.
    pub failure: Option<EngineError>,
}

impl Fallback<'_> {
    /// [`Engine::shoot`]; `None` without an engine.
    pub fn shoot(&mut self, effects: Effects, rods: &[Rod], shots: &[Shot]) -> Option<Vec<Hit>> {
        match self.engine.as_mut()?.shoot(effects, rods, shots) {
            Ok(hits) => Some(hits),
            Err(failure) => {
                self.engine = None;
                self.failure = Some(failure);
                None
            }
        }
    }
}
