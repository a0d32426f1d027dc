//! The CPU engine: guesses from the lattice, refined by Newton's method in `f64` on the threads of the current pool.

use super::cells::CellsMut;
use super::{BatchRow, Cell, Cells, Engine, EngineDescription, EngineError, Outcome, RowBatch};
use crate::numerics::Unit;
use crate::refine::{CellTarget, RefineOutcome, Refined, TOLERANCE, refine};
use crate::sheet::Guess;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The CPU engine. It works where it is called: [`Engine::submit`] keeps a batch, [`Engine::collect`] solves it.
#[derive(Debug, Default)]
pub struct Cpu {
    submitted: VecDeque<Arc<RowBatch>>,
    /// Wall time spent on guesses.
    pub guesses: Duration,
    /// Wall time spent on Newton's method.
    pub refinement: Duration,
}

impl Cpu {
    /// Solves the cells of `batch`.
    pub fn solve(&mut self, batch: &RowBatch) -> Cells {
        let begun = Instant::now();
        let rows = batch.rows.par_iter();
        let guessed: Vec<Vec<Option<CellTarget>>> =
            rows.map(|row| cell_targets(batch, row)).collect();
        self.guesses += begun.elapsed();
        let begun = Instant::now();
        let flat: Vec<CellTarget> = guessed.iter().flatten().flatten().copied().collect();
        let starts: Vec<_> = flat
            .iter()
            .map(|target| (target.tau, target.load))
            .collect();
        let refined = refine(batch.method, &batch.sheets(), &flat, &starts);
        let mut cells = Cells::new(batch, Outcome::OffSheet);
        let ranges = batch
            .rows
            .iter()
            .map(|row| row.first..row.first + row.len());
        let ranges: Vec<Range<usize>> = ranges.collect();
        let mut after = 0;
        let rows = batch.rows.iter().zip(guessed).zip(cells.rows_mut(&ranges));
        let rows = rows.map(|((row, guessed), into)| {
            let from = after;
            after += guessed.iter().flatten().count();
            (row, guessed, &refined[from..after], into)
        });
        let rows: Vec<_> = rows.collect();
        rows.into_par_iter()
            .for_each(|(row, guessed, refined, into)| write(batch, row, &guessed, refined, into));
        self.refinement += begun.elapsed();
        cells
    }
}

/// The target of each cell of `row`; none where the sheet has no guess.
fn cell_targets(batch: &RowBatch, row: &BatchRow) -> Vec<Option<CellTarget>> {
    let side = &batch.sides[row.side];
    let at_touch = side.sheet.rows[row.row].pole(0.0);
    let magnitudes = row.each().map(|cell| side.columns.magnitudes[cell]);
    let guesses = side.sheet.guesses(row.row, magnitudes);
    let target = |(guess, cell): (Option<Guess>, usize)| {
        guess.map(|Guess { tau, load }| CellTarget {
            // Sides of a group are few.
            rod: row.side as u32,
            tau,
            load,
            pole: side.columns.columns[cell].turn.rotate(at_touch),
        })
    };
    guesses.into_iter().zip(row.each()).map(target).collect()
}

/// Writes the `refined` of the cells that have a guess, and all others as off the sheet.
fn write(
    batch: &RowBatch,
    row: &BatchRow,
    guessed: &[Option<CellTarget>],
    refined: &[Refined],
    mut into: CellsMut,
) {
    let side = &batch.sides[row.side];
    let mut refined = refined.iter();
    for ((index, cell), target) in row.each().enumerate().zip(guessed) {
        let found = target.and_then(|_| refined.next());
        let cell = found.map_or(Cell::new(Outcome::OffSheet, 0), |found| {
            let outcome = match found.outcome {
                RefineOutcome::Solved => {
                    let push = side.columns.columns[cell].push;
                    let has_values = batch.has_values;
                    return side.solved(row.row, push, &found.state, found.steps, has_values);
                }
                RefineOutcome::BeyondTip => Outcome::BeyondTip,
                RefineOutcome::BeyondFold => Outcome::BeyondFold,
                RefineOutcome::NotConverged => Outcome::NotConverged,
            };
            Cell {
                residual: found.state.residual as f32,
                ..Cell::new(outcome, found.steps)
            }
        });
        into.set(index, &cell);
    }
}

impl Engine for Cpu {
    fn describe(&self) -> EngineDescription {
        EngineDescription {
            engine: "cpu f64".to_owned(),
            adapter: Unit::detect().to_string(),
        }
    }

    fn residual_bound(&self) -> f64 {
        TOLERANCE
    }

    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError> {
        self.submitted.push_back(batch);
        Ok(())
    }

    fn collect(&mut self) -> Result<Cells, EngineError> {
        let batch = self.submitted.pop_front();
        Ok(batch.map_or_else(Cells::default, |batch| self.solve(&batch)))
    }
}
