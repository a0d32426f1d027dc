//! An engine that may be missing: without one, and from its first error on, the CPU refines every cell.
//!
//! A device that has failed once is not asked again, so that a run ends after one failure however many cells it has left.

use super::{CellDifference, Engine, EngineError, Reference};
use crate::rod::Rod;
use crate::shooting::batch::Method;

/// An engine for as long as it works.
pub struct Fallback<'a> {
    /// What solves cells, if anything does.
    pub engine: Option<&'a mut dyn Engine>,
    /// Why the CPU goes on alone, if an engine failed.
    pub failure: Option<EngineError>,
}

impl Fallback<'_> {
    /// Does without the engine from now on: so many of some `cells` of it were wrong.
    pub fn distrust(&mut self, differing: u64, cells: u64) {
        self.engine = None;
        self.failure = Some(EngineError::Distrusted { differing, cells });
    }

    /// [`Engine::solve`]; `None` without an engine.
    pub fn solve(
        &mut self,
        method: Method,
        rods: &[Rod],
        pushes: &[f64],
        references: &[Reference],
    ) -> Option<Vec<CellDifference>> {
        let engine = self.engine.as_mut()?;
        let asked = references.iter().map(|reference| reference.cells.len());
        let asked: usize = asked.sum();
        let failure = match engine.solve(method, rods, pushes, references) {
            Ok(cells) if cells.len() == asked => return Some(cells),
            Ok(cells) => EngineError::Device(format!("{} answers for {asked} cells", cells.len())),
            Err(failure) => failure,
        };
        self.engine = None;
        self.failure = Some(failure);
        None
    }
}
