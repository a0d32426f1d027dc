//! Map of the readings that determine a contact: stable states over distance and push, with the number of states that share their numbers.

use super::levers::PAIRS;
use super::newton::{Triangle, base_derivatives};
use super::{BaseReading, Locator};
use crate::scene::{Grid, Pole, Whisker};
use crate::trace::{StableBranch, StateAtPush, row};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::FirstVariation;
use whiskmap_mechanics::shooting::batch::Batch;

row! {
    /// Stable state of a map, with the number of stable states that have the same two numbers at the base.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct SharedState {
        pub distance_mm: f64,
        pub side: Side,
        pub push_angle_deg: f64,
        pub arc_length_mm: f64,
        /// Number of states with this moment and axial force; 0 if one follows from the other.
        pub moment_x_states: usize,
        /// Condition of the contact by moment and axial force.
        pub moment_x_condition: Option<f64>,
        /// Number of states with this moment and transverse force; 0 if one follows from the other.
        pub moment_y_states: usize,
        /// Condition of the contact by moment and transverse force.
        pub moment_y_condition: Option<f64>,
        /// Number of states with this axial and transverse force; 0 if one follows from the other.
        pub force_states: usize,
        /// Condition of the contact by axial and transverse force.
        pub force_condition: Option<f64>,
    }
}

/// Map of the stable states on a grid of distances and push angles, with the lines on which two numbers do not determine them.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedMap {
    /// States of the cells in contact, distance by distance: `[state]`.
    pub states: Vec<SharedState>,
    /// Segments of the singular lines of moment and axial force, moment and transverse force, and both forces: `[pair][segment][end]`, each end
    /// as `[push angle (deg), distance (mm)]`.
    pub singular: [Vec<[[f64; 2]; 2]>; 3],
}

/// Indices in [`PAIRS`] of the pairs of a [`SharedState`], in its order: moment and axial force, moment and transverse force, both forces.
const ORDER: [usize; 3] = [1, 0, 2];

/// Cell of a map in contact.
struct ContactCell {
    row: usize,
    column: usize,
    side: Side,
    arc_length_mm: f64,
    reading: BaseReading,
    /// Condition by each pair of numbers in the [`ORDER`] of states, with the sign of the Jacobian's determinant; `None` if one number follows from the other.
    conditions: [Option<f64>; 3],
}

impl Locator {
    /// Returns the stable states at the distances and push angles of `grid`. `whisker` and `pole` are the locator's. First touch, and cells that
    /// the whisker does not reach or has left, have no state.
    #[must_use]
    pub fn shared_states(&self, whisker: &Whisker, pole: &Pole, grid: &Grid) -> SharedMap {
        let pole = &Pole::smooth(pole.radius_mm);
        let rows = (0..grid.distance_mm.len()).into_par_iter();
        let cells: Vec<ContactCell> = rows
            .flat_map_iter(|row| {
                let sides = Side::BOTH.into_iter();
                sides.flat_map(move |side| self.cells(whisker, pole, grid, (row, side)))
            })
            .collect();
        let counts = ORDER.map(|pair| self.counts(&cells, pair));
        let states = cells.iter().enumerate().map(|(i, cell)| {
            let shared = |pair: usize| cell.conditions[pair].map_or(0, |_| counts[pair][i]);
            let condition = |pair: usize| cell.conditions[pair].map(f64::abs);
            SharedState {
                distance_mm: grid.distance_mm[cell.row],
                side: cell.side,
                push_angle_deg: grid.push_angle_deg[cell.column],
                arc_length_mm: cell.arc_length_mm,
                moment_x_states: shared(0),
                moment_x_condition: condition(0),
                moment_y_states: shared(1),
                moment_y_condition: condition(1),
                force_states: shared(2),
                force_condition: condition(2),
            }
        });
        SharedMap {
            states: states.collect(),
            singular: [0, 1, 2].map(|pair| singular(grid, &cells, pair)),
        }
    }

    /// Returns the cells in contact of a row on one side, in the order of growing push angles.
    fn cells(
        &self,
        whisker: &Whisker,
        pole: &Pole,
        grid: &Grid,
        (row, side): (usize, Side),
    ) -> Vec<ContactCell> {
        let Ok(branch) = StableBranch::new(whisker, pole, side, grid.distance_mm[row]) else {
            return Vec::new();
        };
        let columns = grid.push_angle_deg.iter().enumerate();
        let columns = columns.filter(|(_, push_deg)| side.sign() * **push_deg > 0.0);
        let states: Vec<(usize, StateAtPush)> = columns
            .filter_map(|(column, push_deg)| {
                let state = branch.state(push_deg.to_radians()).ok()?;
                Some((column, state))
            })
            .collect();
        let sheet_grid = &self.sides[usize::from(side == Side::Cb)];
        let points = states.iter().map(|(_, state)| state.point);
        let variations: Vec<FirstVariation> =
            Batch::new(self.method).shoot_at(&sheet_grid.rod, points);
        let cell = |((column, state), here): (&(usize, StateAtPush), FirstVariation)| {
            let columns = base_derivatives(&sheet_grid.rod, state.point, &here);
            let condition = |pair: usize| {
                let [one, other] = PAIRS[pair];
                let measured = DVec3::from(
                    [0, 1, 2].map(|number| f64::from(u8::from(number == one || number == other))),
                );
                let [by_contact, by_load] = columns;
                let det = by_contact[one] * by_load[other] - by_contact[other] * by_load[one];
                let condition = Triangle::new(columns.map(|column| measured * column)).condition();
                sheet_grid.is_determined(pair).then_some(condition.copysign(det))
            };
            let reading = branch.read(state);
            ContactCell {
                row,
                column: *column,
                side,
                arc_length_mm: reading.arc_length_mm,
                reading: BaseReading {
                    moment_nnm: Some(reading.base_moment_nnm),
                    force_x_un: Some(reading.base_force_x_un),
                    force_y_un: Some(reading.base_force_y_un),
                    angle_deg: None,
                },
                conditions: ORDER.map(condition),
            }
        };
        states.iter().zip(variations).map(cell).collect()
    }

    /// Returns the number of states that share a pair of numbers of each of the `cells`, by the index of the pair in [`PAIRS`]: `[cell]`.
    fn counts(&self, cells: &[ContactCell], pair: usize) -> Vec<usize> {
        let readings = cells.iter().map(|cell| {
            let mut reading = cell.reading;
            let numbers =
                [&mut reading.moment_nnm, &mut reading.force_x_un, &mut reading.force_y_un];
            let others = numbers.into_iter().enumerate();
            for (_, number) in others.filter(|(number, _)| !PAIRS[pair].contains(number)) {
                *number = None;
            }
            reading
        });
        let located = self.locate(&readings.collect::<Vec<_>>(), None);
        let rows = located.chunk_by(|one, other| one.reading == other.reading);
        rows.map(|rows| rows[0].states).collect()
    }
}

/// Returns the segments of the singular line of a pair of numbers, by its index in [`ORDER`]: in each square of four neighbouring cells, the line on which the inverse of
/// the signed condition, linear between the cells, is 0.
fn singular(grid: &Grid, cells: &[ContactCell], pair: usize) -> Vec<[[f64; 2]; 2]> {
    let columns = grid.push_angle_deg.len();
    let mut inverses = vec![None; columns * grid.distance_mm.len()];
    for cell in cells {
        let inverse = cell.conditions[pair].map(|condition| (cell.side, 1.0 / condition));
        inverses[cell.row * columns + cell.column] = inverse;
    }
    let mut segments = Vec::new();
    for row in 1..grid.distance_mm.len() {
        for column in 1..columns {
            // The corners of the square, one after the other around it.
            let corners =
                [[row - 1, column - 1], [row - 1, column], [row, column], [row, column - 1]];
            let known = corners.map(|[row, column]| inverses[row * columns + column]);
            let [Some((side, _)), ..] = known else {
                continue;
            };
            let known = known.map(|inverse| inverse.filter(|(other, _)| *other == side));
            let mut ends = (0..4).filter_map(|i| {
                let next = (i + 1) % 4;
                let [from, to] = [known[i]?.1, known[next]?.1];
                let place = |[row, column]: [usize; 2]| {
                    DVec2::new(grid.push_angle_deg[column], grid.distance_mm[row])
                };
                let [start, end] = [corners[i], corners[next]].map(place);
                let is_crossed = (from < 0.0) != (to < 0.0);
                is_crossed.then(|| start.lerp(end, from / (from - to)).to_array())
            });
            while let (Some(one), Some(other)) = (ends.next(), ends.next()) {
                segments.push([one, other]);
            }
        }
    }
    segments
}
