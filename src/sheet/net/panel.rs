//! Panels of a net: one tensor of trajectories over the contacts of neighbouring rows.

use super::bound::{VALUE_WEIGHT, largest};
use super::row::{FUNCTIONS, NetRow, RowLine};
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
    pub contacts: [f64; 2],
    /// Largest part `p` of the load in the panel.
    pub top: f64,
    /// Functions `[ln tau, ln q]` of the part of the range of contacts.
    pub along: Chebyshev<2>,
    pub tensor: ChebyshevTensor<FUNCTIONS>,
    /// Columns at the Chebyshev points of all loads of the panel.
    pub columns: TensorColumns<FUNCTIONS>,
    pub reader: Reader,
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
    /// Computes the trajectories of `size` over the range of `contacts` of `rows` of `sheet`, without a certificate. `None` if the first folds are
    /// not known.
    pub fn new(
        sheet: &Sheet,
        rows: &[PanelRow],
        contacts: [f64; 2],
        size: NetSize,
    ) -> Option<Self> {
        let along = along(sheet, contacts)?;
        let part_of = |row: &PanelRow| end_part(sheet, row.row, contacts, &along);
        let parts = rows.iter().filter_map(part_of);
        let top = parts.fold(0.0, f64::max);
        let reader = Reader::new(NO_UNITS, &sheet.rod);
        let tensor = tensor(sheet, &reader, size, &along, top);
        Some(Self {
            size,
            residual: f64::NAN,
            contacts,
            top,
            along,
            columns: tensor.columns(chebyshev_points(size.columns())),
            tensor,
            reader,
        })
    }

    /// Removes the coefficients that are below rounding from the tensor.
    pub fn shorten(&mut self) {
        let weights = self.weights();
        self.tensor
            .shorten(|terms| largest(terms, &weights) < ROUNDING);
    }

    /// Sizes of the last coefficients in both coordinates.
    pub fn tails(&self) -> [NetTail; 2] {
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
pub fn tensor(
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
