//! The lattice of trajectories over the stable sheet, and guesses from it.
//!
//! Nodes lie at the columns and at the loads `x = 0, 1/18, 2/18, ...` of the fold's load, two steps beyond the
//! fold, so that interpolation is as good at the fold as elsewhere, and that good that most guesses are a last Newton
//! step away from the state. A row of a map is a level curve of `D` on the lattice; along it the push angle grows from
//! first touch to detachment.

use super::abreast::{self, Search};
use super::columns::Columns;
use super::guess::Level;
use super::polynomial::{NODES, Polynomial, stencil};
use super::rows::Row;
use crate::model::batch::{Launch, Method, land_in_company};
use crate::model::{First, Landing, Nystrom8, Rod, Side, nearest_turn};

/// Steps in load from first touch to the fold.
pub const LOADS: usize = 18;

/// Nodes per column: two lie beyond the fold.
const NODES_PER_COLUMN: usize = LOADS + 3;

/// The nodes, by load.
#[derive(Clone, Debug)]
pub struct Lattice {
    side: Side,
    steps: Vec<Step>,
}

/// The nodes of one load.
#[derive(Clone, Debug)]
struct Step {
    /// `ln D` at each column.
    ln_distances: Vec<f64>,
    /// Direction of the pole at each, continuous from first touch.
    phis: Vec<f64>,
    /// Polynomials through `ln D`, by their first column.
    ln_distance: Vec<Polynomial>,
    /// Those through the direction.
    phi: Vec<Polynomial>,
}

impl Step {
    /// `before` has the directions of the step before, if there is one.
    fn new(landings: &[Landing], before: Option<&[f64]>) -> Self {
        let ln_distances: Vec<f64> = landings.iter().map(|l| l.pole.length().ln()).collect();
        let mut phis: Vec<f64> = landings.iter().map(|l| l.pole.to_angle()).collect();
        for (phi, before) in phis.iter_mut().zip(before.unwrap_or_default()) {
            *phi = nearest_turn(*phi, *before);
        }
        Self {
            ln_distance: Polynomial::through_each(&ln_distances),
            phi: Polynomial::through_each(&phis),
            ln_distances,
            phis,
        }
    }

    /// The column after which `ln D` crosses `target`; the one nearest to `near` if there are several.
    fn crossing(&self, target: f64, near: usize) -> Option<usize> {
        let last = self.ln_distances.len() - 1;
        let crosses = |k: &usize| {
            *k < last && (self.ln_distances[*k] <= target) != (self.ln_distances[*k + 1] <= target)
        };
        let around = |away: usize| [near.checked_sub(away), Some(near + away)];
        (0..=last).flat_map(around).flatten().find(crosses)
    }
}

impl Lattice {
    /// The lattice over `columns`.
    pub fn new(method: Method, rod: &Rod, side: Side, columns: &Columns) -> Self {
        let launches: Vec<Launch> = (0..NODES_PER_COLUMN)
            .flat_map(|m| {
                let part = m as f64 / LOADS as f64;
                columns.folds.iter().map(move |fold| Launch {
                    rod: *rod,
                    tau: fold.tau,
                    load: part * fold.load,
                })
            })
            .collect();
        let landings = land_in_company::<Nystrom8, First>(method, &launches);
        let mut steps: Vec<Step> = Vec::with_capacity(NODES_PER_COLUMN);
        for landings in landings.chunks(columns.folds.len()) {
            let before = steps.last().map(|step| step.phis.as_slice());
            steps.push(Step::new(landings, before));
        }
        Self { side, steps }
    }

    /// Direction of the pole at the fold, column by column, continuous from first touch.
    #[must_use]
    pub fn phi_at_fold(&self) -> &[f64] {
        &self.steps[LOADS].phis
    }

    /// The level curve of `row` on the lattice.
    #[must_use]
    pub fn level(&self, columns: &Columns, row: &Row) -> Level {
        let target = row.pole_distance.ln();
        let mut first = 0;
        let mut starts = Vec::with_capacity(NODES_PER_COLUMN);
        let mut searches = Vec::with_capacity(NODES_PER_COLUMN);
        let mut near = 0;
        for (m, step) in self.steps.iter().enumerate() {
            let Some(k) = step.crossing(target, near) else {
                if starts.is_empty() {
                    continue;
                }
                break;
            };
            if starts.is_empty() {
                first = m;
            }
            near = k;
            let start = stencil::<NODES>(k, step.ln_distances.len());
            let offset = (k - start) as f64;
            let [from, to] = [step.ln_distances[k], step.ln_distances[k + 1]];
            starts.push(start);
            searches.push(Search {
                polynomial: &step.ln_distance[start],
                target,
                near: offset + (target - from) / (to - from),
                between: [offset, offset + 1.0],
            });
        }
        let found = abreast::solve(&searches);
        let places = || starts.iter().copied().zip(found.iter().copied());
        let phi = places().zip(&self.steps[first..]);
        let phi = abreast::values(phi.map(|((start, t), step)| (&step.phi[start], t)));
        let ln_tau = abreast::values(places().map(|(start, t)| (&columns.ln_tau[start], t)));
        let ln_q = abreast::values(places().map(|(start, t)| (&columns.ln_q[start], t)));
        let sign = self.side.sign();
        let load = |(m, (ln_q, ln_tau)): (usize, (&f64, &f64))| {
            sign * (ln_q - 2.0 * ln_tau).exp() * m as f64 / LOADS as f64
        };
        Level {
            first,
            push: phi.iter().map(|phi| sign * (phi - row.touch)).collect(),
            tau: ln_tau.iter().map(|ln_tau| ln_tau.exp()).collect(),
            load: (first..).zip(ln_q.iter().zip(&ln_tau)).map(load).collect(),
        }
    }
}
