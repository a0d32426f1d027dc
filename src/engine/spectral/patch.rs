//! Patches: the expansions of many rows of one whisker side as a tensor.

use super::certificate::{Check, MARGIN, bounds};
use super::exact_row::ExactRow;
use super::expansion_tail::ExpansionTail;
use super::patch_size::PatchSize;
use super::row::{FUNCTIONS, RowExpansion, Weights, larger, value_weights};
use super::row_interval::RowInterval;
use crate::engine::WhiskerSide;
use crate::numerics::expansion::{Chebyshev, chebyshev_points};
use crate::numerics::tensor::ChebyshevTensor;
use crate::shooting::batch::Method;

/// Patch: certified expansions of all rows of an interval.
#[derive(Clone, Debug)]
pub struct Patch {
    interval: RowInterval,
    tensor: ChebyshevTensor<FUNCTIONS>,
    weights: Weights,
    residual: f64,
    /// Maximum bound on the residual.
    most: f64,
}

/// Places of the certificate in each direction: between the Chebyshev points of every size.
const CHECKS: usize = 8;

impl Patch {
    /// Computes the states of `size` and certifies the expansions through them.
    ///
    /// # Errors
    /// If the bound exceeds `most`, in whisker lengths, the size that is expected to be accurate enough; `None` if there is none, or if a
    /// state is not found.
    pub fn new(
        method: Method,
        side: &WhiskerSide,
        interval: RowInterval,
        size: PatchSize,
        most: f64,
    ) -> Result<Self, Option<PatchSize>> {
        let parts = chebyshev_points(size.rows);
        let rows = interval.rows(method, &side.sheet, parts);
        let sheet = side.sheet.with_rows(rows).ok_or(None)?;
        let all: Vec<usize> = (0..size.rows).collect();
        let found = ExactRow::all(method, &sheet, &all, size.states, most);
        let found: Option<Vec<ExactRow>> = found.into_iter().collect();
        let found = found.ok_or(None)?;
        let is_apart = |row: &ExactRow| row.end.edge != interval.edge;
        if found.iter().any(is_apart) {
            return Err(None);
        }
        let expansions: Vec<Chebyshev<FUNCTIONS>> =
            found.iter().map(|row| row.expansion(side)).collect();
        let weights: Vec<Weights> = found.iter().map(|row| row.weights(side)).collect();
        let weights = weights.iter().fold([0.0; FUNCTIONS], |most, row| {
            std::array::from_fn(|i| f64::max(most[i], row[i]))
        });
        let tensor = ChebyshevTensor::through(&expansions);
        let along = expansions
            .iter()
            .map(|row| ExpansionTail::new(&row.tails(), &weights));
        let from_row_to_row = ExpansionTail::new(&tensor.tails_in_x(), &weights);
        let along = along.reduce(ExpansionTail::larger).ok_or(None)?;
        let error = larger(from_row_to_row.last, along.last);
        let mut patch = Self {
            interval,
            tensor,
            weights,
            residual: error,
            most,
        };
        let mut enough = size.enough([from_row_to_row, along], most);
        if MARGIN * error <= most {
            patch.residual = patch.certified(method, side);
            if patch.residual <= most {
                return Ok(patch);
            }
            // Between the states, the error is larger than the last coefficients.
            enough = size.larger();
        }
        Err(enough)
    }

    /// Bound on the residual from trajectories between the states.
    fn certified(&self, method: Method, side: &WhiskerSide) -> f64 {
        // Even parts of the interval are not Chebyshev points.
        let places: [f64; CHECKS] = std::array::from_fn(|i| (i as f64 + 0.37) / CHECKS as f64);
        let rows = self.interval.rows(method, &side.sheet, &places);
        let expansions = places.map(|place| self.tensor.at(place));
        let checks = rows.iter().zip(&expansions).map(|(row, functions)| Check {
            row: *row,
            functions,
            weights: &self.weights,
            places: &places,
        });
        let bounds = bounds(
            method,
            side,
            &checks.collect::<Vec<_>>(),
            &[self.residual; CHECKS],
        );
        bounds.into_iter().fold(0.0, larger)
    }

    /// Returns the number of states along a row.
    pub const fn states(&self) -> usize {
        self.tensor.in_y.len()
    }

    /// Returns the expansions of `row` of `side` in the patch. `None` if the row is outside the interval, contradicts its end, or has
    /// values so small that the bound is too large for them. At the ends of the interval there is no row with states.
    pub fn row(&self, side: &WhiskerSide, row: usize) -> Option<RowExpansion> {
        let sheet = &side.sheet;
        let (edge, coordinate) = RowInterval::coordinate(sheet, row)?;
        let [from, to] = self.interval.ends;
        let part = (coordinate - from) / (to - from);
        let is_inside = edge == self.interval.edge && (0.0..=1.0).contains(&part);
        let end = &sheet.crossings[row][0];
        let own = value_weights(side, end);
        let mut weights = own.iter().zip(&self.weights[FUNCTIONS - own.len()..]);
        let is_large = weights.all(|(own, weight)| self.residual * own <= self.most * weight);
        let expansion = (is_inside && is_large).then(|| self.tensor.at(part))?;
        RowExpansion::new(expansion, &self.weights, self.residual, sheet, row)
    }
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]
pub(super) mod tests {
    use super::super::sheet::MOST;
    use super::*;
    use crate::engine::{FORCE, SideColumns};
    use crate::refine::GOAL;
    use crate::rod::Side;
    use crate::scene::Scene;
    use crate::sheet::{Edge, Sheet};
    use std::sync::Arc;

    /// Error of a coefficient, as a part of the largest coefficient of its function.
    const SPOIL: f64 = 1e-6;

    /// Coefficients between two spoiled ones: coprime to the sizes, so that all functions and all powers are among them.
    const STRIDE: usize = 5;

    /// The cone of the paper with more rows at the tip than its map has.
    pub fn cone() -> WhiskerSide {
        let scene = Scene::parse(include_str!("../../../scenes/cone.toml"), "cone.toml").unwrap();
        let swept = scene.whisker(0);
        let columns = Arc::new(SideColumns::new(&[1.0, 2.0], Side::Cb, 0));
        let (rod, units) = (swept.rod(columns.side), swept.whisker.units());
        let distances: Vec<f64> = (0..200).map(|i| 0.4 + 0.003 * f64::from(i)).collect();
        let sheet = Sheet::new(Method::fine(), &rod, columns.side, &distances);
        WhiskerSide::new(columns, units, sheet)
    }

    /// The interval of all rows that end at `edge`.
    fn interval(side: &WhiskerSide, edge: Edge) -> RowInterval {
        let rows = 0..side.sheet.rows.len();
        let places = rows.filter_map(|row| RowInterval::coordinate(&side.sheet, row));
        let own = places.filter(|(own, _)| *own == edge);
        let ends = own.fold([f64::INFINITY, -f64::INFINITY], |[from, to], (_, at)| {
            [from.min(at), to.max(at)]
        });
        RowInterval { edge, ends }
    }

    /// A single wrong coefficient of any power of any function exceeds the bound, although all others decay. With NaN there is no bound.
    #[test]
    fn a_spoiled_coefficient_is_refused() {
        let (method, side) = (Method::fine(), cone());
        for edge in [Edge::Fold, Edge::Tip] {
            let size = PatchSize {
                rows: 24,
                states: 32,
            };
            let sound = Patch::new(method, &side, interval(&side, edge), size, MOST);
            let sound = sound.unwrap_or_else(|_| panic!("{edge:?}: refused"));
            assert!(sound.certified(method, &side) <= 4.0 * sound.residual);
            let largest = sound.tensor.in_y.iter().flat_map(|own| &own.coefficients);
            let largest = largest.fold([0.0; FUNCTIONS], |most, own| {
                std::array::from_fn(|i| f64::max(most[i], own[i].abs()))
            });
            let all = size.rows * size.states * FUNCTIONS;
            for place in (0..all).step_by(STRIDE) {
                let (power, function) = (place / FUNCTIONS, place % FUNCTIONS);
                let (in_y, in_x) = (power / size.rows, power % size.rows);
                let mut patch = sound.clone();
                patch.tensor.in_y[in_y].coefficients[in_x][function] += SPOIL * largest[function];
                let bound = patch.certified(method, &side);
                patch.tensor.in_y[in_y].coefficients[in_x][function] = f64::NAN;
                let without = patch.certified(method, &side);
                assert!(
                    bound > MOST && without.is_nan(),
                    "{edge:?}: function {function}, powers {in_x} and {in_y}: {bound:e}"
                );
            }
        }
    }

    /// The bound is four times the largest error: of the pole's place, of a channel value, or of the last coefficients.
    #[test]
    fn a_bound_is_four_times_the_largest_error() {
        let (method, side) = (Method::fine(), cone());
        let at = |row: usize| RowInterval::coordinate(&side.sheet, row).unwrap().1;
        let interval = RowInterval {
            edge: Edge::Fold,
            ends: [at(0), at(60)],
        };
        let size = PatchSize {
            rows: 16,
            states: 32,
        };
        let sound = Patch::new(method, &side, interval, size, MOST);
        let sound = sound.unwrap_or_else(|_| panic!("refused"));
        assert!(sound.row(&side, 60).is_some() && sound.row(&side, 61).is_none());
        let spoiled = |function: usize| {
            let mut patch = sound.clone();
            patch.tensor.in_y[0].coefficients[0][function] += SPOIL;
            patch.certified(method, &side)
        };
        let [near, far] = [0, 60].map(|row| side.sheet.rows[row].pole_distance);
        let by_push = spoiled(0) / (MARGIN * SPOIL);
        assert!(by_push > near && by_push < 1.1 * far, "{by_push}");
        let by_force = spoiled(3 + FORCE) / (4.0 * SPOIL * sound.weights[3 + FORCE]);
        assert!((by_force - 1.0).abs() < 1e-3, "{by_force}");
        // From row to row, the third polynomial is large at the middle places and small at the last one.
        let mut patch = sound.clone();
        patch.tensor.in_y[0].coefficients[3][3 + FORCE] += SPOIL;
        let by_third = patch.certified(method, &side) / (4.0 * SPOIL * sound.weights[3 + FORCE]);
        assert!((0.9..1.0).contains(&by_third), "{by_third}");
        let with = |residual: f64| {
            let patch = Patch {
                residual,
                ..sound.clone()
            };
            patch.certified(method, &side)
        };
        assert_eq!(with(1e-6), 4e-6);
        assert!((GOAL..1e-11).contains(&with(0.0)), "{}", with(0.0));
    }
}
