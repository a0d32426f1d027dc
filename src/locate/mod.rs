//! Contacts from moment and force at the base: the inverse problem of a sensor that holds the whisker.
//!
//! Two of moment, axial force and transverse force determine contact and load, except where their Jacobian is singular; there may be
//! several states, or none. All stable states with the measured numbers are returned, each with the condition of the inverse and the
//! standard deviations that follow from the sensor's standard deviations. With all three numbers, the state nearest to them is returned.

mod grid;
mod levers;
mod map;
mod newton;
mod readings;
mod search;

pub use map::{SharedMap, SharedState};
pub use readings::{BaseReadings, MOST_ANGLE, MOST_LOAD};

use crate::scene::{Pole, Whisker};
use crate::trace::{StateRow, row};
use glam::DVec2;
use grid::SheetGrid;
use newton::{Triangle, by_logarithms};
use rayon::prelude::*;
use search::{FoundState, Wanted};
use serde::Serialize;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::{RodDerivative, Side, Units};
use whiskmap_mechanics::shooting::Resolution;
use whiskmap_mechanics::shooting::batch::Method;

/// Numbers of a sensor at the base. A state needs two of moment and forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BaseReading {
    /// Moment of the pole on the base, in nN m, positive if it turns the base to the left; `None` if it was not measured.
    pub moment_nnm: Option<f64>,
    /// Force of the pole on the base along the base's tangent, in uN; `None` if it was not measured.
    pub force_x_un: Option<f64>,
    /// Force of the pole on the base to the left of its tangent, in uN; `None` if it was not measured.
    pub force_y_un: Option<f64>,
    /// Angle of the base's tangent in the laboratory, in degrees; `None` if it was not measured.
    pub angle_deg: Option<f64>,
}

/// Standard deviations of a sensor, of which the errors are independent and normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorDeviations {
    /// Standard deviation of the moment, in nN m; positive.
    pub moment_nnm: f64,
    /// Standard deviation of each component of the force, in uN; positive.
    pub force_un: f64,
}

/// Reason why a reading has no state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoLocation {
    /// The reading has fewer than two numbers of the base.
    Incomplete,
    /// All numbers of the reading are 0: the whisker is free, or only touches.
    NoLoad,
    /// One of the two numbers follows from the other, as moment and axial force of a cylinder do.
    Undetermined,
    /// No stable state has these numbers.
    NoState,
}

row! {
    /// Stable state with the numbers of a reading. A reading without such a state has one row with the reason.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct LocatedState of a state {
        /// Number of the reading, from 1.
        pub reading: usize,
        /// Number of stable states with the numbers of the reading.
        pub states: usize,
        pub side: Option<Side>,
        pub arc_length_mm: Option<f64> = place,
        /// Position of the contact along the base's tangent, in mm.
        pub contact_x_mm: Option<f64>,
        /// Position of the contact to the left of the base's tangent, in mm.
        pub contact_y_mm: Option<f64>,
        pub contact_angle_deg: Option<f64> = place,
        /// Position of the pole's centre along the base's tangent, in mm.
        pub pole_x_mm: Option<f64>,
        /// Position of the pole's centre to the left of the base's tangent, in mm.
        pub pole_y_mm: Option<f64>,
        pub distance_mm: Option<f64>,
        pub push_angle_deg: Option<f64>,
        pub force_un: Option<f64> = load,
        pub contact_force_un: Option<f64> = load,
        pub base_moment_nnm: Option<f64> = load,
        pub base_force_x_un: Option<f64> = load,
        pub base_force_y_un: Option<f64> = load,
        /// Difference of the state's numbers from the reading: over the reading's size, or in standard deviations if these are given.
        pub misfit: Option<f64>,
        /// Largest over smallest change of the measured numbers for equal relative changes of the contact's arclength and the load f/rho^2; infinite on a singular line.
        pub condition: Option<f64>,
        /// Standard deviation of the arclength of the contact, in mm.
        pub arc_length_sd_mm: Option<f64>,
        /// Standard deviation of the distance, in mm.
        pub distance_sd_mm: Option<f64>,
        /// Standard deviation of the push angle, in degrees.
        pub push_angle_sd_deg: Option<f64>,
        /// Standard deviation of the force between pole and whisker, in uN.
        pub force_sd_un: Option<f64>,
        /// Position of the contact along the laboratory's first axis, from the base, in mm; with the angle of the base.
        pub lab_contact_x_mm: Option<f64>,
        /// Position of the contact along the laboratory's second axis, from the base, in mm; with the angle of the base.
        pub lab_contact_y_mm: Option<f64>,
        /// Position of the pole's centre along the laboratory's first axis, from the base, in mm; with the angle of the base.
        pub lab_pole_x_mm: Option<f64>,
        /// Position of the pole's centre along the laboratory's second axis, from the base, in mm; with the angle of the base.
        pub lab_pole_y_mm: Option<f64>,
        /// Reason of a reading without a state: incomplete, no-load, undetermined or no-state.
        pub reason: Option<NoLocation>,
    }
}

/// Number of intervals between points of the resting whisker.
const POINTS_AT_REST: u32 = 200;

/// Number of readings that are solved together.
const READINGS_AT_ONCE: usize = 64;

/// Locator: finds the stable states of one whisker and pole by the numbers at the base.
pub struct Locator {
    sides: [SheetGrid; 2],
    units: Units,
    method: Method,
}

/// Returns one line for readings without a state; `None` without such readings.
#[must_use]
pub fn warning(located: &[LocatedState]) -> Option<String> {
    let without = located.iter().filter(|row| row.reason.is_some()).count();
    let all = located.last().map_or(0, |row| row.reading);
    (without > 0)
        .then(|| format!("{without} of {all} readings have no state, for the reasons in the table"))
}

impl Locator {
    /// Creates the locator of `whisker` at `pole`, whose friction is left out. Contacts are searched from a thousandth of the
    /// length to the tip.
    #[must_use]
    pub fn new(whisker: &Whisker, pole: &Pole) -> Self {
        let method = Method::new(Resolution::FINE);
        let pole = Pole::smooth(pole.radius_mm);
        let units = whisker.units();
        let grid = |side| SheetGrid::new(method, whisker.rod(&pole, side), side, units);
        Self { sides: Side::BOTH.map(grid), units, method }
    }

    /// Returns points of the resting whisker in the frame of the base, evenly spaced from base to tip, `[point][x, y]` in mm.
    #[must_use]
    pub fn at_rest_mm(&self) -> Vec<[f64; 2]> {
        let [SheetGrid { rest, .. }, _] = &self.sides;
        let place = |i: u32| rest.end() * f64::from(i) / f64::from(POINTS_AT_REST);
        let points = (0..=POINTS_AT_REST).map(|i| rest.at_arclength(place(i)).0);
        points.map(|at| (at * self.units.length_mm).to_array()).collect()
    }

    /// Finds all stable states for each of the `readings`, in their order. The states of a reading are sorted by growing push angle. Each
    /// reading has at least one row.
    #[must_use]
    pub fn locate(
        &self,
        readings: &[BaseReading],
        deviations: Option<SensorDeviations>,
    ) -> Vec<LocatedState> {
        self.locate_until(readings, deviations, &AtomicBool::new(false))
    }

    /// Finds states as [`Locator::locate`] does. If `cancel` is true, the function soon returns, without the rows of further readings.
    #[must_use]
    pub fn locate_until(
        &self,
        readings: &[BaseReading],
        deviations: Option<SensorDeviations>,
        cancel: &AtomicBool,
    ) -> Vec<LocatedState> {
        let chunks = readings.par_chunks(READINGS_AT_ONCE).enumerate();
        let located = chunks.flat_map_iter(|(chunk, readings)| {
            let readings = match cancel.load(Ordering::Relaxed) {
                true => &[],
                false => readings,
            };
            let wanted: Vec<Wanted> =
                readings.iter().map(|reading| self.wanted(reading, deviations)).collect();
            let found = self.solve(&wanted, deviations.is_some());
            let first = chunk * READINGS_AT_ONCE + 1;
            let rows = wanted.iter().zip(found).enumerate();
            let rows = rows.flat_map(|(i, (wanted, found))| {
                self.rows(first + i, wanted, deviations.is_some(), &found)
            });
            rows.collect::<Vec<_>>()
        });
        located.collect()
    }

    /// Returns the rows of the reading with this `number`.
    fn rows(
        &self,
        number: usize,
        wanted: &Wanted,
        has_deviations: bool,
        found: &[FoundState],
    ) -> Vec<LocatedState> {
        let reason = wanted.reason.unwrap_or(NoLocation::NoState);
        let without = LocatedState::without(number, reason);
        if found.is_empty() {
            return vec![without];
        }
        let states = found.iter().map(|state| LocatedState {
            states: found.len(),
            ..self.row(without, wanted, has_deviations, state)
        });
        let mut rows: Vec<LocatedState> = states.collect();
        let push = |row: &LocatedState| row.push_angle_deg.unwrap_or_default();
        rows.sort_by(|one, other| push(one).total_cmp(&push(other)));
        rows
    }

    /// Returns `row` with the values of the state `found`.
    fn row(
        &self,
        row: LocatedState,
        wanted: &Wanted,
        has_deviations: bool,
        found: &FoundState,
    ) -> LocatedState {
        let (grid, full, at, units) = (found.grid, &found.full, found.at, &self.units);
        let distance = grid.rest.distance_of_pole(full.map.pole.length());
        let touch = grid.rest.pole_at_distance(distance).to_angle();
        let signed_push = found.phi - touch;
        let reading = grid.reader.read(at.x, full, touch, signed_push);
        let to_base = DVec2::new(full.tangent.x, -full.tangent.y);
        let contact = units.length_mm * to_base.rotate(-full.position);
        let pole = units.length_mm * full.map.pole;
        let weighted = Triangle::new(found.derivatives.map(|by| wanted.weights * by));
        let deviation = |gradient: DVec2, unit: f64| {
            has_deviations.then(|| weighted.deviation(gradient) * unit)
        };
        // Gradients by the logarithms of contact and load.
        let [tau, load] = by_logarithms(&grid.rod, at);
        let [by_contact, by_load] = [full.map.by_tau * tau, full.map.by_load * load];
        let by_distance = grid.rest.touch_derivative(distance, 1.0, &RodDerivative::default());
        let of_distance = DVec2::new(by_contact.x, by_load.x) / by_distance.x;
        let of_push = DVec2::new(by_contact.y, by_load.y) - by_distance.y * of_distance;
        let arclength = reading.arc_length_mm / units.length_mm;
        // The force is the load times the squared radius.
        let of_force = DVec2::new(-2.0 * grid.rod.taper * tau, 1.0);
        let turn = wanted.reading.angle_deg.map(f64::to_radians);
        let [lab_contact, lab_pole] =
            [contact, pole].map(|at| turn.map(|turn| DVec2::from_angle(turn).rotate(at)));
        LocatedState {
            side: Some(grid.side),
            contact_x_mm: Some(contact.x),
            contact_y_mm: Some(contact.y),
            pole_x_mm: Some(pole.x),
            pole_y_mm: Some(pole.y),
            distance_mm: Some(distance * units.length_mm),
            push_angle_deg: Some(signed_push.to_degrees()),
            misfit: Some(found.misfit),
            condition: Some(found.condition),
            arc_length_sd_mm: deviation(DVec2::new(arclength, 0.0), units.length_mm),
            distance_sd_mm: deviation(of_distance, units.length_mm),
            push_angle_sd_deg: deviation(of_push, 1f64.to_degrees()),
            force_sd_un: deviation(of_force, reading.force_un),
            lab_contact_x_mm: lab_contact.map(|at| at.x),
            lab_contact_y_mm: lab_contact.map(|at| at.y),
            lab_pole_x_mm: lab_pole.map(|at| at.x),
            lab_pole_y_mm: lab_pole.map(|at| at.y),
            reason: None,
            ..row.with_state(Some(&reading))
        }
    }
}

impl LocatedState {
    /// Returns the row of the reading with this `number` without a state.
    fn without(number: usize, reason: NoLocation) -> Self {
        Self { reading: number, reason: Some(reason), ..Self::default() }
    }
}
