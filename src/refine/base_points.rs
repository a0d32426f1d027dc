//! Base points of rows: exact states along a row, relative to which an engine integrates cells as differences.
//!
//! They lie at Chebyshev points of the row parameter `w`, from first touch to the end of the row. Between them, a Chebyshev expansion
//! gives the components of the state that are analytic along the row. Each base point carries it as Taylor polynomials around itself.

use super::row_states::{ExactState, RowState, row_states};
use crate::engine::{
    BasePoint, BaseTrajectory, BatchRow, MOST_TRAJECTORY_STEPS, RowBatch, RowTerms, WhiskerSide,
};
use crate::numerics::chebyshev::{CHEBYSHEV_COUNT as NODES, CHEBYSHEV_POINTS, taylor_at_points};
use crate::numerics::nearest_turn;
use crate::rod::Rest;
use crate::sheet::{RowSpan, Sheet};
use rayon::prelude::*;

/// Returns the base points of each row of a batch, `[row][base point]`, for its cells from first touch on.
///
/// A row has no base points if it has no span from first touch, or fewer cells than base points. It also has none if a trajectory takes
/// more than [`MOST_TRAJECTORY_STEPS`].
#[must_use]
pub fn base_points(batch: &RowBatch) -> Vec<Vec<BasePoint>> {
    let wanted = batch.rows.par_iter().map(|row| {
        let has_many = row.count() > NODES;
        let span =
            has_many.then(|| SpanFromTouch::new(&batch.sides[row.side].sheet, row.row))??;
        Some((span.w_end, span.states(&*CHEBYSHEV_POINTS).collect()))
    });
    let wanted: Vec<Option<(f64, Vec<RowState>)>> = wanted.collect();
    let flat = wanted.iter().flatten().flat_map(|(_, states)| states);
    let flat: Vec<RowState> = flat.copied().collect();
    let found = row_states(batch.method, &flat);
    let mut found = found.chunks(NODES);
    let rows = batch.rows.iter().zip(wanted);
    let rows = rows.map(|(row, wanted)| {
        let (w_end, _) = wanted?;
        let found: Option<Vec<ExactState>> = found.next()?.iter().copied().collect();
        Some((row, w_end, found?))
    });
    let rows: Vec<Option<(&BatchRow, f64, Vec<ExactState>)>> = rows.collect();
    let expanded = rows.into_par_iter().map(|row| {
        let (row, w_end, found) = row?;
        let side = &batch.sides[row.side];
        let is_short = |at: &ExactState| {
            let resolution = batch.method.resolution;
            resolution.steps(&side.sheet.rod, at.tau, at.load) <= MOST_TRAJECTORY_STEPS
        };
        let is_short = found.iter().all(is_short);
        is_short.then(|| expand(side, row, w_end, &found))
    });
    expanded.map(Option::unwrap_or_default).collect()
}

/// Row span from first touch to a sound end of the row.
struct SpanFromTouch<'a> {
    sheet: &'a Sheet,
    row: usize,
    span: RowSpan,
    /// Signed row parameter `load tau^2` at the end.
    w_end: f64,
}

impl<'a> SpanFromTouch<'a> {
    /// Returns the span of `row` from first touch; `None` if the row does not go to a sound end in one span.
    pub fn new(sheet: &'a Sheet, row: usize) -> Option<Self> {
        let end = sheet.crossings[row].first()?;
        // On a lattice, a row with more crossings may be in several pieces.
        let is_one = sheet.is_continued() || sheet.crossings[row].len() == 1;
        let is_simple = sheet.touches(row) && is_one && end.is_sound() && !end.is_at_touch();
        let span = sheet.spans(row).first()?.clone();
        let w_end = end.load * end.tau * end.tau;
        let is_whole = is_simple && span.begins_at_touch() && span.reaches(w_end.abs());
        is_whole.then_some(Self {
            sheet,
            row,
            span,
            w_end,
        })
    }

    /// Returns approximate states of the row at `parts` of the row parameter's end, `[part]`.
    pub fn states(&self, parts: &[f64]) -> impl Iterator<Item = RowState<'a>> {
        let found = self
            .span
            .at(parts.iter().map(|part| (part * self.w_end).abs()));
        parts.iter().zip(found).map(|(part, [_, tau])| RowState {
            sheet: self.sheet,
            row: self.row,
            w: part * self.w_end,
            tau,
        })
    }
}

/// Returns the base points at the states `found` of a row, each with the cells nearest to it.
fn expand(side: &WhiskerSide, row: &BatchRow, w_end: f64, found: &[ExactState]) -> Vec<BasePoint> {
    let (sheet, columns) = (&side.sheet, &side.columns);
    let last = sheet.crossings[row.row][0].push;
    let sign = sheet.side.sign();
    let touch = sheet.rows[row.row].touch;
    let rest = Rest::new(&sheet.rod);
    let mut terms = [RowTerms::default(); NODES];
    let mut before = (0.0, 0.0);
    for (terms, ExactState { tau, variation, .. }) in terms.iter_mut().zip(found) {
        let full = &variation.full;
        let push = nearest_turn(full.map.pole.to_angle() - touch, before.0);
        let resting = rest.point_at_distance(full.position.length()).to_angle();
        let resting = nearest_turn(resting, before.1);
        before = (push, resting);
        let (by_tau, by_load) = (full.map.by_tau, full.map.by_load);
        *terms = [
            push, *tau, resting, by_tau.x, by_tau.y, by_load.x, by_load.y,
        ];
    }
    let points = &*CHEBYSHEV_POINTS;
    let expanded = taylor_at_points(&terms);
    let mut base_points = Vec::with_capacity(NODES);
    let mut from = 0;
    for (m, row_here) in expanded.into_iter().enumerate() {
        let [push, ..] = terms[m];
        let until = match points.get(m + 1) {
            Some(next) => {
                let half = 0.5 * (next - points[m]);
                let ahead = row_here
                    .iter()
                    .rev()
                    .fold(0.0, |sum, term| sum * half + term[0]);
                (sign * ahead).min(last)
            }
            None => last,
        };
        let to = from + columns.magnitudes[from..].partition_point(|push| *push < until);
        if to > from {
            let ExactState {
                tau,
                load,
                variation,
            } = found[m];
            base_points.push(BasePoint {
                // Sides of a group are few.
                rod: row.side as u32,
                tau,
                load,
                push,
                state: variation,
                load_per_w: w_end / (tau * tau),
                row: row_here,
                cells: columns.first + from as u32..columns.first + to as u32,
                trajectory: BaseTrajectory::default(),
            });
        }
        from = to;
    }
    base_points
}
