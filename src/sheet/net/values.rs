//! Panels with the values of states, by plain trajectories, for the rows of an engine.

use super::bound::{MARGIN, SMALLEST_RESIDUAL, VALUE_WEIGHT, larger};
use super::certificate::certified;
use super::panel::{NetPanel, along, contacts_of};
use super::row::{FUNCTIONS, NetRow};
use super::size::NetSize;
use super::{Attempt, PanelQueue, PanelRow, Panels};
use crate::plan::net_cost;
use crate::sheet::Sheet;
use crate::sheet::samples::SheetSamples;
use std::sync::Arc;
use whiskmap_mechanics::numerics::expansion::{Chebyshev, chebyshev_points};
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::numerics::tensor::ChebyshevTensor;
use whiskmap_mechanics::rod::Units;
use whiskmap_mechanics::shooting::{PlainState, Reader};

/// Functions of a state, `[function]`: `ln D`, direction `phi` of the pole in radians, contact angle in radians, position `[x, y]` of the base
/// from the contact in whisker lengths, chord angle in radians, and energy over force times arclength.
type Functions = [f64; FUNCTIONS];

/// Units of dimensionless numbers.
const NO_UNITS: Units = Units { length_mm: 1.0, force_un: 1.0, moment_nnm: 1.0, strain: 1.0 };

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

/// Panels with values in the making, whose trajectories are integrated elsewhere. In each round, [`ValueDraft::nodes`] are the trajectories that
/// are needed next, and [`ValueDraft::take`] gets their states.
#[derive(Debug)]
pub struct ValueDraft {
    samples: Arc<SheetSamples>,
    /// Largest residual of the panels' states, in whisker lengths.
    most: f64,
    queue: PanelQueue<ValuePanel>,
    /// Attempts of this round.
    grids: Vec<Grid>,
}

/// Trajectories of a panel: some loads at each of some contacts.
#[derive(Debug)]
struct Grid {
    attempt: Attempt,
    along: Chebyshev<2>,
    /// Contacts with their signed loads at the top of the panel: `(tau, load)`.
    contacts: Vec<(f64, f64)>,
}

impl Grid {
    /// Creates the grid of a panel of `sheet`, which has these `samples`.
    fn new(sheet: &Sheet, samples: &SheetSamples, attempt: Attempt) -> Self {
        let along = along(&sheet.rod, &samples.contacts, attempt.contacts, ALONG);
        Self { contacts: contacts_of(sheet.case(), attempt.size, &along), along, attempt }
    }

    /// Returns contact and load of each trajectory, `(tau, load)`, contact by contact.
    fn nodes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let loads = chebyshev_points(self.attempt.size.loads);
        let contacts = self.contacts.iter();
        contacts.flat_map(move |(tau, most)| loads.iter().map(move |part| (*tau, part * most)))
    }
}

impl ValueDraft {
    /// Begins the panels of [`ValueNet::new`]; `None` where no panel is possible.
    pub fn new(sheet: &Sheet, cells: impl Fn(usize) -> usize, most: f64) -> Option<Self> {
        let samples = Arc::clone(sheet.samples.as_ref()?);
        if sheet.rod.profile.is_some() || most < SMALLEST_RESIDUAL {
            return None;
        }
        let pays = |size: NetSize, rows: &[PanelRow]| {
            let cells = rows.iter().map(|row| row.cells).sum();
            net_cost(size.states(), rows.len()) < cells
        };
        let rows = sheet.rows.iter().enumerate().filter_map(|(row, place)| {
            let last = sheet.simple_end(row)?.tau;
            PanelRow::new(&sheet.rod, row, place, last, cells(row))
        });
        Some(Self {
            samples,
            most,
            queue: PanelQueue::new(most, pays, sheet.rows.len(), rows),
            grids: Vec::new(),
        })
    }

    /// Returns the trajectories that are needed next, `(tau, load)` of the rod of the draft's `sheet`; none if all panels are made.
    pub fn nodes(&mut self, sheet: &Sheet) -> Vec<(f64, f64)> {
        let open = std::mem::take(&mut self.queue.open).into_iter();
        let grids = open.map(|attempt| Grid::new(sheet, &self.samples, attempt));
        self.grids = grids.collect();
        self.grids.iter().flat_map(Grid::nodes).collect()
    }

    /// Makes the panels of a round of the draft's `sheet` from the `states` of its nodes, `[node]`.
    ///
    /// # Panics
    ///
    /// If there are fewer states than nodes.
    pub fn take(&mut self, sheet: &Sheet, mut states: &[PlainState]) {
        for grid in std::mem::take(&mut self.grids) {
            let (panel_states, others) = states.split_at(grid.attempt.size.states());
            states = others;
            let rows = self.queue.rows_of(&grid.attempt);
            let made = ValuePanel::new(sheet, rows, &grid, panel_states, self.most);
            self.queue.store(grid.attempt, made);
        }
    }

    /// Returns the panels that have been made; `None` without one.
    pub fn finish(self) -> Option<ValueNet> {
        let net = self.queue.found;
        (!net.panels.is_empty()).then_some(net)
    }
}

impl ValueNet {
    /// Computes the panels of `sheet` for an engine: states with a residual of at most `most` whisker lengths, for rows with `cells(row)` cells,
    /// where that takes less time than the trajectories of the cells.
    ///
    /// `None` without a panel, without samples of the sheet, with measured radii, whose states are not analytic where the contact passes from one
    /// radius to the next, and where `most` is below the residual of refined states.
    #[must_use]
    pub fn new(sheet: &Sheet, cells: impl Fn(usize) -> usize, most: f64) -> Option<Self> {
        let mut draft = ValueDraft::new(sheet, cells, most)?;
        loop {
            let nodes = draft.nodes(sheet);
            if nodes.is_empty() {
                return draft.finish();
            }
            draft.take(sheet, &sheet.case().shoot::<PlainState>(nodes));
        }
    }

    /// Returns the states of a `row` of `sheet`, with the bound on their residual in whisker lengths; `None` if the row is not in the net.
    pub(in crate::sheet) fn row(&self, sheet: &Sheet, row: usize) -> Option<(NetRow, f64)> {
        let panel = self.of(row)?;
        Some((panel.row(sheet, row)?, panel.residual))
    }

    /// Returns the largest number of loads of a panel.
    #[must_use]
    pub fn loads(&self) -> usize {
        let loads = self.panels.iter().map(|value_panel| value_panel.panel.size.loads);
        loads.max().unwrap_or(0)
    }
}

impl ValuePanel {
    /// Creates the panel of `rows` from the `states` of a grid.
    ///
    /// # Errors
    /// If the panel's bound exceeds `most`, in whisker lengths: the size that is expected to be accurate enough, or `None` without such a size.
    fn new(
        sheet: &Sheet,
        rows: &[PanelRow],
        grid: &Grid,
        states: &[PlainState],
        most: f64,
    ) -> Result<Self, Option<NetSize>> {
        let reader = Reader::new(NO_UNITS, &sheet.rod);
        let tensor = tensor(&reader, grid, states);
        let Attempt { contacts, size, .. } = grid.attempt;
        let panel = NetPanel::new(contacts, grid.along.clone(), size, tensor, size.columns());
        let mut value_panel = Self { panel, residual: f64::NAN, reader };
        let error = value_panel.error();
        // NaN is not below any bound.
        let has_converged = MARGIN * error <= most;
        if !has_converged {
            return Err(size.enough(value_panel.panel.tails(&value_panel.weights()), most));
        }
        value_panel.panel.shorten(&value_panel.weights());
        value_panel.residual = value_panel.certified(sheet, rows, error);
        if value_panel.residual <= most {
            Ok(value_panel)
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
        [1.0, 1.0, VALUE_WEIGHT, position, position, VALUE_WEIGHT, VALUE_WEIGHT]
    }

    /// Returns the states of a `row` of `sheet`, from first touch to its only other end. `None` if the row has other ends, or is not in the panel.
    pub(super) fn row(&self, sheet: &Sheet, row: usize) -> Option<NetRow> {
        let part = self.panel.part(&sheet.rod, sheet.simple_end(row)?);
        let is_loaded = part >= SMALLEST_END;
        let place = &sheet.rows[row];
        let line = is_loaded.then(|| self.panel.line(place, [0.0, part]))??;
        Some(NetRow::of(sheet.case(), place, &line))
    }
}

/// Smallest part of the fold's load at the end of a row. Values of a row with a smaller load are too small beside the errors of the net.
const SMALLEST_END: f64 = 0.05;

/// Returns the tensor of the functions of the `states` of a grid.
fn tensor(reader: &Reader, grid: &Grid, states: &[PlainState]) -> ChebyshevTensor<FUNCTIONS> {
    let loads = grid.attempt.size.loads;
    // Directions are continuous along the load, and from contact to contact at the smallest load.
    let mut first = 0.0;
    let rows = grid.contacts.iter().zip(states.chunks(loads)).map(|((tau, _), states)| {
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
        first = values.first().map_or(0.0, |functions| functions[1]);
        Chebyshev::through(&values)
    });
    ChebyshevTensor::through(&rows.collect::<Vec<_>>())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
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
        let rod = Rod { taper: 0.95, bend: 0.4, pole: 0.0125, ..Rod::default() };
        let distances: Vec<f64> = (0..60).map(|i| 0.4 + 0.01 * f64::from(i)).collect();
        let sheet = Sheet::new(Method::fine(), &rod, Side::Cb, &distances);
        let rows = sheet.rows.iter().enumerate();
        let panel_rows = rows.filter_map(|(row, place)| {
            let end = sheet.simple_end(row)?;
            PanelRow::new(&rod, row, place, end.tau, 0)
        });
        let panel_rows = panel_rows.collect();
        (sheet, panel_rows)
    }

    const SIZE: NetSize = NetSize { contacts: 28, loads: 24 };

    /// The grid of all rows, and the states of its nodes.
    fn grid(sheet: &Sheet, rows: &[PanelRow]) -> (Grid, Vec<PlainState>) {
        let last = rows.iter().map(|row| row.contacts[1]);
        let attempt = Attempt {
            rows: 0..rows.len(),
            contacts: [rows[0].contacts[0], last.fold(0.0, f64::max)],
            size: SIZE,
            tries: 1,
            halvings: 0,
        };
        let grid = Grid::new(sheet, sheet.samples.as_ref().unwrap(), attempt);
        let states = sheet.case().shoot(grid.nodes());
        (grid, states)
    }

    fn panel(sheet: &Sheet, rows: &[PanelRow]) -> ValuePanel {
        let (grid, states) = grid(sheet, rows);
        let panel = ValuePanel::new(sheet, rows, &grid, &states, MOST);
        panel.unwrap_or_else(|_| panic!("refused"))
    }

    fn bound(sheet: &Sheet, rows: &[PanelRow], panel: &ValuePanel) -> f64 {
        panel.certified(sheet, rows, 0.0)
    }

    /// The tensor of a panel with all its coefficients.
    fn whole(sheet: &Sheet, rows: &[PanelRow]) -> ChebyshevTensor<FUNCTIONS> {
        let (grid, states) = grid(sheet, rows);
        tensor(&Reader::new(NO_UNITS, &sheet.rod), &grid, &states)
    }

    fn with_tensor(panel: &ValuePanel, tensor: ChebyshevTensor<FUNCTIONS>) -> ValuePanel {
        let NetPanel { contacts, along, .. } = &panel.panel;
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
                .all(|expected| rows.iter().any(|row| edge(row) == *expected))
        );
        let sound = panel(&sheet, &rows);
        assert!(bound(&sheet, &rows, &sound) <= sound.residual);
        let NetSize { contacts, loads } = SIZE;
        let whole = whole(&sheet, &rows);
        let largest = whole.coefficients.iter().flatten();
        let largest = largest.fold([0.0; FUNCTIONS], |most, functions| {
            std::array::from_fn(|i| f64::max(most[i], functions[i].abs()))
        });
        for place in (0..contacts * loads * FUNCTIONS).step_by(STRIDE) {
            let (power, function) = (place / FUNCTIONS, place % FUNCTIONS);
            let (in_u, in_p) = (power / loads, power % loads);
            let spoiled = |change: &dyn Fn(&mut f64)| {
                let mut tensor = whole.clone();
                change(&mut tensor.coefficients[in_u][in_p][function]);
                bound(&sheet, &rows, &with_tensor(&sound, tensor))
            };
            let wrong = spoiled(&|coefficient| *coefficient += SPOIL * largest[function]);
            let without = spoiled(&|coefficient| *coefficient = f64::NAN);
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
        let whole = whole(&sheet, &rows);
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

    /// The net and trajectories give equal states at random contacts and loads of a row.
    #[test]
    fn a_bound_is_four_times_the_largest_error() {
        let (sheet, rows) = cone();
        let sound = panel(&sheet, &rows);
        let by_decay = |error: f64| sound.certified(&sheet, &rows, error);
        assert_eq!(by_decay(1e-6), 4e-6);
        let checked_bound = by_decay(0.0);
        assert!((1e-12..1e-10).contains(&checked_bound), "{checked_bound:e}");
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
