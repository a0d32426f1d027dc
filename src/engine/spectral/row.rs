//! Expansions of one row: push angle, contact, load and channel values as functions of the row parameter.

use crate::engine::{Values, WhiskerSide};
use crate::numerics::expansion::{Chebyshev, chebyshev_points};
use crate::numerics::inverse::Inverse;
use crate::numerics::nearest_turn;
use crate::plan::STATE_CHANNELS;
use crate::refine::{ExactState, SpanFromTouch, row_states};
use crate::sheet::{Crossing, Row, Sheet};
use crate::shooting::ShootingMap;
use crate::shooting::batch::Method;
use rayon::prelude::*;

/// Number of functions that are expanded along a row.
pub const FUNCTIONS: usize = 3 + STATE_CHANNELS.len();

/// Numbers of a state: magnitude of the push angle since first touch in radians, `tau`, signed load, and the channel values in map units.
pub type Numbers = [f64; FUNCTIONS];

/// Weights that convert errors of [`Numbers`] to whisker lengths.
pub type Weights = [f64; FUNCTIONS];

/// Error in whisker lengths that an error as large as the value's size along the row counts as: values may be ten times less accurate
/// than states.
const VALUE_WEIGHT: f64 = 0.1;

/// Weighted coefficient below which an expansion ends: below the rounding of the states.
const ROUNDING: f64 = 1e-15;

/// Longest Newton step to a state whose end is extrapolated: the error that it leaves is below rounding.
const EXTRAPOLATED: f64 = 3e-8;

/// Exact states of a row at the Chebyshev points of its row parameter.
#[derive(Clone, Debug)]
pub struct ExactRow {
    /// The row.
    pub row: Row,
    /// The row's end.
    pub end: Crossing,
    /// The states, by growing push angle.
    pub states: Vec<ExactState>,
}

impl ExactRow {
    /// Computes `count` states of each of `rows` of a sheet. An entry is `None` for a row without a simple span from first touch, or
    /// if Newton's method fails for a state.
    pub fn all(method: Method, sheet: &Sheet, rows: &[usize], count: usize) -> Vec<Option<Self>> {
        let spans = rows.par_iter();
        let spans: Vec<_> = spans.map(|row| SpanFromTouch::new(sheet, *row)).collect();
        let states = spans
            .iter()
            .flatten()
            .flat_map(|span| span.states(chebyshev_points(count)));
        let found = row_states(method, &states.collect::<Vec<_>>(), EXTRAPOLATED);
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

    /// The expansions through the states.
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

    /// The weights of the row's numbers.
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

/// Weights of channel values along a row with this `end`. The energy is at most the moment times the push angle, in radians, and the chord
/// angle at most about the push angle.
pub fn value_weights(side: &WhiskerSide, end: &Crossing) -> Values {
    let push = end.push.min(1.0);
    let [arc, angle, force, x, y, moment, chord, distance, energy] = side.sizes(end);
    let sizes = [
        arc,
        angle,
        force,
        x,
        y,
        moment,
        push * chord,
        distance,
        push * energy,
    ];
    sizes.map(|size| VALUE_WEIGHT / size)
}

fn numbers(push: f64, tau: f64, load: f64, values: &Values) -> Numbers {
    let mut numbers = [push; FUNCTIONS];
    (numbers[1], numbers[2]) = (tau, load);
    numbers[3..].copy_from_slice(values);
    numbers
}

/// The larger of two errors; NaN if either is.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// Largest of the weighted `errors`, in whisker lengths; NaN if one is.
pub fn largest(errors: &Numbers, weights: &Weights) -> f64 {
    let weighted = errors.iter().zip(weights);
    let weighted = weighted.map(|(error, weight)| error.abs() * weight);
    weighted.fold(0.0, larger)
}

/// A certified row.
#[derive(Clone, Debug)]
pub struct RowExpansion {
    /// The expansions, with the inverse of the push angle.
    pub inverse: Inverse<FUNCTIONS>,
    /// Bound on the residual of a state, in whisker lengths.
    pub residual: f64,
}

impl RowExpansion {
    /// Shortens the expansions to what rounding leaves. Returns `None` if a coefficient is not finite, if the push angle does not grow along
    /// them, or if they end elsewhere than the row, whose end is computed apart.
    pub fn new(
        mut functions: Chebyshev<FUNCTIONS>,
        weights: &Weights,
        residual: f64,
        row: &Row,
        end: &Crossing,
    ) -> Option<Self> {
        let is_rounding = |term: &Numbers| largest(term, weights) < ROUNDING;
        while functions.coefficients.len() > 1
            && functions.coefficients.last().is_some_and(is_rounding)
        {
            functions.coefficients.pop();
        }
        let mut coefficients = functions.coefficients.iter().flatten();
        if !coefficients.all(|coefficient| coefficient.is_finite()) {
            return None;
        }
        let inverse = Inverse::new(functions)?;
        let off = (inverse.last() - end.push).abs() * row.pole_distance;
        (off <= residual).then_some(Self { inverse, residual })
    }
}
