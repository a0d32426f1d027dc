//! Audit of an engine: a sample of its cells, solved or without a state, is compared with the CPU engine.

use super::summary::Audit;
use crate::classify::Outcome;
use crate::engine::{BatchRow, Cell, Cells, RowBatch, Values, WhiskerSide};
use crate::random::hash;
use crate::sheet::Sheet;
use std::ops::Range;
use whiskmap_mechanics::shooting::{Dimension, Reading};

/// Cells for each audited one.
const ONE_IN: u64 = 256;

/// Approximate minimum number of audited cells of a whisker side. With 64, the audit of maps of 32 x 32 cells took as long as half of their sheets.
const AT_LEAST: u64 = 16;

/// Maximum difference of a value, as a part of the largest along the row or of a radian.
const TOLERANCE: f64 = 3e-6;

/// Sample of audited cells of a row: the same in every run, one of each `one_in`.
pub struct AuditSample {
    seed: u64,
    one_in: u64,
}

impl AuditSample {
    /// Chooses the audited cells of `row` of `sheet`, which has `columns` columns.
    pub fn new(sheet: &Sheet, row: usize, columns: usize) -> Self {
        let cells = (sheet.rows.len() * columns) as u64;
        let distance = sheet.rows[row].pole_distance;
        let whisker = [sheet.rod.taper, sheet.rod.bend, sheet.rod.pole, sheet.side.sign()];
        let numbers = whisker.map(f64::to_bits).into_iter().chain([distance.to_bits(), row as u64]);
        Self {
            seed: numbers.fold(0, |seed, number| hash(seed ^ hash(number))),
            one_in: (cells / AT_LEAST).clamp(1, ONE_IN),
        }
    }

    /// Returns the columns of the audited cells among `columns`.
    pub fn of(&self, columns: Range<usize>) -> impl Iterator<Item = usize> + use<> {
        let Self { seed, one_in } = *self;
        let all = columns.start as u64..columns.end as u64;
        let parts = all.start / one_in..all.end.div_ceil(one_in);
        let chosen = parts.map(move |part| part * one_in + hash(seed ^ hash(part)) % one_in);
        let chosen = chosen.filter(move |column| all.contains(column));
        chosen.map(|column| column as usize)
    }
}

/// Largest error of a value by expansions, as a part of its size, over the bound on the residual in whisker lengths: the error that the
/// certificate of expansions allows.
const VALUES_PER_MISS: f64 = 10.0;

/// Largest rate at which a value changes along its row: its change in parts of its size, over the change of the row's argument in parts of the
/// argument's end. Values are smooth functions of the argument.
const BY_ARGUMENT: f64 = 4.0;

/// Compares the solved `cells` of an engine with the cells of the `rest` that the CPU `found`. Residuals of cells are at most
/// `residual_bound`, and residuals of rows at most `row_residual`, both in whisker lengths. Returns the numbers of compared and of differing cells.
pub fn compare(
    batch: &RowBatch,
    cells: &Cells,
    (residual_bound, row_residual): (f64, f64),
    rest: &RowBatch,
    found: &Cells,
) -> Audit {
    let mut audit = Audit::default();
    let rows = batch.rows.iter().zip(&rest.rows);
    let rows = rows.flat_map(|(row, part)| part.each_column().map(move |column| (row, column)));
    for ((row, column), (index, from)) in rows.zip(batch.places_in(rest)) {
        let holds = match (cells.outcome[index], found.outcome[from]) {
            (Outcome::BeyondTip | Outcome::OffSheet, ours) => !ours.is_solved(),
            (Outcome::Solved, ours) if ours != Outcome::OffSheet => {
                let theirs = cells.get(index);
                // The residual is rounded to `f32`, and so is its bound.
                theirs.residual <= residual_bound as f32
                    && holds(batch, (row, column), row_residual, &theirs, &found.get(from))
            }
            _ => continue,
        };
        audit.cells += 1;
        audit.differing += u64::from(!holds);
    }
    audit
}

/// Returns true if the values `theirs` of the engine agree with `ours` of the CPU in the channels of the batch, or if the CPU has none. The bound on the residual of the row is
/// allowed for: next to the tip of a cone the contact angle changes up to 200 times as much as the push.
fn holds(
    batch: &RowBatch,
    (row, column): (&BatchRow, usize),
    row_residual: f64,
    theirs: &Cell,
    ours: &Cell,
) -> bool {
    match ours.outcome {
        Outcome::NotConverged => return true,
        solved if solved.is_solved() => {}
        _ => return false,
    }
    let wanted = batch.channels.states();
    if !wanted.contains(&true) {
        return true;
    }
    let side = &batch.sides[row.side];
    let push = side.columns.pushes[column];
    let ours = ours.values.map(f64::from);
    let Some(end) = side.sheet.crossings[row.row].first() else {
        return false;
    };
    let miss = f64::from(theirs.residual).min(row_residual);
    let miss_angle = miss / side.sheet.rows[row.row].pole_distance;
    // Next to a fold, the argument changes with the square root of the push angle.
    let left = (end.push - push).max(miss_angle);
    let by_miss = VALUES_PER_MISS * miss + BY_ARGUMENT * miss_angle / (end.push * left).sqrt();
    let sizes = sizes(side, side.sizes(end), ours);
    let agrees = |i: usize| {
        (ours[i] - f64::from(theirs.values[i])).abs() <= (TOLERANCE + by_miss) * sizes[i]
    };
    (0..ours.len()).all(|i| !wanted[i] || agrees(i))
}

/// Sizes of the values of a row ([`WhiskerSide::sizes`]): the larger of the sizes at its end and the sizes of `ours`.
fn sizes(side: &WhiskerSide, at_end: Values, ours: Values) -> Values {
    let loads = |[arc, _, force, ..]: Values| [force.abs(), (force * arc).abs()];
    let (end_loads, our_loads) = (loads(at_end), loads(ours));
    let [force, moment] = [0, 1].map(|i| f64::max(end_loads[i], our_loads[i]));
    std::array::from_fn(|i| match Reading::DIMENSIONS[i] {
        Dimension::Length => f64::max(at_end[i].abs(), ours[i].abs()),
        Dimension::Angle => side.unit_values[i],
        Dimension::NormalForce | Dimension::Force => force,
        Dimension::Moment => moment,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use whiskmap_mechanics::rod::{Rod, Side};
    use whiskmap_mechanics::shooting::batch::Method;

    /// One cell of each part of a row, whatever the ranges; other cells in other rows.
    #[test]
    fn a_sample_has_a_cell_of_each_part() {
        for one_in in [1, 2, 7, 256] {
            let sample = |seed| AuditSample { seed, one_in };
            let all: Vec<usize> = sample(3).of(0..1792).collect();
            let parts: Vec<u64> = all.iter().map(|cell| *cell as u64 / one_in).collect();
            assert_eq!(parts, (0..1792 / one_in).collect::<Vec<_>>());
            for step in [1, 5, 100, 257] {
                let ranges = (0..1792).step_by(step).map(|from| from..1792.min(from + step));
                let joined: Vec<usize> = ranges.flat_map(|range| sample(3).of(range)).collect();
                assert_eq!(joined, all);
            }
            assert_eq!(sample(3).of(9..9).count(), 0);
            assert_eq!(sample(4).of(0..1792).eq(all), one_in == 1);
        }
    }

    #[test]
    fn one_cell_in_256_is_audited_and_at_least_16() {
        let rod = Rod::default();
        let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, &[0.5]);
        let audited = |columns| AuditSample::new(&sheet, 0, columns).of(0..columns).count();
        assert_eq!([10, 16, 4096, 1 << 16].map(audited), [10, 16, 16, 256]);
    }

    /// Rows shorter than a part have equally many cells in all.
    #[test]
    fn short_rows_are_sampled_as_often() {
        let rows = (0..4096).map(|row| AuditSample { seed: hash(row), one_in: 256 });
        let count = rows.map(|row| row.of(0..16).count()).sum::<usize>();
        // 256 of 65,536 cells, give or take four standard deviations.
        assert!((192..=320).contains(&count), "{count}");
    }
}
