//! Expansions of one row: push angle, contact, load and channel values as functions of the row's part of the load.

use super::{BatchRow, RowCells, Values, WhiskerSide};
use crate::classify::Outcome;
use crate::plan::{Channels, STATE_CHANNELS};
use crate::sheet::net::{MARGIN, NetBlock, NetRow, VALUE_WEIGHT, larger, largest};
use crate::sheet::{Crossing, Edge, PUSH_MARGIN, Sheet};
use whiskmap_mechanics::numerics::expansion::Chebyshev;
use whiskmap_mechanics::numerics::inverse::Inverse;
use whiskmap_mechanics::numerics::{LaneNumbers, Lanes, SimdTask, Unit, WIDTH, keep};
use whiskmap_mechanics::shooting::Reader;

/// Number of functions that are expanded along a row.
pub const FUNCTIONS: usize = 3 + STATE_CHANNELS.len();

/// Returns which functions a map with these `channels` needs: push angle, contact and load, and the channels of a state that it has.
#[must_use]
pub fn functions(channels: Channels) -> [bool; FUNCTIONS] {
    let mut wanted = [true; FUNCTIONS];
    wanted[3..].copy_from_slice(&channels.states());
    wanted
}

/// Numbers of a state, `[function]`: magnitude of the push angle since first touch in radians, `tau`, signed load, and the channel values
/// in map units.
pub type RowNumbers = [f64; FUNCTIONS];

/// Weighted coefficient below which an expansion ends: below the rounding of the states.
const ROUNDING: f64 = 1e-15;

/// Returns the weights of channel values along a row with this `end`. The energy is at most the moment times the push angle, in radians,
/// and the chord angle at most about the push angle.
fn value_weights(side: &WhiskerSide, end: &Crossing) -> Values {
    let push = end.push.min(1.0);
    let mut sizes = side.sizes(end);
    let [_, _, _, _, _, _, chord, _, energy] = &mut sizes;
    for size in [chord, energy] {
        *size *= push;
    }
    sizes.map(|size| VALUE_WEIGHT / size)
}

/// Returns the weights that convert errors of the numbers of a `row` of `side` to whisker lengths, `[function]`.
fn weights(side: &WhiskerSide, row: usize) -> RowNumbers {
    let distance = side.sheet.rows[row].pole_distance;
    let end = &side.sheet.crossings[row][0];
    let mut weights = [distance; FUNCTIONS];
    (weights[1], weights[2]) = (distance / end.tau, distance / end.load.abs());
    weights[3..].copy_from_slice(&value_weights(side, end));
    weights
}

/// Returns the numbers of the states of a row, `[state]`.
fn numbers(reader: &Reader, states: &NetRow) -> Vec<RowNumbers> {
    let unit = Unit::detect();
    let mut all = Vec::with_capacity(states.blocks.len() * WIDTH);
    for block in &states.blocks {
        let channels = unit.run(BlockChannels { reader, block });
        all.extend((0..block.count).map(|lane| {
            let mut numbers = [block.push[lane]; FUNCTIONS];
            (numbers[1], numbers[2]) = (block.tau[lane], block.load[lane]);
            for (number, values) in numbers[3..].iter_mut().zip(&channels) {
                *number = values[lane];
            }
            numbers
        }));
    }
    all
}

/// Channel values of a block of states.
struct BlockChannels<'a> {
    reader: &'a Reader,
    block: &'a NetBlock,
}

impl SimdTask for BlockChannels<'_> {
    type Output = [LaneNumbers; STATE_CHANNELS.len()];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let mut channels = [[0.0; WIDTH]; STATE_CHANNELS.len()];
        for from in (0..self.block.count).step_by(T::LANES) {
            let found = self.reader.channels(self.block.numbers.pack::<T>(from));
            for (lanes, found) in channels.iter_mut().zip(found) {
                keep(lanes, from, found);
            }
        }
        channels
    }
}

/// A certified row.
#[derive(Clone, Debug)]
pub struct RowExpansion {
    /// Expansions of the row, with the inverse of the push angle.
    pub inverse: Inverse<FUNCTIONS>,
    /// Bound on the residual of a state of the row, in whisker lengths.
    pub residual: f64,
    /// Magnitude of the push angle at the row's end, which is computed apart, in radians.
    pub end_push: f64,
}

/// Largest slope of the push angle at a fold, where it must be flat, over its value there. Expansions that end a thousandth of the row before the
/// fold have about twice this slope.
const FOLD_SLOPE: f64 = 1e-3;

impl RowExpansion {
    /// Returns the expansions of a `row` of `side` with a residual of at most `most` whisker lengths, from its net; `None` without them.
    #[must_use]
    pub fn of(side: &WhiskerSide, row: usize, most: f64) -> Option<Self> {
        let (states, residual) = side.sheet.net_row(row)?;
        let weights = weights(side, row);
        let functions = Chebyshev::through(&numbers(side.reader(), &states));
        let [last, _] = functions.tails();
        let residual = larger(residual, MARGIN * largest(&last, &weights));
        // NaN is not below any bound.
        let expansion = || Self::new(functions, states.end, &weights, residual, &side.sheet, row);
        (residual <= most).then(expansion)?
    }

    /// Drops the last coefficients of the expansions of `row` that are only rounding. The row ends at the argument `end`.
    ///
    /// Returns `None` if a coefficient is not finite, if the push angle does not grow up to the end, or if the expansions contradict the end, which
    /// is computed apart: they must have its push angle there, and be flat at a fold, or have their contact at the tip.
    fn new(
        mut functions: Chebyshev<FUNCTIONS>,
        end: f64,
        weights: &RowNumbers,
        residual: f64,
        sheet: &Sheet,
        row: usize,
    ) -> Option<Self> {
        let is_rounding = |term: &RowNumbers| largest(term, weights) < ROUNDING;
        while functions.coefficients.len() > 1
            && functions.coefficients.last().is_some_and(is_rounding)
        {
            functions.coefficients.pop();
        }
        let mut coefficients = functions.coefficients.iter().flatten();
        if !coefficients.all(|coefficient| coefficient.is_finite()) {
            return None;
        }
        let crossing = &sheet.crossings[row][0];
        let [push, tau, ..] = functions.at(end);
        let is_at_edge = match crossing.edge {
            Edge::Fold => functions.slope(0, end) <= FOLD_SLOPE * push,
            Edge::Tip => sheet.is_at_tip(tau, residual),
        };
        let off = (push - crossing.push).abs() * sheet.rows[row].pole_distance;
        let inverse = Inverse::new(functions, end)?;
        (off <= residual && is_at_edge).then_some(Self {
            inverse,
            residual,
            end_push: crossing.push,
        })
    }

    /// Writes the outcomes of the cells of `row` that have no state, beyond its end. `pushes` are the push angles of the side's columns:
    /// magnitudes in radians.
    pub(super) fn write_beyond(&self, row: &BatchRow, pushes: &[f64], outcomes: &mut [Outcome]) {
        let near = row.cells_before((self.end_push + PUSH_MARGIN).next_up(), pushes);
        outcomes[near..].fill(Outcome::OffSheet);
    }
}

/// Row of a map without numbers of states: each push angle from first touch to its end has a state, and none beyond.
#[derive(Clone, Copy, Debug)]
pub struct KnownRow {
    /// Magnitude of the push angle at the row's end, in radians.
    end_push: f64,
    /// Bound on the residual of the states of the row, in whisker lengths.
    residual: f64,
}

impl KnownRow {
    /// Largest residual of the states of a row, in whisker lengths. The states only show that there are any.
    pub const RESIDUAL: f64 = 1e-4;

    /// Returns the known rows among the `rows` of `side`, `[row]`. `None` for a row that has other ends, or for which the net for guesses allows a
    /// residual of more than [`Self::RESIDUAL`].
    #[must_use]
    pub fn of(side: &WhiskerSide, rows: &[usize]) -> Vec<Option<Self>> {
        let known = side.sheet.known_residuals(rows).into_iter();
        let known = known.map(|known| {
            let (end, residual) = known?;
            // NaN is not below any bound.
            (residual <= Self::RESIDUAL).then_some(Self { end_push: end.push, residual })
        });
        known.collect()
    }

    /// Writes outcomes and residuals of the cells of `row`, except those next to the end. `pushes` are the push angles of the side's columns:
    /// magnitudes in radians.
    pub(super) fn write(&self, row: &BatchRow, pushes: &[f64], into: RowCells) {
        let near = row.cells_before(self.end_push - PUSH_MARGIN, pushes);
        let beyond = row.cells_before((self.end_push + PUSH_MARGIN).next_up(), pushes);
        into.outcome[..near].fill(Outcome::Solved);
        into.outcome[near..beyond].fill(Outcome::NearEdge);
        into.outcome[beyond..].fill(Outcome::OffSheet);
        into.residual[..near].fill(self.residual as f32);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::engine::SideColumns;
    use crate::scene::Scene;
    use crate::sheet::net::NET_RESIDUAL as MOST;
    use std::sync::Arc;
    use whiskmap_mechanics::rod::Side;
    use whiskmap_mechanics::shooting::batch::Method;

    /// The cone of the paper with more rows at the tip than its map has.
    fn cone() -> WhiskerSide {
        let scene = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml").unwrap();
        let swept = scene.first_whisker();
        let pushes: Vec<f64> = (1..60).map(f64::from).collect();
        let columns = Arc::new(SideColumns::new(&pushes, Side::Cb));
        let (rod, units) = (swept.rod(columns.side), swept.whisker.units());
        let distances: Vec<f64> = (0..200).map(|i| 0.4 + 0.003 * f64::from(i)).collect();
        let sheet = Sheet::new(Method::fine(), &rod, columns.side, &distances);
        WhiskerSide::new(columns, units, sheet).with_net(MOST)
    }

    #[test]
    fn the_largest_error_has_no_sign_and_nan_stays() {
        let (mut errors, weights) = ([0.0; FUNCTIONS], [2.0; FUNCTIONS]);
        errors[1..3].copy_from_slice(&[-3.0, 1.0]);
        assert_eq!(largest(&errors, &weights), 6.0);
        assert_eq!([larger(1.0, 2.0), larger(2.0, 1.0)], [2.0, 2.0]);
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
    }

    /// Channel values in SIMD lanes equal the values of the converter of single states.
    #[test]
    fn values_of_a_net_are_those_of_a_trajectory() {
        use whiskmap_mechanics::shooting::FirstVariation;
        use whiskmap_mechanics::shooting::batch::Batch;
        let side = cone();
        let sheet = &side.sheet;
        let mut compared = 0;
        for row in (0..sheet.rows.len()).step_by(20) {
            let Some((states, _)) = sheet.net_row(row) else {
                continue;
            };
            let sizes = side.sizes(&sheet.crossings[row][0]);
            for [push, tau, load, values @ ..] in numbers(side.reader(), &states) {
                let exact: Vec<FirstVariation> =
                    Batch::new(Method::fine()).shoot_at(&sheet.rod, [(tau, load)]);
                let exact = side.values(row, tau, &exact[0].full, push);
                for ((found, exact), size) in values.into_iter().zip(exact).zip(sizes) {
                    assert!((found - exact).abs() < 1e-9 * size, "{row}: {found} {exact}");
                }
                compared += 1;
            }
        }
        assert!(compared > 100, "{compared}");
    }

    /// Expansions of one row at each edge are accepted; every change that contradicts the end is refused.
    #[test]
    fn expansions_that_contradict_the_end_are_refused() {
        let side = cone();
        let sheet = &side.sheet;
        for edge in [Edge::Fold, Edge::Tip] {
            let mut rows = 0..sheet.rows.len();
            let row = rows.find(|row| sheet.crossings[*row][0].edge == edge).unwrap();
            let (states, _) = sheet.net_row(row).unwrap();
            let weights = weights(&side, row);
            let sound = Chebyshev::through(&numbers(side.reader(), &states));
            let count = sound.coefficients.len();
            let accepted = |residual: f64, end: f64, change: &dyn Fn(&mut Chebyshev<FUNCTIONS>)| {
                let mut functions = sound.clone();
                change(&mut functions);
                RowExpansion::new(functions, end, &weights, residual, sheet, row)
            };
            let is_accepted = |residual, change: &dyn Fn(&mut Chebyshev<FUNCTIONS>)| {
                accepted(residual, states.end, change).is_some()
            };
            assert!(is_accepted(MOST, &|_| ()));
            let distance = sheet.rows[row].pole_distance;
            for by in [-2.0, 2.0] {
                let off = by * MOST / distance;
                assert!(!is_accepted(MOST, &|functions| functions.coefficients[0][0] += off));
            }
            let is_fold = edge == Edge::Fold;
            assert_eq!(
                is_accepted(MOST, &|functions| functions.coefficients[0][1] += 1e-6),
                is_fold
            );
            let spoil = |functions: &mut Chebyshev<FUNCTIONS>| {
                functions.coefficients[0][FUNCTIONS - 1] = f64::NAN;
            };
            assert!(!is_accepted(MOST, &spoil));
            // Coefficients end where rounding does.
            let length = |size: f64| {
                let last = weights.map(|weight| size / weight);
                let longer =
                    accepted(MOST, states.end, &|functions| functions.coefficients.push(last));
                longer.unwrap().inverse.functions.coefficients.len()
            };
            assert!(length(1e-16) <= count);
            assert_eq!(length(1e-14), count + 1);
            // Expansions that end before the fold are not flat enough.
            let shortened = |part: f64| accepted(1e-4, part * states.end, &|_| ()).is_some();
            if is_fold {
                assert_eq!([1.0, 0.9998, 0.998].map(shortened), [true, true, false]);
            }
        }
    }

    /// A row is known at either edge. It is not if its end, which is computed apart, is elsewhere.
    #[test]
    fn rows_that_contradict_their_end_are_not_known() {
        let mut side = cone();
        for edge in [Edge::Fold, Edge::Tip] {
            let mut rows = 0..side.sheet.rows.len();
            let row = rows.find(|row| side.sheet.crossings[*row][0].edge == edge).unwrap();
            let end = side.sheet.crossings[row][0].push;
            let distance = side.sheet.rows[row].pole_distance;
            let mut is_known = |off: f64| {
                side.sheet.crossings[row][0].push = end + off / distance;
                KnownRow::of(&side, &[row])[0].is_some()
            };
            let found = [-1e-4, -4e-5, -1e-5, 0.0, 1e-5, 4e-5, 1e-4].map(&mut is_known);
            assert_eq!(found, [false, false, true, true, true, false, false]);
            assert!(is_known(0.0));
        }
    }
}
