//! Panels with the values of states, by plain trajectories, for the rows of an engine.

use super::bound::{MARGIN, SMALLEST_RESIDUAL, VALUE_WEIGHT, larger};
use super::certificate::certified;
use super::panel::{NetPanel, along, contacts_of};
use super::row::{FUNCTIONS, NetRow, RowLine};
use super::size::NetSize;
use super::{PanelRow, PanelRows, Panels};
use crate::plan::net_cost;
use crate::sheet::case::SheetCase;
use crate::sheet::{Row, Sheet};
use whiskmap_mechanics::numerics::expansion::{Chebyshev, chebyshev_points};
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::numerics::tensor::ChebyshevTensor;
use whiskmap_mechanics::rod::Units;
use whiskmap_mechanics::shooting::{PlainState, Reader};

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
        own.residual = own.certified(sheet, rows, error);
        if own.residual <= most {
            Ok(own)
        } else {
            // Between the nodes, the error is larger than the last coefficients.
            Err(size.larger())
        }
    }

    /// Returns the bound on the errors of its states, in whisker lengths, where the coefficients left out are expected to make this error.
    fn certified(&self, sheet: &Sheet, rows: &[PanelRow], by_decay: f64) -> f64 {
        let states = |row| self.row(sheet, row);
        certified(sheet, &self.reader, rows, states, by_decay)
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

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]
mod tests {
    use super::*;
    use crate::sheet::Edge;
    use crate::sheet::net::NET_RESIDUAL as MOST;
    use whiskmap_mechanics::rod::{Rod, Side};
    use whiskmap_mechanics::shooting::batch::Method;

    /// Error of a coefficient, as a part of the largest coefficient of its function.
    const SPOIL: f64 = 1e-6;

    /// Coefficients between two spoiled ones: coprime to the sizes, so that all functions and all powers are among them.
    const STRIDE: usize = 11;

    /// The cone of the paper, with rows that end at the fold and at the tip.
    fn cone() -> (Sheet, Vec<PanelRow>) {
        let rod = Rod {
            taper: 0.95,
            bend: 0.4,
            pole: 0.0125,
            ..Rod::default()
        };
        let distances: Vec<f64> = (0..60).map(|i| 0.4 + 0.01 * f64::from(i)).collect();
        let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, &distances);
        let rows = sheet.rows.iter().enumerate();
        let rows = rows.filter_map(|(row, place)| {
            let end = sheet.simple_end(row)?;
            PanelRow::new(&rod, row, place, end.tau)
        });
        let rows = rows.collect();
        (sheet, rows)
    }

    const SIZE: NetSize = NetSize {
        contacts: 28,
        loads: 24,
    };

    fn panel(sheet: &Sheet, rows: &[PanelRow]) -> ValuePanel {
        let last = rows.iter().map(|own| own.contacts[1]);
        let contacts = [rows[0].contacts[0], last.fold(0.0, f64::max)];
        let samples = sheet.samples.as_ref().unwrap();
        let along = along(&sheet.rod, &samples.contacts, contacts, ALONG);
        let panel = ValuePanel::new(sheet, rows, contacts, along, SIZE, MOST);
        panel.unwrap_or_else(|_| panic!("refused"))
    }

    fn bound(sheet: &Sheet, rows: &[PanelRow], panel: &ValuePanel) -> f64 {
        panel.certified(sheet, rows, 0.0)
    }

    /// The tensor of a panel with all its coefficients.
    fn whole(sheet: &Sheet, panel: &ValuePanel) -> ChebyshevTensor<FUNCTIONS> {
        tensor(sheet.case(), &panel.reader, SIZE, &panel.panel.along)
    }

    fn with_tensor(panel: &ValuePanel, tensor: ChebyshevTensor<FUNCTIONS>) -> ValuePanel {
        let NetPanel {
            contacts, along, ..
        } = &panel.panel;
        ValuePanel {
            panel: NetPanel::new(*contacts, along.clone(), SIZE, tensor, SIZE.columns()),
            ..panel.clone()
        }
    }

    /// A single wrong coefficient of any power of any function exceeds the bound, although all others decay. With NaN there is no bound.
    #[test]
    fn a_spoiled_coefficient_is_refused() {
        let (sheet, rows) = cone();
        let edge = |row: &PanelRow| sheet.crossings[row.row][0].edge;
        assert!(
            [Edge::Fold, Edge::Tip]
                .iter()
                .all(|own| rows.iter().any(|row| edge(row) == *own))
        );
        let sound = panel(&sheet, &rows);
        assert!(bound(&sheet, &rows, &sound) <= sound.residual);
        let NetSize { contacts, loads } = SIZE;
        let whole = whole(&sheet, &sound);
        let largest = whole.coefficients.iter().flatten();
        let largest = largest.fold([0.0; FUNCTIONS], |most, own| {
            std::array::from_fn(|i| f64::max(most[i], own[i].abs()))
        });
        for place in (0..contacts * loads * FUNCTIONS).step_by(STRIDE) {
            let (power, function) = (place / FUNCTIONS, place % FUNCTIONS);
            let (in_u, in_p) = (power / loads, power % loads);
            let spoiled = |change: &dyn Fn(&mut f64)| {
                let mut tensor = whole.clone();
                change(&mut tensor.coefficients[in_u][in_p][function]);
                bound(&sheet, &rows, &with_tensor(&sound, tensor))
            };
            let wrong = spoiled(&|own| *own += SPOIL * largest[function]);
            let without = spoiled(&|own| *own = f64::NAN);
            assert!(
                (wrong > MOST || wrong.is_nan()) && without.is_nan(),
                "function {function}, powers {in_u} and {in_p}: {wrong:e} {without:e}"
            );
        }
    }

    /// A wrong node, or a wrong scale of the load, is found by the decay of the coefficients or by the trajectories.
    #[test]
    fn a_spoiled_node_is_refused() {
        let (sheet, rows) = cone();
        let sound = panel(&sheet, &rows);
        let whole = whole(&sheet, &sound);
        let NetSize { contacts, loads } = SIZE;
        for node in (0..contacts * loads).step_by(29) {
            let (in_u, in_p) = (node / loads, node % loads);
            let weight = |count: usize, node: usize| {
                let mut values = vec![[0.0; 1]; count];
                values[node] = [1.0];
                Chebyshev::through(&values).coefficients
            };
            let (by_u, by_p) = (weight(contacts, in_u), weight(loads, in_p));
            for function in 0..FUNCTIONS {
                let mut tensor = whole.clone();
                for (terms, [by_u]) in tensor.coefficients.iter_mut().zip(&by_u) {
                    for (term, [by_p]) in terms.iter_mut().zip(&by_p) {
                        term[function] += 1e-6 * by_u * by_p;
                    }
                }
                let spoiled = with_tensor(&sound, tensor);
                let error = spoiled.certified(&sheet, &rows, spoiled.error());
                assert!(
                    error > MOST || error.is_nan(),
                    "node {node}, function {function}: {error:e}"
                );
            }
        }
    }

    /// States of the net at random contacts and loads of a row are those of trajectories.
    #[test]
    fn a_bound_is_four_times_the_largest_error() {
        let (sheet, rows) = cone();
        let sound = panel(&sheet, &rows);
        let by_decay = |error: f64| sound.certified(&sheet, &rows, error);
        assert_eq!(by_decay(1e-6), 4e-6);
        let own = by_decay(0.0);
        assert!((1e-12..1e-10).contains(&own), "{own:e}");
        let spoiled = |function: usize, change: f64| {
            let mut tensor = sound.panel.tensor.clone();
            tensor.coefficients[0][0][function] += change;
            bound(&sheet, &rows, &with_tensor(&sound, tensor))
        };
        // The direction of the pole: the pole is missed by its distance times the change.
        let farthest = sheet.rows[rows[rows.len() - 1].row].pole_distance;
        let by_phi = spoiled(1, SPOIL) / (MARGIN * SPOIL);
        assert!((by_phi / farthest - 1.0).abs() < 1e-3, "{by_phi}");
        let by_angle = spoiled(2, SPOIL) / (MARGIN * SPOIL * VALUE_WEIGHT);
        assert!((by_angle - 1.0).abs() < 1e-3, "{by_angle}");
    }
}
