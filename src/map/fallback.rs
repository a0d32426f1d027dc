//! Fallback to the CPU: cells of a row batch that an engine has not certified, and the audit of the others.

use super::audit::{self, AuditSample};
use super::summary::{Audit, EngineCells};
use crate::classify::Outcome;
use crate::engine::{Cells, Cpu, RowBatch};
use rayon::prelude::*;
use std::ops::Range;

/// Completes the `cells` of an engine on the CPU, or solves all cells there without an engine. It counts cells in `counts`; with a failed
/// engine (`has_failed`), those without a row count as solved by the CPU instead. Returns all cells and the result of the audit.
pub fn complete(
    batch: &RowBatch,
    cells: Option<(Cells, (f64, f64))>,
    has_failed: bool,
    cpu: &mut Cpu,
    counts: &mut EngineCells,
) -> (Cells, Audit) {
    let mut audit = Audit::default();
    if let Some((mut cells, bounds)) = cells {
        let rest = rest(batch, &cells);
        let found = cpu.solve(&rest);
        audit = audit::compare(batch, &cells, bounds, &rest, &found);
        if audit.differing == 0 {
            for outcome in &cells.outcome {
                counts.count(*outcome);
            }
            let mut without = 0;
            for (index, from) in batch.places_in(&rest) {
                let before = cells.outcome[index];
                if !is_final(before) {
                    let is_row_missing =
                        before == Outcome::NoRow && may_have_state(found.outcome[from]);
                    without += u64::from(is_row_missing);
                    cells.set(index, &found.get(from));
                }
            }
            counts.add_others(without, has_failed);
            return (cells, audit);
        }
        let solved = cells.outcome.iter().filter(|outcome| **outcome == Outcome::Solved);
        audit.turned_over = solved.count() as u64;
    }
    let cells = cpu.solve(batch);
    let outcomes = cells.outcome.iter();
    let others = outcomes.filter(|outcome| may_have_state(**outcome)).count();
    counts.add_others(others as u64, has_failed || audit.differing > 0);
    (cells, audit)
}

/// Returns false for a cell that is certainly beyond the tip or off the sheet: such cells count for no engine.
const fn may_have_state(outcome: Outcome) -> bool {
    !matches!(outcome, Outcome::BeyondTip | Outcome::OffSheet)
}

/// Returns true if the CPU only audits cells with this outcome of an engine.
const fn is_final(outcome: Outcome) -> bool {
    matches!(outcome, Outcome::Solved | Outcome::BeyondTip | Outcome::OffSheet)
}

/// The cells that the CPU solves: cells without a certificate, and the sample of the audit.
fn rest(batch: &RowBatch, cells: &Cells) -> RowBatch {
    let rows = batch.rows.par_iter().map(|row| {
        let side = &batch.sides[row.side];
        let outcomes = &cells.outcome[row.cells()];
        let sample = AuditSample::new(&side.sheet, row.row, side.columns.len());
        let mut wanted: Vec<Range<usize>> = Vec::new();
        let mut from = 0;
        for run in outcomes.chunk_by(|a, b| is_final(*a) == is_final(*b)) {
            let columns = from..from + run.len();
            from = columns.end;
            match is_final(run[0]) {
                true => wanted.extend(sample.of(columns).map(|column| column..column + 1)),
                false => wanted.push(columns),
            }
        }
        wanted
    });
    let mut rest = batch.only(rows.collect::<Vec<_>>());
    if rest.channels.has_state() {
        // The audit takes the sizes of values from all channels of a state.
        rest.channels = rest.channels.with_states();
    }
    rest
}
