//! Expansions of one row: push angle, contact, load and channel values as functions of the row parameter.

use crate::engine::{Values, WhiskerSide};
use crate::numerics::expansion::{Chebyshev, MOST_POINTS, TAIL, chebyshev_points};
use crate::numerics::inverse::Inverse;
use crate::numerics::nearest_turn;
use crate::plan::STATE_CHANNELS;
use crate::refine::{ExactState, LEFT_BY_STEP, RowState, RowStateGoal, SpanFromTouch, row_states};
use crate::sheet::{Crossing, Edge, Row, Sheet};
use crate::shooting::ShootingMap;
use crate::shooting::batch::Method;
use rayon::prelude::*;

/// Number of functions that are expanded along a row.
pub const FUNCTIONS: usize = 3 + STATE_CHANNELS.len();

/// Numbers of a state, `[function]`: magnitude of the push angle since first touch in radians, `tau`, signed load, and the channel values
/// in map units.
pub type Numbers = [f64; FUNCTIONS];

/// Weights that convert errors of [`Numbers`] to whisker lengths, `[function]`.
pub type Weights = [f64; FUNCTIONS];

/// Error in whisker lengths that an error as large as the value's size along the row counts as: values may be ten times less accurate
/// than states.
const VALUE_WEIGHT: f64 = 0.1;

/// Weighted coefficient below which an expansion ends: below the rounding of the states.
const ROUNDING: f64 = 1e-15;

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

/// Newton starts of the exact states of rows.
#[derive(Clone, Copy)]
pub enum StateStarts<'a> {
    /// Starts from the row spans of the rows.
    Spans,
    /// Starts from expansions of each row, `[row]`, with their largest error in whisker lengths.
    Expansions(&'a [Chebyshev<FUNCTIONS>], f64),
}

/// Part of the bound on the residual that the extrapolated Newton step of a state may take. The certificate finds larger errors.
const STATE_ERROR: f64 = 0.1;

/// Largest sum of the contact's arclength and the pole's distance, in whisker lengths, in the bound on the error of a step.
const LARGEST_LEVER: f64 = 2.0;

impl ExactRow {
    /// Computes `count` states of each row of `sheet` from `starts`, for expansions with a residual of at most `most` whisker lengths. An
    /// entry is `None` for a row without a simple span from first touch, or if Newton's method fails for a state.
    pub fn all(
        method: Method,
        sheet: &Sheet,
        rows: &[usize],
        count: usize,
        most: f64,
        starts: StateStarts,
    ) -> Vec<Option<Self>> {
        let points = chebyshev_points(count);
        let spans = rows.par_iter().enumerate().map(|(i, row)| match starts {
            StateStarts::Spans => Some(SpanFromTouch::new(sheet, *row)?.states(points).collect()),
            StateStarts::Expansions(rows, _) => {
                let end = simple_end(sheet, *row)?;
                let state = |place: &f64| RowState {
                    sheet,
                    row: *row,
                    w: place * end.load * end.tau * end.tau,
                    tau: rows[i].at(*place)[1],
                };
                Some(points.iter().map(state).collect())
            }
        });
        let spans: Vec<Option<Vec<RowState>>> = spans.collect();
        let longest_step = (STATE_ERROR * most / (LARGEST_LEVER * LEFT_BY_STEP)).sqrt();
        let goal = RowStateGoal {
            longest_step,
            is_coarse_first: match starts {
                StateStarts::Spans => true,
                StateStarts::Expansions(_, error) => error > longest_step,
            },
        };
        let flat: Vec<RowState> = spans.iter().flatten().flatten().copied().collect();
        let found = row_states(method, &flat, goal);
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

/// Returns the weights of channel values along a row with this `end`. The energy is at most the moment times the push angle, in radians,
/// and the chord angle at most about the push angle.
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

/// Returns the larger of two errors in one unit; NaN if either is.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// Returns the largest of the weighted `errors`, in whisker lengths; NaN if one is.
pub fn largest(errors: &Numbers, weights: &Weights) -> f64 {
    let weighted = errors.iter().zip(weights);
    let weighted = weighted.map(|(error, weight)| error.abs() * weight);
    weighted.fold(0.0, larger)
}

/// Factor by which more points are taken than the rate at the last coefficients calls for.
const SAFETY: f64 = 1.1;

/// Weighted sizes of the last coefficients of expansions, in whisker lengths.
#[derive(Clone, Copy, Debug)]
pub struct ExpansionTail {
    /// Largest of the last coefficients, in whisker lengths: the expected error of the expansions.
    pub last: f64,
    /// Largest of as many coefficients before.
    before: f64,
}

impl ExpansionTail {
    /// Creates the tail of expansions from their [`tails`](Chebyshev::tails) and the `weights` to whisker lengths.
    pub fn new(tails: &[Numbers; 2], weights: &Weights) -> Self {
        let [last, before] = tails.each_ref().map(|tail| largest(tail, weights));
        Self { last, before }
    }

    /// Returns the larger of the tails of two expansions.
    pub fn larger(self, other: Self) -> Self {
        Self {
            last: larger(self.last, other.last),
            before: larger(self.before, other.before),
        }
    }

    /// Returns the number of points whose last coefficients are expected to be `goal`, if coefficients go on to fall at the same rate. This tail is
    /// that of `count` points. `None` above [`MOST_POINTS`].
    pub fn points(self, count: usize, goal: f64) -> Option<usize> {
        if self.last <= goal {
            return Some(count);
        }
        let falls = libm::log(self.before / self.last) / TAIL as f64;
        let more = SAFETY * libm::log(self.last / goal) / falls;
        let is_possible = falls > 0.0 && more <= (MOST_POINTS - count) as f64;
        is_possible.then(|| (count + more as usize + 1).min(MOST_POINTS))
    }
}

/// A certified row.
#[derive(Clone, Debug)]
pub struct RowExpansion {
    /// Expansions of the row, with the inverse of the push angle.
    pub inverse: Inverse<FUNCTIONS>,
    /// Bound on the residual of a state of the row, in whisker lengths.
    pub residual: f64,
}

/// Largest slope of the push angle at a fold, over its value there: where the expansions end a thousandth of the row before the fold, the
/// slope is about twice as large.
const FOLD_SLOPE: f64 = 1e-3;

impl RowExpansion {
    /// Shortens the expansions of `row` to what rounding leaves. Returns `None` if a coefficient is not finite, if the push angle does not
    /// grow along them, or if they contradict the end of the row, which is computed apart: they must end at its push angle, and be flat
    /// there at a fold, or have their contact at the tip.
    pub fn new(
        mut functions: Chebyshev<FUNCTIONS>,
        weights: &Weights,
        residual: f64,
        sheet: &Sheet,
        row: usize,
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
        let end = &sheet.crossings[row][0];
        let [push, tau, ..] = functions.at(1.0);
        let is_at_edge = match end.edge {
            Edge::Fold => functions.slope(0, 1.0) <= FOLD_SLOPE * push,
            Edge::Tip => sheet.is_at_tip(tau, residual),
        };
        let off = (push - end.push).abs() * sheet.rows[row].pole_distance;
        let inverse = Inverse::new(functions)?;
        (off <= residual && is_at_edge).then_some(Self { inverse, residual })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of points of an expansion with coefficients `0.3^k` that leaves out 1e-11, from one of 16 points.
    #[test]
    fn the_decay_gives_the_number_of_points() {
        let tail = |first: i32| 0.3_f64.powi(first);
        let tail = ExpansionTail {
            last: tail(13),
            before: tail(10),
        };
        let points = tail.points(16, 1e-11);
        // 0.3^21.04 is 1e-11: 8.04 more, and a tenth.
        assert_eq!(points, Some(16 + 9));
        assert_eq!(tail.points(16, 1e-6), Some(16));
        let flat = ExpansionTail {
            last: 1e-3,
            before: 1e-3,
        };
        assert_eq!(flat.points(16, 1e-11), None);
        assert_eq!(tail.points(36, 1e-11), None);
        let unknown = ExpansionTail {
            last: f64::NAN,
            ..flat
        };
        assert_eq!(unknown.points(16, 1e-11), None);
    }
}
