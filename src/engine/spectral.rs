//! The spectral engine: cells from the nets of whisker sides ([`ValueNet`](crate::sheet::net::ValueNet)), without trajectories of their own.

use super::cells::RowCells;
use super::row::{FUNCTIONS, RowExpansion, functions};
use super::{BatchRow, Cells, Engine, EngineDescription, EngineError, RowBatch};
use crate::classify::Outcome;
use crate::sheet::net::NET_RESIDUAL;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::sync::Arc;
use whiskmap_mechanics::numerics::inverse::InverseBlock;

/// Distance beyond the ends of a row, in parts of the argument at its end, that rounding explains.
const OUTSIDE: f64 = 1e-6;

/// Spectral engine. It works where it is called, on the threads of the current pool: [`Engine::submit`] keeps a batch,
/// [`Engine::collect`] solves it.
#[derive(Debug)]
pub struct Spectral {
    /// Maximum bound on the residual of a solved cell, in whisker lengths.
    most: f64,
    submitted: VecDeque<Arc<RowBatch>>,
}

impl Default for Spectral {
    /// An engine with a residual of at most 1e-10 whisker lengths.
    fn default() -> Self {
        Self::new(NET_RESIDUAL)
    }
}

impl Spectral {
    /// Creates a spectral engine with a residual of at most `most` whisker lengths.
    #[must_use]
    pub fn new(most: f64) -> Self {
        Self { most, submitted: VecDeque::new() }
    }

    /// Solves the cells of `batch` whose rows have expansions, or are known.
    #[must_use]
    pub fn solve(&self, batch: &RowBatch) -> Cells {
        let mut cells = Cells::new(batch, Outcome::NoRow);
        let rows: Vec<_> = batch.rows.iter().zip(cells.rows_mut(batch)).collect();
        rows.into_par_iter().enumerate().for_each(|(index, (row, mut into))| {
            let of_row = (batch.expansions.get(index), batch.known.get(index));
            match of_row {
                (Some(Some(expansion)), _) => write(batch, row, expansion, self.most, &mut into),
                (_, Some(Some(known))) => {
                    known.write(row, &batch.sides[row.side].columns.pushes, into);
                }
                _ => {}
            }
        });
        cells
    }
}

/// Writes the cells of `row` before its end, and those without a state.
pub(super) fn write(
    batch: &RowBatch,
    row: &BatchRow,
    expansion: &RowExpansion,
    most: f64,
    into: &mut RowCells,
) {
    let side = &batch.sides[row.side];
    let sheet = &side.sheet;
    let distance = sheet.rows[row.row].pole_distance;
    let pushes = &side.columns.pushes;
    let before = row.columns_before(expansion.end_push, pushes);
    let targets: Vec<f64> = before.flat_map(|columns| &pushes[columns]).copied().collect();
    let RowCells { outcome, residual, values, points, .. } = into;
    expansion.write_beyond(row, pushes, outcome);
    let wanted = functions(batch.channels);
    expansion.inverse.solve(&targets, &wanted, |from, count, block: &InverseBlock<FUNCTIONS>| {
        let [found, tau, load, channels @ ..] = &block.values;
        for lane in 0..count {
            let miss = (found[lane] - targets[from + lane]).abs() * distance;
            let bound = expansion.residual + miss;
            // NaN is not below any bound.
            let is_inside =
                (-OUTSIDE..=expansion.inverse.end + OUTSIDE).contains(&block.places[lane]);
            let is_certified = is_inside && bound <= most;
            outcome[from + lane] = match sheet.is_at_tip(tau[lane], bound) {
                _ if !is_certified => Outcome::Missed,
                true => Outcome::NearEdge,
                false => Outcome::Solved,
            };
            residual[from + lane] = bound as f32;
        }
        let here = from..from + count;
        for (column, values) in values.iter_mut().zip(channels) {
            let numbers = column.get_mut(here.clone()).into_iter().flatten();
            numbers.zip(values).for_each(|(number, value)| *number = *value as f32);
        }
        let points = points.get_mut(here).into_iter().flatten();
        points
            .zip(tau.iter().zip(load))
            .for_each(|(point, (tau, load))| *point = DVec2::new(*tau, *load));
    });
}

impl Engine for Spectral {
    fn describe(&self) -> EngineDescription {
        EngineDescription::on_cpu("spectral f64")
    }

    fn residual_bound(&self) -> f64 {
        self.most
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
