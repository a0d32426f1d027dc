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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::super::exact_row::ExactRow;
    use super::super::patch::tests::cone;
    use super::super::sheet::MOST;
    use super::*;
    use crate::numerics::expansion::chebyshev_points;
    use crate::shooting::batch::Method;

    #[test]
    fn the_largest_error_has_no_sign_and_nan_stays() {
        let (mut errors, weights) = ([0.0; FUNCTIONS], [2.0; FUNCTIONS]);
        errors[1..3].copy_from_slice(&[-3.0, 1.0]);
        assert_eq!(largest(&errors, &weights), 6.0);
        assert_eq!([larger(1.0, 2.0), larger(2.0, 1.0)], [2.0, 2.0]);
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
    }

    /// Expansions of one row at each edge are accepted; every change that contradicts the end is refused.
    #[test]
    fn expansions_that_contradict_the_end_are_refused() {
        let side = cone();
        let sheet = &side.sheet;
        for edge in [Edge::Fold, Edge::Tip] {
            let mut rows = 0..sheet.rows.len();
            let row = rows
                .find(|row| sheet.crossings[*row][0].edge == edge)
                .unwrap();
            let exact = ExactRow::all(Method::fine(), sheet, &[row], 32, MOST)
                .remove(0)
                .unwrap();
            let (sound, weights) = (exact.expansion(&side), exact.weights(&side));
            let accepted = |residual: f64, change: &dyn Fn(&mut Chebyshev<FUNCTIONS>)| {
                let mut functions = sound.clone();
                change(&mut functions);
                RowExpansion::new(functions, &weights, residual, sheet, row)
            };
            let is_accepted = |residual, change: &dyn Fn(&mut Chebyshev<FUNCTIONS>)| {
                accepted(residual, change).is_some()
            };
            assert!(is_accepted(MOST, &|_| ()));
            let distance = sheet.rows[row].pole_distance;
            for by in [-2.0, 2.0] {
                let off = by * MOST / distance;
                assert!(!is_accepted(MOST, &|own| own.coefficients[0][0] += off));
            }
            let is_fold = edge == Edge::Fold;
            assert_eq!(
                is_accepted(MOST, &|own| own.coefficients[0][1] += 1e-6),
                is_fold
            );
            assert!(!is_accepted(MOST, &|own| own.coefficients[0][FUNCTIONS - 1] = f64::NAN));
            // Coefficients end where rounding does.
            let length = |size: f64| {
                let last = weights.map(|weight| size / weight);
                let longer = accepted(MOST, &|own| own.coefficients.push(last)).unwrap();
                longer.inverse.functions.coefficients.len()
            };
            assert!(length(1e-16) <= 32);
            assert_eq!(length(1e-14), 33);
            // Expansions that end before the fold are not flat enough.
            let shortened = |part: f64| {
                let points = chebyshev_points(32).iter();
                let values: Vec<Numbers> = points.map(|x| sound.at(part * x)).collect();
                is_accepted(1e-4, &|own| *own = Chebyshev::through(&values))
            };
            if is_fold {
                assert_eq!([1.0, 0.9998, 0.998].map(shortened), [true, true, false]);
            }
        }
    }
}
