//! Expansions of one row: push angle, contact, load and channel values as functions of the row parameter.

use crate::engine::{Values, WhiskerSide};
use crate::numerics::expansion::Chebyshev;
use crate::numerics::inverse::Inverse;
use crate::plan::STATE_CHANNELS;
use crate::sheet::{Crossing, Edge, Sheet};

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

/// Returns the numbers of a state from its push angle, `tau`, load and channel values.
pub fn numbers(push: f64, tau: f64, load: f64, values: &Values) -> Numbers {
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
