//! Panels of a net: one tensor of trajectories over the contacts of neighbouring rows.

use super::bound::largest;
use super::size::{NetSize, NetTail};
use crate::sheet::case::SheetCase;
use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::fold::coordinate::{tau_of, u_of};
use crate::sheet::{Crossing, Row};
use whiskmap_mechanics::numerics::expansion::{Chebyshev, chebyshev_points};
use whiskmap_mechanics::numerics::tensor::{ChebyshevTensor, LevelBlock, TensorColumns};
use whiskmap_mechanics::rod::Rod;

/// Number of points of `ln q` as a function of `u`: the scale of the load need only be smooth.
const SCALE: usize = 9;

/// A row that ends early gets columns for its shorter range. Their number is the panel's, times `[0] + [1] * (the row's range of loads over the
/// panel's)`. On a shorter range, fewer are as accurate; the last coefficients of the row show it.
const EARLY: [f64; 2] = [0.5, 0.5];

/// Smallest part of a panel's largest load at which a row has the columns of the panel. A row with a smaller load at its end gets its own.
const SHARED: f64 = 0.95;

/// Weighted coefficient below which a polynomial of the load ends: below the rounding of the states.
const ROUNDING: f64 = 1e-15;

/// Largest part of the load in a panel. The scale is a polynomial of low degree near the loads of the folds, so the fold lies a little below or
/// above 1.
pub const TOP: f64 = 1.03;

/// Panel: a tensor of functions of states, the first of which is `ln D`.
#[derive(Clone, Debug)]
pub struct NetPanel<const F: usize> {
    /// Size of the tensor.
    pub size: NetSize,
    /// First and last contact coordinate `u` of the panel.
    pub contacts: [f64; 2],
    /// Functions `[ln tau, ln q]` of the part of the range of contacts.
    pub along: Chebyshev<2>,
    /// Functions over the parts of the ranges of contacts and loads.
    pub tensor: ChebyshevTensor<F>,
    /// Columns that rows with large loads share.
    columns: TensorColumns<F>,
}

/// Points of a row in a panel, on columns at Chebyshev points of a range of loads.
#[derive(Clone, Debug)]
pub struct PanelLine<const F: usize> {
    /// Points of the row, in blocks of columns.
    pub points: Vec<LevelBlock<F, 2>>,
    /// Parts `p` of the load at the columns: `[column]`.
    pub parts: Vec<f64>,
    /// Place of the row's end in the range of loads, in `[0, 1]`.
    pub end: f64,
}

/// Returns `ln tau` and `ln q` over the `range` of contacts by this number of `points`, where `q` is near the fold's `|load| tau^2`.
pub fn along(rod: &Rod, contacts: &ContactNodes, range: [f64; 2], points: usize) -> Chebyshev<2> {
    let u_at = |part: f64| range[0] + part * (range[1] - range[0]);
    let scale = chebyshev_points(SCALE).iter();
    let scale = scale.map(|part| [contacts.fold_ln_q(u_at(*part))]);
    let scale = Chebyshev::through(&scale.collect::<Vec<_>>());
    let mut tau = 1.0;
    let both = chebyshev_points(points).iter().map(|part| {
        tau = tau_of(rod, u_at(*part), tau);
        let [ln_q] = scale.at(*part);
        [libm::log(tau), ln_q]
    });
    Chebyshev::through(&both.collect::<Vec<_>>())
}

/// Returns the contacts of a panel of `size` with their signed loads at [`TOP`]: `(tau, load)`.
pub fn contacts_of(case: SheetCase, size: NetSize, along: &Chebyshev<2>) -> Vec<(f64, f64)> {
    let top = case.side.sign() * TOP;
    let contacts = chebyshev_points(size.contacts).iter().map(|part| {
        let [ln_tau, ln_q] = along.at(*part);
        let tau = libm::exp(ln_tau);
        (tau, top * libm::exp(ln_q) / (tau * tau))
    });
    contacts.collect()
}

impl<const F: usize> NetPanel<F> {
    /// Creates the panel of a `tensor` of `size` over the range of `contacts`; its rows have `columns`.
    pub fn new(
        contacts: [f64; 2],
        along: Chebyshev<2>,
        size: NetSize,
        tensor: ChebyshevTensor<F>,
        columns: usize,
    ) -> Self {
        Self { size, contacts, along, columns: tensor.columns(chebyshev_points(columns)), tensor }
    }

    /// Removes the coefficients that are below rounding from the tensor; `weights` convert errors of the functions to whisker lengths.
    pub fn shorten(&mut self, weights: &[f64; F]) {
        self.tensor.shorten(|terms| largest(terms, weights) < ROUNDING);
    }

    /// Returns the sizes of the last coefficients in both coordinates; `weights` convert errors of the functions to whisker lengths.
    pub fn tails(&self, weights: &[f64; F]) -> [NetTail; 2] {
        self.tensor.tails().map(|tails| {
            let [last, before] = tails.map(|tail| largest(&tail, weights));
            NetTail { last, before }
        })
    }

    /// Returns the place of the contact at `tau` of `rod` in the range of contacts: in `[0, 1]` inside the panel.
    pub fn place(&self, rod: &Rod, tau: f64) -> f64 {
        let [from, to] = self.contacts;
        (u_of(rod, tau) - from) / (to - from)
    }

    /// Returns the part `p` of the load at `crossing`, a point of the edge of a sheet of `rod`; NaN outside the panel.
    pub fn part(&self, rod: &Rod, crossing: &Crossing) -> f64 {
        let place = self.place(rod, crossing.tau);
        if !(0.0..=1.0).contains(&place) {
            return f64::NAN;
        }
        let [_, ln_q] = self.along.at(place);
        crossing.load.abs() * crossing.tau * crossing.tau * libm::exp(-ln_q)
    }

    /// Returns the points of `row` between two parts of the load, the first of which is 0 at first touch; `None` if the row is not in the panel
    /// there.
    pub fn line(&self, row: &Row, [from, to]: [f64; 2]) -> Option<PanelLine<F>> {
        let [from, to] = [from, to].map(|part| part / TOP);
        let is_inside = [from, to].iter().all(|place| (0.0..=1.0).contains(place));
        if !is_inside {
            return None;
        }
        let shared = (from == 0.0 && to >= SHARED)
            .then(|| self.line_on(&self.columns, row, [0.0, 1.0], to))
            .flatten();
        shared.or_else(|| {
            let range = to - from;
            let count = (EARLY[0] + EARLY[1] * range.abs()) * self.columns.count() as f64;
            // A part of the loads is a small number.
            let places = chebyshev_points(count.ceil() as usize).iter();
            let places: Vec<f64> = places.map(|point| from + point * range).collect();
            self.line_on(&self.tensor.columns(&places), row, [from, to], 1.0)
        })
    }

    /// Returns the points of `row` on columns over a range of places of the load; the row ends at the place `end` of the range.
    fn line_on(
        &self,
        columns: &TensorColumns<F>,
        row: &Row,
        [from, to]: [f64; 2],
        end: f64,
    ) -> Option<PanelLine<F>> {
        let points = columns.level(libm::log(row.pole_distance), &self.along)?;
        let parts = chebyshev_points(columns.count()).iter();
        let parts = parts.map(|point| TOP * (from + point * (to - from)));
        Some(PanelLine { points, parts: parts.collect(), end })
    }
}
