//! The spectral engine: cells from the nets of whisker sides ([`Net`](crate::sheet::net::Net)), without trajectories of their own.

mod row;

use super::cells::CellsMut;
use super::{
    BatchRow, Cells, Engine, EngineDescription, EngineError, EngineInput, Outcome, RowBatch,
    WhiskerSide,
};
use crate::numerics::Unit;
use crate::numerics::inverse::InverseBlock;
use crate::sheet::Edge;
use crate::sheet::net::NET_RESIDUAL;
use crate::shooting::Resolution;
use glam::DVec2;
use rayon::prelude::*;
use row::{FUNCTIONS, RowExpansion};
use std::collections::VecDeque;
use std::sync::Arc;

/// Distance beyond the ends of a row, in parts of its end's row parameter, that rounding explains.
const OUTSIDE: f64 = 1e-6;

/// Push angle beyond the end of a row at the tip, in radians, up to which the CPU engine decides at which side of the tip a cell is.
const NEAR_TIP: f64 = 1e-3;

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
        Self {
            most,
            submitted: VecDeque::new(),
        }
    }

    /// Solves the cells of `batch` whose side has a net with their row.
    #[must_use]
    pub fn solve(&self, batch: &RowBatch) -> Cells {
        let mut cells = Cells::new(batch, Outcome::NoBasePoint);
        let rows: Vec<_> = batch.rows.iter().zip(cells.rows_mut(batch)).collect();
        rows.into_par_iter().for_each(|(row, into)| {
            let side = &batch.sides[row.side];
            if let Some(expansion) = RowExpansion::of(side, row.row, self.most) {
                write(side, row, &expansion, self.most, into);
            }
        });
        cells
    }
}

/// Writes the cells of `row` before its end, and those without a state.
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
    // Beyond the tip and beyond the sheet, cells have no state. Others beyond the end fall back to the CPU engine.
    // A row with more pieces may have states there.
    let is_one = sheet.crossings[row.row].len() == 1;
    let last = match &sheet.spans(row.row)[..] {
        [span] if is_one => span.last_push(),
        _ => f64::INFINITY,
    };
    let tip = match sheet.crossings[row.row][0].edge {
        Edge::Tip if is_one => end + NEAR_TIP,
        _ => last,
    };
    let beyond = row.each().zip(outcome.iter_mut()).skip(pushes.len());
    for (cell, outcome) in beyond {
        let push = side.columns.magnitudes[cell];
        if push > last {
            *outcome = Outcome::OffSheet;
        } else if push > tip {
            *outcome = Outcome::BeyondTip;
        }
    }
    expansion
        .inverse
        .solve(&pushes, |from, count, block: &InverseBlock<FUNCTIONS>| {
            let [found, tau, load, channels @ ..] = &block.values;
            for lane in 0..count {
                let miss = (found[lane] - pushes[from + lane]).abs() * distance;
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
        self.most
    }

    fn input(&self, _: Resolution) -> EngineInput {
        EngineInput::Nets(self.most)
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
