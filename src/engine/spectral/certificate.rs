//! Certificate of expansions: the decay of their last coefficients, and trajectories between their points.

use super::row::{FUNCTIONS, Numbers, Weights, larger, largest};
use crate::engine::WhiskerSide;
use crate::numerics::expansion::Chebyshev;
use crate::refine::GOAL;
use crate::sheet::Row;
use crate::shooting::FirstVariation;
use crate::shooting::batch::{Batch, InitialCondition, Method};

/// Factor by which a bound exceeds the largest error seen: the error between a few places may be larger than there.
pub const MARGIN: f64 = 4.0;

/// Check of the expansions of one row at places between its points.
pub struct Check<'a> {
    /// Row whose expansions are checked.
    pub row: Row,
    /// Expansions of the row that are checked.
    pub functions: &'a Chebyshev<FUNCTIONS>,
    /// Weights that convert errors of the expansions to whisker lengths.
    pub weights: &'a Weights,
    /// Places of the row in `[0, 1]` at which its expansions are checked.
    pub places: &'a [f64],
}

/// Returns a bound on the errors of each check's expansions, in whisker lengths: `[check]`. It follows from trajectories at the places
/// and from the error `by_decay` that the coefficients left out are expected to make. It is at least [`GOAL`], the residual of refined
/// states; NaN if a number is.
pub fn bounds(method: Method, side: &WhiskerSide, checks: &[Check], by_decay: &[f64]) -> Vec<f64> {
    let at = |check: &Check| -> Vec<Numbers> {
        check
            .places
            .iter()
            .map(|place| check.functions.at(*place))
            .collect()
    };
    let expanded: Vec<Vec<Numbers>> = checks.iter().map(at).collect();
    let conditions = expanded
        .iter()
        .flatten()
        .map(|[_, tau, load, ..]| InitialCondition {
            rod: &side.sheet.rod,
            tau: *tau,
            load: *load,
        });
    let found: Vec<FirstVariation> = Batch::new(method).shoot(&conditions.collect::<Vec<_>>());
    let mut found = found.iter();
    let sign = side.sheet.side.sign();
    let checks = checks.iter().zip(expanded).zip(by_decay);
    let bounds = checks.map(|((check, expanded), by_decay)| {
        let misses = expanded.iter().zip(found.by_ref()).map(|(numbers, found)| {
            let full = &found.full;
            let [push, tau, _, values @ ..] = numbers;
            let push = sign * push;
            let miss = full.map.pole.distance(check.row.pole(push));
            let exact = side.values_at(&check.row, *tau, full, push);
            let mut errors = [0.0; FUNCTIONS];
            for ((error, value), exact) in errors[3..].iter_mut().zip(values).zip(exact) {
                *error = value - exact;
            }
            larger(miss, largest(&errors, check.weights))
        });
        larger(MARGIN * misses.fold(*by_decay, larger), GOAL)
    });
    bounds.collect()
}
