//! Exact states of rows by Newton's method, and the expansions through them.

use super::row::{FUNCTIONS, Weights, numbers, value_weights};
use crate::engine::WhiskerSide;
use crate::numerics::expansion::{Chebyshev, chebyshev_points};
use crate::numerics::nearest_turn;
use crate::refine::{ExactState, LEFT_BY_STEP, RowState, SpanFromTouch, row_states};
use crate::sheet::{Crossing, Row, Sheet};
use crate::shooting::ShootingMap;
use crate::shooting::batch::Method;
use rayon::prelude::*;

/// Exact states of a row at the Chebyshev points of its row parameter.
#[derive(Clone, Debug)]
pub struct ExactRow {
    /// Row of the exact states.
    pub row: Row,
    /// Crossing at which the row ends.
    pub end: Crossing,
    /// Exact states of the row, by growing push angle, `[state]`.
    pub states: Vec<ExactState>,
}

/// Returns the end of a `row` of `sheet`; `None` if it has no simple span from first touch.
pub fn simple_end(sheet: &Sheet, row: usize) -> Option<&Crossing> {
    let [end] = &sheet.crossings[row][..] else {
        return None;
    };
    let is_simple = sheet.touches(row) && end.is_sound() && !end.is_at_touch();
    (is_simple && !sheet.is_continued()).then_some(end)
}

/// Part of the bound on the residual that the extrapolated Newton step of a state may take. The certificate finds larger errors.
/// At 0.1, their noise in the last coefficients refuses patches.
const STATE_ERROR: f64 = 0.03;

/// Largest sum of the contact's arclength and the pole's distance, in whisker lengths, in the bound on the error of a step.
const LARGEST_LEVER: f64 = 2.0;

impl ExactRow {
    /// Computes `count` states of each row of `sheet` from its row span, for expansions with a residual of at most `most` whisker lengths.
    /// An entry is `None` for a row without a simple span from first touch, or if Newton's method fails for a state.
    pub fn all(
        method: Method,
        sheet: &Sheet,
        rows: &[usize],
        count: usize,
        most: f64,
    ) -> Vec<Option<Self>> {
        let points = chebyshev_points(count);
        let spans = rows
            .par_iter()
            .map(|row| Some(SpanFromTouch::new(sheet, *row)?.states(points).collect()));
        let spans: Vec<Option<Vec<RowState>>> = spans.collect();
        let longest_step = (STATE_ERROR * most / (LARGEST_LEVER * LEFT_BY_STEP)).sqrt();
        let flat: Vec<RowState> = spans.iter().flatten().flatten().copied().collect();
        let found = row_states(method, &flat, longest_step);
        let mut found = found.chunks(count);
        let rows = rows.iter().zip(&spans).map(|(row, span)| {
            span.as_ref()?;
            let states: Option<Vec<ExactState>> = found.next()?.iter().copied().collect();
            Some(Self {
                row: sheet.rows[*row],
                end: sheet.crossings[*row][0],
                states: states?,
            })
        });
        rows.collect()
    }

    /// Returns the expansions through the exact states of the row.
    pub fn expansion(&self, side: &WhiskerSide) -> Chebyshev<FUNCTIONS> {
        let mut before = 0.0;
        let numbers = self.states.iter().map(|state| {
            let full = &state.variation.full;
            let push = nearest_turn(full.map.pole.to_angle() - self.row.touch, before);
            before = push;
            let values = side.values_at(&self.row, state.tau, full, push);
            numbers(
                side.sheet.side.sign() * push,
                state.tau,
                state.load,
                &values,
            )
        });
        Chebyshev::through(&numbers.collect::<Vec<_>>())
    }

    /// Returns the weights of the numbers of the row's states.
    pub fn weights(&self, side: &WhiskerSide) -> Weights {
        let maps = self.states.iter().map(|state| &state.variation.full.map);
        let steepest = |slope: fn(&ShootingMap) -> f64| maps.clone().map(slope).fold(0.0, f64::max);
        let distance = self.row.pole_distance;
        let values = value_weights(side, &self.end);
        numbers(
            distance,
            distance * steepest(|map| map.by_tau.length()),
            distance * steepest(|map| map.by_load.length()),
            &values,
        )
    }
}
