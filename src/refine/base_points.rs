//! Base points of rows: exact states along a row, relative to which an engine integrates cells as differences.
//!
//! Between them, base and pole move by about equal distances, as many as the rounding of the engine allows. The row's span gives push
//! angle and contact as functions of the row parameter `w`, and so the guesses of cells; each base point carries them as Taylor
//! polynomials around itself. A polynomial through the nearest base points corrects them, and gives the Jacobian for the one Newton step
//! of each cell.

use super::LEFT_BY_STEP;
use super::row_states::{ExactState, RowState, RowStateGoal, row_states};
use crate::engine::{
    BasePoint, BasePointAccuracy, BaseTrajectory, BatchRow, JACOBIAN_POWERS, MOST_TRAJECTORY_STEPS,
    POWERS, RESTING_POWERS, RowBatch, RowTerms, WhiskerSide,
};
use crate::numerics::expansion::{Chebyshev, chebyshev_points};
use crate::numerics::nearest_turn;
use crate::numerics::newton_form::stencil;
use crate::rod::{Rest, Rod, arclength};
use crate::sheet::{RowSpan, Sheet};
use rayon::prelude::*;

/// Number of states of the span through which a row's curve is expanded: as many as the lattice has loads.
const CURVE_POINTS: usize = 16;

/// Part of the residual bound of cells that the residual of their base point may take.
const BASE_PART: f64 = 0.01;

/// Most base points of a row.
const MOST_BASE_POINTS: usize = 32;

/// Most cells of a base point on average: one workgroup of a GPU.
const CELLS: usize = 32;

/// Motion of base and pole along a row, over the push angle and the distance of the pole: on the 29,000 rows of `morphology.toml` with at
/// least 12 of 16 base points 1.9 to 4.0, in the median 2.8. The factor allows for places where it is faster than on average. With 3.7, more
/// than a tenth of the cells of a shipped scene with an Euler spiral fell back.
const MOTION: f64 = 5.0;

/// Part by which the motion per row parameter falls from first touch to the end: on the same rows to the 1.5th to 3.2nd part.
const SLOWING: f64 = 0.62;

/// Returns the base points of each row of `batch`, `[row][base point]`, for its cells from first touch on.
///
/// A row has no base points if it has no span from first touch, or fewer cells than base points. It also has none if a trajectory takes
/// more than [`MOST_TRAJECTORY_STEPS`].
#[must_use]
pub fn base_points(batch: &RowBatch, accuracy: BasePointAccuracy) -> Vec<Vec<BasePoint>> {
    let curves = batch.rows.par_iter();
    let curves = curves.map(|row| RowCurve::new(&batch.sides[row.side], row, accuracy));
    let curves: Vec<Option<RowCurve>> = curves.collect();
    let states = curves.iter().flatten().flat_map(RowCurve::states);
    let states: Vec<RowState> = states.collect();
    let longest = (BASE_PART * accuracy.residual / LEFT_BY_STEP).sqrt();
    let goal = RowStateGoal {
        longest_step: longest,
        is_coarse_first: false,
    };
    let found = row_states(batch.method, &states, goal);
    let mut found = found.as_slice();
    let rows = curves.iter().map(|curve| {
        let found = found
            .split_off(..curve.as_ref()?.parts.len())?
            .iter()
            .copied();
        found.collect::<Option<Vec<ExactState>>>()
    });
    let rows: Vec<Option<Vec<ExactState>>> = rows.collect();
    let rows = curves.par_iter().zip(rows).map(|(curve, found)| {
        let (curve, found) = curve.as_ref().zip(found)?;
        let rod = &curve.side.sheet.rod;
        let is_short = |at: &ExactState| {
            batch.method.resolution.steps(rod, at.tau, at.load) <= MOST_TRAJECTORY_STEPS
        };
        found
            .iter()
            .all(is_short)
            .then(|| curve.base_points(&found))
    });
    rows.map(Option::unwrap_or_default).collect()
}

/// Row span from first touch to a sound end of the row.
pub struct SpanFromTouch<'a> {
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
        if !is_simple {
            return None;
        }
        let span = sheet.spans(row).into_owned().into_iter().next()?;
        let w_end = end.load * end.tau * end.tau;
        let is_whole = span.begins_at_touch() && span.reaches(w_end.abs());
        is_whole.then_some(Self {
            sheet,
            row,
            span,
            w_end,
        })
    }

    /// `[push angle in radians, tau]` at `parts` of the row parameter's end.
    fn at(&self, parts: &[f64]) -> Vec<[f64; 2]> {
        let w_end = self.w_end.abs();
        self.span.at(parts.iter().map(|part| part * w_end))
    }

    /// Approximate states at `parts` of the row parameter's end.
    pub fn states(&self, parts: &[f64]) -> impl Iterator<Item = RowState<'a>> {
        parts
            .iter()
            .zip(self.at(parts))
            .map(|(part, [_, tau])| RowState {
                sheet: self.sheet,
                row: self.row,
                w: part * self.w_end,
                tau,
            })
    }
}

/// A row from first touch to its end as a curve of states.
struct RowCurve<'a> {
    side: &'a WhiskerSide,
    row: &'a BatchRow,
    /// Signed row parameter `load tau^2` at the end.
    w_end: f64,
    /// `[magnitude of the push angle in radians, tau]` by the part of the row parameter's end.
    curve: Chebyshev<2>,
    /// Parts of the row parameter's end at the base points.
    parts: Vec<f64>,
}

impl<'a> RowCurve<'a> {
    /// The curve of `row`; `None` if the row has no span from first touch, or fewer cells than base points.
    fn new(side: &'a WhiskerSide, row: &'a BatchRow, accuracy: BasePointAccuracy) -> Option<Self> {
        let end = side.sheet.crossings[row.row].first()?;
        let magnitudes = &side.columns.magnitudes;
        let cells = magnitudes.partition_point(|push| *push < end.push);
        let count = count(&side.sheet, row.row, end.push, cells, accuracy);
        if cells <= count {
            return None;
        }
        let span = SpanFromTouch::new(&side.sheet, row.row)?;
        Some(Self {
            side,
            row,
            w_end: span.w_end,
            curve: Chebyshev::through(&span.at(chebyshev_points(CURVE_POINTS))),
            parts: parts(count),
        })
    }

    /// Approximate states at the base points.
    fn states(&self) -> impl Iterator<Item = RowState<'_>> {
        self.parts.iter().map(|part| {
            let [_, tau] = self.curve.at(*part);
            RowState {
                sheet: &self.side.sheet,
                row: self.row.row,
                w: part * self.w_end,
                tau,
            }
        })
    }

    /// Returns the base points at the states `found`, each with the cells nearest to it.
    fn base_points(&self, found: &[ExactState]) -> Vec<BasePoint> {
        let (sheet, columns) = (&self.side.sheet, &self.side.columns);
        let row = &sheet.rows[self.row.row];
        let last = sheet.crossings[self.row.row][0].push;
        let sign = sheet.side.sign();
        let parts = &self.parts;
        let curves: Vec<[RowTerms; POWERS]> = self.curve.taylor(parts);
        let values = found.iter().zip(&curves).map(|(state, curve)| {
            let [push, tau] = [sign * curve[0][0], curve[0][1]];
            let map = &state.variation.full.map;
            let exact = nearest_turn(map.pole.to_angle() - row.touch, push);
            let [[a, b], [c, d]] = [map.by_tau, map.by_load].map(|by| by.to_array());
            [exact - push, state.tau - tau, a, b, c, d]
        });
        let values: Vec<LocalTerms> = values.collect();
        let resting = RestingDirection::new(&sheet.rod, row.pole_distance);
        let mut base_points = Vec::with_capacity(values.len());
        let (mut from, mut start) = (0, 0.0);
        for (m, state) in found.iter().enumerate() {
            let (stop, until) = match parts.get(m + 1) {
                Some(next) => {
                    let middle = parts[m].midpoint(*next);
                    (middle, self.curve.at(middle)[0].min(last))
                }
                None => (1.0, last),
            };
            let farthest = f64::max(parts[m] - start, stop - parts[m]);
            start = stop;
            let to = from + columns.magnitudes[from..].partition_point(|push| *push < until);
            let cells = columns.first + from as u32..columns.first + to as u32;
            from = to;
            if cells.is_empty() {
                continue;
            }
            let ExactState {
                tau,
                load,
                variation,
                ..
            } = *state;
            let (local, errors) = through_nearest(parts, &values, m, farthest);
            let mut curve = curves[m].map(|[push, tau]| [sign * push, tau]);
            for (own, [push, tau, ..]) in curve.iter_mut().zip(&local) {
                *own = [own[0] + push, own[1] + tau];
            }
            let [push, _] = curve[0];
            base_points.push(BasePoint {
                // Sides of a group are few.
                rod: self.row.side as u32,
                tau,
                load,
                push,
                residual: state.residual,
                state: variation,
                load_per_w: self.w_end / (tau * tau),
                row: curve,
                jacobian: local.map(|[_, _, jacobian @ ..]| jacobian),
                jacobian_error: jacobian_error(&sheet.rod, state, errors),
                resting: resting.around(variation.full.position.length()),
                distance_unit: resting.unit,
                cells,
                trajectory: BaseTrajectory::default(),
            });
        }
        base_points
    }
}

/// Number of base points of `row` of `sheet`: as motion up to `push`, the magnitude at its end, and the number of `cells` demand.
fn count(sheet: &Sheet, row: usize, push: f64, cells: usize, accuracy: BasePointAccuracy) -> usize {
    let row = &sheet.rows[row];
    let motion = MOTION * push * row.pole_distance;
    let each = 2.0 * accuracy.motion * (2.0 * row.contact).min(1.0);
    let by_motion = (motion / each).ceil() as usize;
    by_motion
        .max(cells / CELLS)
        .clamp(accuracy.least, MOST_BASE_POINTS)
}

/// Parts of the row parameter's end at `count` base points with equal motion between them: the motion slows down along a row.
fn parts(count: usize) -> Vec<f64> {
    let at_end = 1.0 - 0.5 * SLOWING;
    let part = |i: usize| {
        let moved = at_end * (i as f64 + 0.5) / count as f64;
        2.0 * moved / (1.0 + (1.0 - 2.0 * SLOWING * moved).sqrt())
    };
    (0..count).map(part).collect()
}

/// Numbers that are interpolated between base points: corrections of push angle and `tau` of the curve, and the Jacobian.
type LocalTerms = [f64; 6];

/// Taylor polynomial around the base point `m` of those at `parts`, through the `values` at the nearest ones, and the size of its last
/// term in Newton's form up to `farthest` from there.
fn through_nearest(
    parts: &[f64],
    values: &[LocalTerms],
    m: usize,
    farthest: f64,
) -> ([LocalTerms; JACOBIAN_POWERS], LocalTerms) {
    let from = stencil(m, JACOBIAN_POWERS, values.len());
    let count = JACOBIAN_POWERS.min(values.len());
    let mut nearest: [usize; JACOBIAN_POWERS] = std::array::from_fn(|i| from + i);
    let apart = |i: &usize| (parts[*i] - parts[m]).abs();
    nearest[..count].sort_unstable_by(|a, b| apart(a).total_cmp(&apart(b)));
    let nodes = nearest.map(|i| parts.get(i).map_or(0.0, |part| part - parts[m]));
    let mut differences = nearest.map(|i| values.get(i).copied().unwrap_or_default());
    for level in 1..count {
        for i in (level..count).rev() {
            let apart = nodes[i] - nodes[i - level];
            differences[i] = std::array::from_fn(|term| {
                (differences[i][term] - differences[i - 1][term]) / apart
            });
        }
    }
    let mut terms = [LocalTerms::default(); JACOBIAN_POWERS];
    for i in (0..count).rev() {
        for power in (0..count).rev() {
            let lower = power.checked_sub(1).map(|lower| terms[lower]);
            for (term, value) in terms[power].iter_mut().enumerate() {
                *value =
                    lower.map_or(differences[i][term], |lower| lower[term]) - nodes[i] * *value;
            }
        }
    }
    let product = nodes[..count - 1].iter().map(|node| farthest + node.abs());
    let product: f64 = product.product();
    let last = differences[count - 1].map(|difference| (difference * product).abs());
    (terms, last)
}

/// Bound on the error of the Jacobian from the errors of its derivatives beside `state` on `rod`, for steps in units of the contact's
/// arclength and of the load's scale.
fn jacobian_error(rod: &Rod, state: &ExactState, errors: LocalTerms) -> f64 {
    let s = arclength(rod, state.tau);
    let per_load = state.load.abs() + 1.0 / (s * s);
    let [_, _, tau_x, tau_y, load_x, load_y] = errors;
    let between = s * tau_x.hypot(tau_y) + per_load * load_x.hypot(load_y);
    between + state.jacobian_error
}

/// Least half interval of distances, in distances of the pole.
const LEAST_INTERVAL: f64 = 0.01;

/// Direction of the resting whisker's point at a distance from the base, for the distances at which a contact with a pole can be.
struct RestingDirection {
    from: f64,
    /// Length of the interval of distances, in whisker lengths.
    unit: f64,
    /// Direction in radians by the part of the interval; `None` for a straight whisker.
    direction: Option<Chebyshev<1>>,
}

impl RestingDirection {
    /// Expands the direction on `rod` for a pole's centre at `pole_distance` from the base.
    fn new(rod: &Rod, pole_distance: f64) -> Self {
        // The rounding of a distance is small beside the interval, however thin the pole is.
        let radius = rod.pole.abs().max(LEAST_INTERVAL * pole_distance);
        let is_straight = rod.bend == 0.0 && rod.spiral.is_none();
        let mut resting = Self {
            from: pole_distance - radius,
            unit: 2.0 * radius,
            direction: None,
        };
        if is_straight {
            return resting;
        }
        let rest = Rest::new(rod);
        let mut before = 0.0;
        let directions = chebyshev_points(RESTING_POWERS).iter().map(|part| {
            let distance = resting.unit.mul_add(*part, resting.from);
            before = nearest_turn(rest.point_at_distance(distance).to_angle(), before);
            [before]
        });
        resting.direction = Some(Chebyshev::through(&directions.collect::<Vec<_>>()));
        resting
    }

    /// Taylor polynomial around `distance`, in units of the interval.
    fn around(&self, distance: f64) -> [f64; RESTING_POWERS] {
        let Some(direction) = &self.direction else {
            return [0.0; RESTING_POWERS];
        };
        let part = (distance - self.from) / self.unit;
        let terms = direction.taylor(&[part]).pop().unwrap_or_default();
        terms.map(|[term]| term)
    }
}
