//! Map of the readings that determine a contact: stable states over distance and push, with the number of states that share their numbers.

use super::{BaseReading, LocatedState, Locator};
use crate::scene::{Pole, Whisker};
use crate::trace::{Branch, BranchPoint, row};
use rayon::prelude::*;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

/// Number of distances of a map.
const DISTANCES: u32 = 32;

/// Number of points along a branch, of which the stable ones are in the map.
const POINTS: usize = 48;

row! {
    /// Stable state of a map, with the number of stable states that have the same two numbers at the base.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct SharedState {
        /// Distance from the base to the contact at first touch, in mm.
        pub distance_mm: f64,
        /// Side of the whisker that the pole is on: cb (convex) or cf (concave).
        pub side: Side,
        /// Rotation of the base since first touch, in degrees: positive CB, negative CF.
        pub push_angle_deg: f64,
        /// Arclength from the base to the contact, in mm.
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

impl Locator {
    /// Returns the stable states of `whisker` at `pole`, those of the locator, at 32 distances between `from_mm` and `to_mm`, `[state]`. Distances
    /// out of reach, and first touch, have no state.
    #[must_use]
    pub fn shared_states(
        &self,
        whisker: &Whisker,
        pole: &Pole,
        [from_mm, to_mm]: [f64; 2],
    ) -> Vec<SharedState> {
        let distance =
            |i: u32| from_mm + (to_mm - from_mm) * f64::from(i) / f64::from(DISTANCES - 1);
        let places = (0..DISTANCES).flat_map(|i| Side::BOTH.map(|side| (distance(i), side)));
        let states = |(distance_mm, side): (f64, Side)| {
            let branch = Branch::new(whisker, &Pole::smooth(pole.radius_mm), side, distance_mm);
            let points = branch.and_then(|branch| branch.points(POINTS));
            points.unwrap_or_default()
        };
        let places: Vec<(f64, Side)> = places.collect();
        let states = places.into_par_iter().flat_map_iter(states);
        let is_inside = |state: &BranchPoint| state.stable && state.mark.is_none();
        let states: Vec<BranchPoint> = states.filter(is_inside).collect();
        let [moment_x, moment_y, force] = [
            [true, true, false],
            [true, false, true],
            [false, true, true],
        ]
        .map(|measured| self.shared(&states, measured));
        let rows = states
            .iter()
            .zip(moment_x)
            .zip(moment_y.into_iter().zip(force));
        let row =
            |((state, moment_x), (moment_y, force)): ((&BranchPoint, Shared), (Shared, Shared))| {
                SharedState {
                    distance_mm: state.distance_mm,
                    side: state.side,
                    push_angle_deg: state.push_angle_deg,
                    arc_length_mm: state.arc_length_mm,
                    moment_x_states: moment_x.0,
                    moment_x_condition: moment_x.1,
                    moment_y_states: moment_y.0,
                    moment_y_condition: moment_y.1,
                    force_states: force.0,
                    force_condition: force.1,
                }
            };
        rows.map(row).collect()
    }

    /// Returns the number of states with the `measured` numbers of each of the `states`, and the condition of the state, `[state]`.
    fn shared(&self, states: &[BranchPoint], measured: [bool; 3]) -> Vec<Shared> {
        let [moment, x, y] = measured;
        let reading = |state: &BranchPoint| BaseReading {
            moment_nnm: moment.then_some(state.base_moment_nnm),
            force_x_un: x.then_some(state.base_force_x_un),
            force_y_un: y.then_some(state.base_force_y_un),
            angle_deg: None,
        };
        let readings: Vec<BaseReading> = states.iter().map(reading).collect();
        let located = self.locate(&readings, None);
        let rows = located.chunk_by(|one, other| one.reading == other.reading);
        let of_state = |(state, rows): (&BranchPoint, &[LocatedState])| {
            let off = |row: &&LocatedState| {
                let push = row
                    .push_angle_deg
                    .map(|own| (own - state.push_angle_deg).abs());
                let is_other = row.side != Some(state.side);
                (is_other, push.unwrap_or(f64::INFINITY))
            };
            let nearest = rows.iter().min_by(|one, other| {
                let [one, other] = [off(one), off(other)];
                one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
            });
            let nearest = nearest.copied();
            (rows[0].states, nearest.and_then(|row| row.condition))
        };
        states.iter().zip(rows).map(of_state).collect()
    }
}

/// Number of states with the same numbers, and the condition of a state.
type Shared = (usize, Option<f64>);
