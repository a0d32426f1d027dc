//! Panels of a net: one tensor of trajectories over the contacts of neighbouring rows.

use super::certificate::{MARGIN, VALUE_WEIGHT, certified, larger, largest};
use super::row::{NetRow, RowLine};
use super::size::{NetSize, NetTail};
use super::{PanelRow, simple_end};
use crate::numerics::expansion::{Chebyshev, chebyshev_points};
use crate::numerics::nearest_turn;
use crate::numerics::tensor::{ChebyshevTensor, TensorColumns};
use crate::rod::Units;
use crate::sheet::Sheet;
use crate::sheet::case::SheetCase;
use crate::sheet::fold::coordinate::{tau_of, u_of};
use crate::shooting::{PlainState, Reader};

/// Number of functions of a tensor.
pub const FUNCTIONS: usize = 7;

/// Functions of a state, `[function]`: `ln D`, direction `phi` of the pole in radians, contact angle in radians, position `[x, y]` of the base
/// from the contact in whisker lengths, chord angle in radians, and energy over force times arclength.
type Functions = [f64; FUNCTIONS];

/// Number of points of `ln tau` and `ln q` as functions of `u`, and of the second one alone: the scale of the load need only be smooth.
const ALONG: usize = 32;
const SCALE: usize = 9;

/// Number of columns of a row of its own, over those of the panel's rows: `[constant, for each part of the largest load]`. On a shorter range,
/// fewer are as accurate; the last coefficients of the row show it.
const OWN: [f64; 2] = [0.5, 0.5];

/// Smallest part of a panel's largest load at which a row has the columns of the panel. A row with a smaller load at its end gets its own.
const SHARED: f64 = 0.95;

/// Weighted coefficient below which a polynomial of the load ends: below the rounding of the states.
const ROUNDING: f64 = 1e-15;

/// Smallest part of the fold's load at the end of a row. Values of a row with a smaller load are too small beside the errors of the net.
const SMALLEST_END: f64 = 0.05;

/// Panel: a tensor of trajectories with a bound on its errors.
#[derive(Clone, Debug)]
pub struct NetPanel {
    /// Size of the tensor.
    pub size: NetSize,
    /// Bound on the residual of the panel's states, in whisker lengths.
    pub residual: f64,
    /// First and last contact coordinate `u` of the panel.
    contacts: [f64; 2],
    /// Largest part `p` of the load in the panel.
    top: f64,
    /// Functions `[ln tau, ln q]` of the part of the range of contacts.
    along: Chebyshev<2>,
    tensor: ChebyshevTensor<FUNCTIONS>,
    /// Columns at the Chebyshev points of all loads of the panel.
    columns: TensorColumns<FUNCTIONS>,
    reader: Reader,
}

/// Units of dimensionless numbers.
const NO_UNITS: Units = Units {
    length_mm: 1.0,
    force_un: 1.0,
    moment_nnm: 1.0,
    strain: 1.0,
};

/// Returns `ln tau` and `ln q` over the range of `contacts`, where `q` is near the fold's `|load| tau^2`.
fn along(sheet: &Sheet, contacts: [f64; 2]) -> Option<Chebyshev<2>> {
    let samples = sheet.samples.as_ref()?;
    let mut near = 1.0;
    let mut tau_at = |part: f64| {
        near = tau_of(
            &sheet.rod,
            contacts[0] + part * (contacts[1] - contacts[0]),
            near,
        );
        near
    };
    let scale = chebyshev_points(SCALE).iter().map(|part| {
        let tau = tau_at(*part);
        [libm::log(samples.contacts.fold_load(tau) * tau * tau)]
    });
    let scale = Chebyshev::through(&scale.collect::<Vec<_>>());
    let both = chebyshev_points(ALONG).iter().map(|part| {
        let [ln_q] = scale.at(*part);
        [libm::log(tau_at(*part)), ln_q]
    });
    Some(Chebyshev::through(&both.collect::<Vec<_>>()))
}

impl NetPanel {
    /// Computes the trajectories of `size` over the range of `contacts` and certifies the expansions through them for `rows` of `sheet`.
    ///
    /// # Errors
    /// If the bound exceeds `most`, in whisker lengths, the size that is expected to be accurate enough; `None` if there is none.
    pub fn new(
        sheet: &Sheet,
        rows: &[PanelRow],
        contacts: [f64; 2],
        size: NetSize,
        most: f64,
    ) -> Result<Self, Option<NetSize>> {
        let along = along(sheet, contacts).ok_or(None)?;
        let part_of = |row: &PanelRow| end_part(sheet, row.row, contacts, &along);
        let parts = rows.iter().filter_map(part_of);
        let top = parts.fold(0.0, f64::max);
        let reader = Reader::new(NO_UNITS, &sheet.rod);
        let tensor = tensor(sheet, &reader, size, &along, top);
        let mut panel = Self {
            size,
            residual: f64::NAN,
            contacts,
            top,
            along,
            columns: tensor.columns(chebyshev_points(size.columns())),
            tensor,
            reader,
        };
        let tails = panel.tails();
        let error = larger(tails[0].last, tails[1].last);
        // NaN is not below any bound.
        let has_converged = MARGIN * error <= most;
        if !has_converged {
            return Err(size.enough(tails, most));
        }
        let weights = panel.weights();
        panel
            .tensor
            .shorten(|terms| largest(terms, &weights) < ROUNDING);
        panel.residual = certified(sheet, &panel.reader, &panel, rows, error);
        if panel.residual <= most {
            Ok(panel)
        } else {
            // Between the nodes, the error is larger than the last coefficients.
            Err(size.larger())
        }
    }

    /// Sizes of the last coefficients in both coordinates.
    fn tails(&self) -> [NetTail; 2] {
        let weights = self.weights();
        self.tensor.tails().map(|tails| {
            let [last, before] = tails.map(|tail| largest(&tail, &weights));
            NetTail { last, before }
        })
    }

    /// Weights that convert errors of the functions to whisker lengths.
    fn weights(&self) -> Functions {
        let [ln_tau, _] = self.along.at(0.0);
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

    /// Returns the states of `row` of `sheet`; `None` if the row has no simple span from first touch, or is not in the panel.
    pub fn row(&self, sheet: &Sheet, row: usize) -> Option<NetRow> {
        let end = end_part(sheet, row, self.contacts, &self.along)?;
        if !(end >= SMALLEST_END && end <= self.top) {
            return None;
        }
        let shared = (end >= SHARED * self.top)
            .then(|| self.states(sheet, row, &self.columns, self.top, end))
            .flatten();
        shared.or_else(|| {
            let part = end / self.top;
            let count = (OWN[0] + OWN[1] * part) * self.size.columns() as f64;
            // A part of the loads is a small number.
            let places = chebyshev_points(count.ceil() as usize).iter();
            let places: Vec<f64> = places.map(|point| point * part).collect();
            self.states(sheet, row, &self.tensor.columns(&places), end, end)
        })
    }

    /// Returns the states of `row` on columns up to the part `top` of the load; the row ends at the part `end`.
    fn states(
        &self,
        sheet: &Sheet,
        row: usize,
        columns: &TensorColumns<FUNCTIONS>,
        top: f64,
        end: f64,
    ) -> Option<NetRow> {
        let row = &sheet.rows[row];
        let points = columns.level(libm::log(row.pole_distance), &self.along)?;
        let count = points.iter().map(|block| block.count).sum();
        let parts = chebyshev_points(count).iter();
        let parts: Vec<f64> = parts.map(|point| top * point).collect();
        let line = RowLine {
            sheet,
            row,
            tilt: sheet.rod.contact_tangent().to_angle(),
            parts: &parts,
            points: &points,
        };
        Some(NetRow {
            blocks: line.blocks(),
            end: end / top,
        })
    }
}

/// Returns the part `p` of the load at the end of `row`.
fn end_part(sheet: &Sheet, row: usize, contacts: [f64; 2], along: &Chebyshev<2>) -> Option<f64> {
    let end = simple_end(sheet, row)?;
    let [from, to] = contacts;
    let [_, ln_q] = along.at((u_of(&sheet.rod, end.tau) - from) / (to - from));
    Some(end.load.abs() * end.tau * end.tau * libm::exp(-ln_q))
}

/// Shoots the trajectories of a tensor of this `size`.
fn tensor(
    sheet: &Sheet,
    reader: &Reader,
    size: NetSize,
    along: &Chebyshev<2>,
    top: f64,
) -> ChebyshevTensor<FUNCTIONS> {
    let case = SheetCase {
        method: sheet.method,
        rod: &sheet.rod,
        side: sheet.side,
    };
    let sign = sheet.side.sign();
    let loads = chebyshev_points(size.loads);
    let contacts = chebyshev_points(size.contacts).iter().map(|part| {
        let [ln_tau, ln_q] = along.at(*part);
        let tau = libm::exp(ln_tau);
        (tau, sign * top * libm::exp(ln_q) / (tau * tau))
    });
    let contacts: Vec<(f64, f64)> = contacts.collect();
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
            let mut values: Vec<Functions> = Vec::with_capacity(states.len());
            for state in states {
                phi = nearest_turn(state.pole.to_angle(), phi);
                let numbers = reader.numbers(*tau, state, phi, chord);
                chord = numbers.chord;
                let [x, y] = numbers.position;
                let lever = numbers.force.abs() * numbers.arclength;
                values.push([
                    libm::log(state.pole.length()),
                    phi,
                    numbers.contact_angle,
                    x,
                    y,
                    chord,
                    numbers.energy / lever,
                ]);
            }
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
    use crate::rod::{Rod, Side};
    use crate::sheet::Edge;
    use crate::sheet::net::NET_RESIDUAL as MOST;
    use crate::shooting::batch::Method;

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
        let rows = (0..60).filter_map(|row| PanelRow::new(&sheet, row));
        let rows = rows.collect();
        (sheet, rows)
    }

    fn panel(sheet: &Sheet, rows: &[PanelRow]) -> NetPanel {
        let last = rows.iter().map(|own| own.contacts[1]);
        let contacts = [rows[0].contacts[0], last.fold(0.0, f64::max)];
        let size = NetSize {
            contacts: 28,
            loads: 24,
        };
        let panel = NetPanel::new(sheet, rows, contacts, size, MOST);
        panel.unwrap_or_else(|_| panic!("refused"))
    }

    fn bound(sheet: &Sheet, rows: &[PanelRow], panel: &NetPanel) -> f64 {
        certified(sheet, &panel.reader, panel, rows, 0.0)
    }

    /// The tensor of a panel with all its coefficients.
    fn whole(sheet: &Sheet, panel: &NetPanel) -> ChebyshevTensor<FUNCTIONS> {
        tensor(sheet, &panel.reader, panel.size, &panel.along, panel.top)
    }

    fn with_tensor(panel: &NetPanel, tensor: ChebyshevTensor<FUNCTIONS>) -> NetPanel {
        NetPanel {
            columns: tensor.columns(chebyshev_points(panel.size.columns())),
            tensor,
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
        let NetSize { contacts, loads } = sound.size;
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
        let NetSize { contacts, loads } = sound.size;
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
                let [in_u, in_p] = spoiled.tails().map(|tail| tail.last);
                let error = certified(&sheet, &sound.reader, &spoiled, &rows, larger(in_u, in_p));
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
        let by_decay = |error: f64| certified(&sheet, &sound.reader, &sound, &rows, error);
        assert_eq!(by_decay(1e-6), 4e-6);
        let own = by_decay(0.0);
        assert!((1e-12..1e-10).contains(&own), "{own:e}");
        let spoiled = |function: usize, change: f64| {
            let mut tensor = sound.tensor.clone();
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
