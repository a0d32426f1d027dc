//! Rows of random whiskers, for engines.
#![allow(dead_code, reason = "each test program uses its own share")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::random_rods::{Random, rod};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use whiskmap::engine::{Cells, Engine, Precision, RowBatch, SideColumns, Spectral, WhiskerSide};
use whiskmap::mechanics::rod::{Effects, Rod, Side, Units};
use whiskmap::mechanics::shooting::batch::Method;
use whiskmap::plan::Channels;
use whiskmap::sheet::Sheet;

/// Columns of each side.
const COLUMNS: usize = 64;

/// The largest push angle, in radians.
const LARGEST_PUSH: f64 = 1.8;

/// Values as states have them: whisker lengths and `E I_base/L_w^2`, angles in degrees.
const NO_UNITS: Units = Units { length_mm: 1.0, force_un: 1.0, moment_nnm: 1.0, strain: 1.0 };

/// Rows of random whiskers, each on the side of its pole.
pub struct RandomRows {
    method: Method,
    /// Rows of each whisker.
    rows: usize,
    sides: Arc<[WhiskerSide]>,
}

impl RandomRows {
    /// So many rows of each of `count` random whiskers, which are `changed` first.
    pub fn many(
        rows: usize,
        effects: Effects,
        count: usize,
        seed: u64,
        changed: impl Fn(&mut Rod, &mut Random),
    ) -> Self {
        let mut random = Random::new(seed);
        let whiskers = (0..count).map(|_| {
            let mut rod = rod(effects, &mut random);
            changed(&mut rod, &mut random);
            let nearest = f64::max(0.15, 1.5 * rod.pole.abs());
            let distances = (0..rows).map(|_| random.between(nearest, 1.0)).collect();
            (rod, distances)
        });
        let whiskers: Vec<(Rod, Vec<f64>)> = whiskers.collect();
        let method = Method::fine().with_effects(effects);
        let part = |i: usize| i as f64 / COLUMNS as f64;
        let magnitudes = (1..=COLUMNS).map(|i| (LARGEST_PUSH * part(i).powi(2)).to_degrees());
        let magnitudes: Vec<f64> = magnitudes.collect();
        let backward = magnitudes.iter().rev().map(|push| -push);
        let push_angle_deg: Vec<f64> = backward.chain(magnitudes.iter().copied()).collect();
        let columns = Side::BOTH.map(|side| Arc::new(SideColumns::new(&push_angle_deg, side)));
        let sides = whiskers.par_iter().map(|(rod, distances)| {
            let is_ours = |columns: &&Arc<SideColumns>| columns.side.sign() == rod.pole.signum();
            let columns = columns.iter().find(is_ours).unwrap();
            let sheet = Sheet::new(method, rod, columns.side, distances);
            WhiskerSide::new(Arc::clone(columns), NO_UNITS, sheet)
                .with_net(Spectral::default().residual_bound())
        });
        Self { method, rows, sides: sides.collect::<Vec<_>>().into() }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows * self.sides.len()
    }

    /// Some of the rows, with expansions for `engine`, values and points.
    pub fn part(&self, engine: &dyn Engine, rows: Range<usize>) -> RowBatch {
        let rows = rows.map(|i| (i / self.rows, i % self.rows));
        let mut batch = RowBatch::new(self.method, Arc::clone(&self.sides), rows);
        batch.channels = Channels::STANDARD.with("peak_strain");
        batch.with_nets(engine.row_residual())
    }

    /// All rows.
    pub fn batch(&self, engine: &dyn Engine) -> RowBatch {
        self.part(engine, 0..self.len())
    }
}

/// Number of cells of the row with this index that the host evaluates, beside a device of this precision.
pub fn near_touch(batch: &RowBatch, index: usize, precision: Precision) -> usize {
    let Some(expansion) = &batch.expansions[index] else {
        return 0;
    };
    let row = &batch.rows[index];
    let near = precision.near_touch() * expansion.end_push;
    row.cells_before(near, &batch.sides[row.side].columns.pushes)
}

/// The response of `engine` to one batch.
pub fn solve(engine: &mut dyn Engine, batch: &RowBatch) -> Cells {
    engine.submit(Arc::new(batch.clone())).unwrap();
    engine.collect().unwrap()
}

/// For each cell of a batch of whole rows: its side, its row, and its signed push angle in radians.
pub fn places(batch: &RowBatch) -> Vec<(usize, usize, f64)> {
    let places = batch.rows.iter().flat_map(|row| {
        let columns = &batch.sides[row.side].columns;
        (0..columns.len()).map(|column| (row.side, row.row, columns.signed_push(column)))
    });
    places.collect()
}
