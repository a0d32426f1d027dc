//! Panels with the values of states, by plain trajectories, for the rows of an engine.

use super::bound::{MARGIN, VALUE_WEIGHT, larger};
use super::certificate::certified;
use super::panel::{NetPanel, along, contacts_of};
use super::row::{FUNCTIONS, NetRow, RowLine};
use super::size::NetSize;
use super::{PanelRow, PanelRows, Panels};
use crate::numerics::expansion::{Chebyshev, chebyshev_points};
use crate::numerics::nearest_turn;
use crate::numerics::tensor::ChebyshevTensor;
use crate::plan::net_cost;
use crate::rod::Units;
use crate::sheet::case::SheetCase;
use crate::sheet::{Row, Sheet};
use crate::shooting::{PlainState, Reader};

/// Smallest bound on the residual that trajectories of the finest steps allow, in whisker lengths: that of refined states.
pub const SMALLEST_RESIDUAL: f64 = 1e-12;

/// Functions of a state, `[function]`: `ln D`, direction `phi` of the pole in radians, contact angle in radians, position `[x, y]` of the base
/// from the contact in whisker lengths, chord angle in radians, and energy over force times arclength.
type Functions = [f64; FUNCTIONS];

/// Units of dimensionless numbers.
const NO_UNITS: Units = Units {
    length_mm: 1.0,
    force_un: 1.0,
    moment_nnm: 1.0,
    strain: 1.0,
};

/// Number of points of contact and scale of the load as functions of `u`.
pub const ALONG: usize = 32;

/// Panel with the values of states, and a bound on its errors.
#[derive(Clone, Debug)]
pub struct ValuePanel {
    pub(super) panel: NetPanel<FUNCTIONS>,
    /// Bound on the residual of the panel's states, in whisker lengths.
    pub(super) residual: f64,
    pub(super) reader: Reader,
}

/// Panels with the values of states, for the rows of an engine.
pub type ValueNet = Panels<ValuePanel>;

impl ValueNet {
    /// Returns the panels of `sheet` for an engine: states with a residual of at most `most` whisker lengths, for rows with `cells(row)` cells,
    /// where that takes less time than the trajectories of the cells.
    ///
    /// `None` without a panel, without samples of the sheet, with measured radii, whose states are not analytic where the contact passes from one radius to the
    /// next, and where `most` is below the residual of refined states.
    #[must_use]
    pub fn new(sheet: &Sheet, cells: impl Fn(usize) -> usize, most: f64) -> Option<Self> {
        let samples = sheet.samples.as_deref()?;
        if sheet.rod.profile.is_some() || most < SMALLEST_RESIDUAL {
            return None;
        }
        let rows = PanelRows {
            rod: &sheet.rod,
            rows: &sheet.rows,
            aim: most,
        };
        let pays = |size: NetSize, rows: &[PanelRow]| {
            let count: usize = rows.iter().map(|own| cells(own.row)).sum();
            net_cost(size.states(), rows.len()) < count
        };
        let make = |rows: &[PanelRow], contacts: [f64; 2], size| {
            let along = along(&sheet.rod, &samples.contacts, contacts, ALONG);
            ValuePanel::new(sheet, rows, contacts, along, size, most)
        };
        let last = |row, _: &Row| Some(sheet.simple_end(row)?.tau);
        let net = rows.panels(last, pays, make);
        (!net.panels.is_empty()).then_some(net)
    }

    /// Returns the states of a `row` of `sheet`, with the bound on their residual in whisker lengths; `None` if the row is not in the net.
    pub(in crate::sheet) fn row(&self, sheet: &Sheet, row: usize) -> Option<(NetRow, f64)> {
        let panel = self.of(row)?;
        Some((panel.row(sheet, row)?, panel.residual))
    }

    /// Returns the largest number of loads of a panel.
    #[must_use]
    pub fn loads(&self) -> usize {
        let loads = self.panels.iter().map(|own| own.panel.size.loads);
        loads.max().unwrap_or(0)
    }
}

impl ValuePanel {
    /// Computes the panel of `size` over the range of `contacts` of `rows`.
    ///
    /// # Errors
    /// If its bound exceeds `most`, in whisker lengths, the size that is expected to be accurate enough; `None` if there is none.
    pub(super) fn new(
        sheet: &Sheet,
        rows: &[PanelRow],
        contacts: [f64; 2],
        along: Chebyshev<2>,
        size: NetSize,
        most: f64,
    ) -> Result<Self, Option<NetSize>> {
        let reader = Reader::new(NO_UNITS, &sheet.rod);
        let tensor = tensor(sheet.case(), &reader, size, &along);
        let mut own = Self {
            panel: NetPanel::new(contacts, along, size, tensor, size.columns()),
            residual: f64::NAN,
            reader,
        };
        let error = own.error();
        // NaN is not below any bound.
        let has_converged = MARGIN * error <= most;
        if !has_converged {
            return Err(size.enough(own.panel.tails(&own.weights()), most));
        }
        own.panel.shorten(&own.weights());
        own.residual = certified(sheet, &own, rows, error);
        if own.residual <= most {
            Ok(own)
        } else {
            // Between the nodes, the error is larger than the last coefficients.
            Err(size.larger())
        }
    }

    /// Returns the error that the coefficients left out are expected to make, in whisker lengths.
    pub(super) fn error(&self) -> f64 {
        let [in_contact, in_load] = self.panel.tails(&self.weights());
        larger(in_contact.last, in_load.last)
    }

    /// Weights that convert errors of the functions to whisker lengths.
    fn weights(&self) -> Functions {
        let [ln_tau, _] = self.panel.along.at(0.0);
        let position = VALUE_WEIGHT / libm::exp(ln_tau).min(1.0);
        [
            1.0,
            1.0,
            VALUE_WEIGHT,
            position,
            position,
            VALUE_WEIGHT,
            VALUE_WEIGHT,
        ]
    }

    /// Returns the states of a `row` of `sheet`, from first touch to its only other end. `None` if the row has other ends, or is not in the panel.
    pub(super) fn row(&self, sheet: &Sheet, row: usize) -> Option<NetRow> {
        let part = self.panel.part(&sheet.rod, sheet.simple_end(row)?);
        let is_loaded = part >= SMALLEST_END;
        let place = &sheet.rows[row];
        let line = is_loaded.then(|| self.panel.line(place, [0.0, part]))??;
        Some(RowLine::new(sheet.case(), place, &line).row())
    }
}

/// Smallest part of the fold's load at the end of a row. Values of a row with a smaller load are too small beside the errors of the net.
const SMALLEST_END: f64 = 0.05;

/// Shoots the trajectories of a tensor of this `size`.
pub(super) fn tensor(
    case: SheetCase,
    reader: &Reader,
    size: NetSize,
    along: &Chebyshev<2>,
) -> ChebyshevTensor<FUNCTIONS> {
    let loads = chebyshev_points(size.loads);
    let contacts = contacts_of(case, size, along);
    let nodes = contacts
        .iter()
        .flat_map(|(tau, most)| loads.iter().map(move |part| (*tau, part * most)));
    let states: Vec<PlainState> = case.shoot(nodes);
    // Directions are continuous along the load, and from contact to contact at the smallest load.
    let mut first = 0.0;
    let rows = contacts
        .iter()
        .zip(states.chunks(size.loads))
        .map(|((tau, _), states)| {
            let (mut phi, mut chord) = (first, 0.0);
            let values = states.iter().map(|state| {
                phi = nearest_turn(state.pole.to_angle(), phi);
                let numbers = reader.numbers(*tau, state, phi, chord);
                chord = numbers.chord;
                let [x, y] = numbers.position;
                let (ln_distance, angle) = (libm::log(state.pole.length()), numbers.contact_angle);
                let energy = numbers.energy / (numbers.force.abs() * numbers.arclength);
                [ln_distance, phi, angle, x, y, chord, energy]
            });
            let values: Vec<Functions> = values.collect();
            first = values.first().map_or(0.0, |own| own[1]);
            Chebyshev::through(&values)
        });
    ChebyshevTensor::through(&rows.collect::<Vec<_>>())
}
