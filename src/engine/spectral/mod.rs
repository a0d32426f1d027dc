//! The spectral engine: cells from certified Chebyshev expansions of their rows, without trajectories of their own.

mod certificate;
mod patch;
mod row;
mod sheet;

pub use sheet::SpectralSheet;

use super::cells::CellsMut;
use super::{
    BatchRow, Cells, Engine, EngineDescription, EngineError, EngineInput, Outcome, RowBatch,
    WhiskerSide,
};
use crate::numerics::Unit;
use crate::numerics::inverse::InverseBlock;
use crate::shooting::Resolution;
use glam::DVec2;
use rayon::prelude::*;
use row::{FUNCTIONS, RowExpansion};
use std::collections::VecDeque;
use std::sync::Arc;

/// Distance beyond the ends of a row, in parts of its end's row parameter, that rounding explains.
const OUTSIDE: f64 = 1e-6;

/// The spectral engine. It works where it is called, on the threads of the current pool: [`Engine::submit`] keeps a batch,
/// [`Engine::collect`] solves it.
#[derive(Debug, Default)]
pub struct Spectral {
    submitted: VecDeque<Arc<RowBatch>>,
}

impl Spectral {
    /// Maximum bound on the residuals of maps, in whisker lengths.
    pub const MOST: f64 = sheet::MOST;

    /// Solves the cells of `batch` whose side has a [`SpectralSheet`].
    #[must_use]
    pub fn solve(batch: &RowBatch) -> Cells {
        let mut cells = Cells::new(batch, Outcome::NoBasePoint);
        let rows: Vec<_> = batch.rows.iter().zip(cells.rows_mut(batch)).collect();
        rows.into_par_iter().for_each(|(row, into)| {
            let side = &batch.sides[row.side];
            if let Some(sheet) = &side.spectral
                && let Some(expansion) = sheet.row(side, row.row)
            {
                write(side, row, &expansion, sheet.most, into);
            }
        });
        cells
    }
}

/// Writes the cells of `row` before its end, certified to at most `most` whisker lengths.
fn write(side: &WhiskerSide, row: &BatchRow, expansion: &RowExpansion, most: f64, into: CellsMut) {
    let sheet = &side.sheet;
    let end = sheet.crossings[row.row][0].push;
    let distance = sheet.rows[row.row].pole_distance;
    let pushes = row.each().map(|cell| side.columns.magnitudes[cell]);
    let pushes: Vec<f64> = pushes.take_while(|push| *push < end).collect();
    let CellsMut {
        outcome,
        residual,
        mut values,
        points,
        ..
    } = into;
    expansion
        .inverse
        .solve(&pushes, |from, count, block: &InverseBlock<FUNCTIONS>| {
            let [found, tau, load, channels @ ..] = &block.values;
            for lane in 0..count {
                let miss = (found[lane] - pushes[from + lane]).abs() * distance;
                let bound = expansion.residual + miss;
                // NaN is not below any bound.
                let is_inside = (-OUTSIDE..=1.0 + OUTSIDE).contains(&block.places[lane]);
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
                let own = column.get_mut(here.clone()).into_iter().flatten();
                own.zip(values)
                    .for_each(|(own, value)| *own = *value as f32);
            }
            let own = points.get_mut(here).into_iter().flatten();
            own.zip(tau.iter().zip(load))
                .for_each(|(own, (tau, load))| *own = DVec2::new(*tau, *load));
        });
}

impl Engine for Spectral {
    fn describe(&self) -> EngineDescription {
        EngineDescription {
            engine: "spectral f64".to_owned(),
            adapter: Unit::detect().to_string(),
        }
    }

    fn residual_bound(&self) -> f64 {
        Self::MOST
    }

    fn input(&self, _: Resolution) -> EngineInput {
        EngineInput::SpectralSheets
    }

    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError> {
        self.submitted.push_back(batch);
        Ok(())
    }

    fn collect(&mut self) -> Result<Cells, EngineError> {
        let batch = self.submitted.pop_front();
        Ok(batch.map_or_else(Cells::default, |batch| Self::solve(&batch)))
    }
}
