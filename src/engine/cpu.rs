//! The CPU engine: guesses from the net, refined by Newton's method in `f64` on the threads of the current pool.

use super::{BatchRow, Cell, Cells, Engine, EngineDescription, EngineError, RowBatch};
use crate::classify::Outcome;
use crate::refine::{CellTarget, Refined, TOLERANCE, refine_into};
use crate::stopwatch::Stopwatch;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// The CPU engine. It works where it is called: [`Engine::submit`] keeps a batch, [`Engine::collect`] solves it.
#[derive(Debug, Default)]
pub struct Cpu {
    submitted: VecDeque<Arc<RowBatch>>,
    /// Targets of the last batch, whose memory the next one reuses.
    targets: Vec<CellTarget>,
    /// Refined cells of the last batch, whose memory the next one reuses.
    refined: Vec<Refined>,
    /// Wall time spent on guesses, summed over all batches.
    pub guesses: Duration,
    /// Wall time that the CPU engine spent on Newton's method, summed over all batches.
    pub refinement: Duration,
}

impl Cpu {
    /// Solves the cells of `batch` on the CPU.
    pub fn solve(&mut self, batch: &RowBatch) -> Cells {
        let begun = Stopwatch::start();
        let targets = batch.rows.par_iter().map(|row| targets(batch, row));
        let targets: Vec<Vec<Option<CellTarget>>> = targets.collect();
        self.guesses += begun.elapsed();
        let begun = Stopwatch::start();
        self.targets.clear();
        self.targets.extend(targets.iter().flatten().flatten());
        let sheets = batch.sheets();
        refine_into(batch.method, &sheets, &self.targets, &mut self.refined);
        let mut cells = Cells::new(batch, Outcome::OffSheet);
        let mut rest = self.refined.as_slice();
        let rows = batch.rows.iter().zip(&targets).zip(cells.rows_mut(batch));
        let refined_rows: Vec<_> = rows
            .map(|((row, targets), into)| {
                let count = targets.iter().flatten().count();
                (row, targets, rest.split_off(..count).unwrap_or_default(), into)
            })
            .collect();
        refined_rows.into_par_iter().for_each(|(row, targets, refined, mut into)| {
            let mut refined = refined.iter();
            for ((index, column), target) in row.each_column().enumerate().zip(targets) {
                let found = target.and_then(|_| refined.next());
                into.set(index, &solved(batch, row, column, found));
            }
        });
        self.refinement += begun.elapsed();
        cells
    }
}

/// The target of each cell of `row`; none where the sheet has no guess.
fn targets(batch: &RowBatch, row: &BatchRow) -> Vec<Option<CellTarget>> {
    let side = &batch.sides[row.side];
    let at_touch = side.sheet.rows[row.row].pole(0.0);
    let pushes = row.each_column().map(|column| side.columns.pushes[column]);
    let pushes: Vec<f64> = pushes.collect();
    let guesses = side.sheet.guesses(row.row, &pushes);
    let guesses = guesses.into_iter().zip(row.each_column());
    let targets = guesses.map(|(guess, column)| {
        guess.map(|guess| CellTarget {
            // Sides of a group are few.
            rod: row.side as u32,
            guess,
            pole: side.columns.turns[column].rotate(at_touch),
        })
    });
    targets.collect()
}

/// The cell of `row` in this `column`, as it was refined; off the sheet if it was not.
fn solved(batch: &RowBatch, row: &BatchRow, column: usize, refined: Option<&Refined>) -> Cell {
    let Some(Refined { state, outcome, steps }) = refined else {
        return Cell::new(Outcome::OffSheet, 0);
    };
    if outcome.is_solved() {
        let side = &batch.sides[row.side];
        let signed_push = side.columns.signed_push(column);
        return side.solved(row.row, signed_push, state, *steps, batch.channels.has_state());
    }
    Cell { residual: state.residual as f32, ..Cell::new(*outcome, *steps) }
}

impl Engine for Cpu {
    fn describe(&self) -> EngineDescription {
        EngineDescription::on_cpu("cpu f64")
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
