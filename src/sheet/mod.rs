//! The stable sheet: where all the physics of a whisker on one side of a pole lives.
//!
//! The stable states form a rectangle in (contact, load) with the edges touch (no load), tip, fold (first
//! singular Jacobian) and base; its image in (distance, direction of the pole) is simple. So the edges alone
//! give the exact boundary of a regime map ([`Sheet::crossings`]), and a lattice of trajectories over the
//! rectangle gives every cell of the map a guess, or the certainty that it has no solution
//! ([`Sheet::guesses`]). The two are computed independently of each other.

mod continuation;
mod edges;
mod fold;
mod lattice;
mod row;

pub use continuation::branch_steps::{Walk, walk};
pub use continuation::level_curve::{LevelCurve, Node, ON_CURVE};
pub use edges::crossings::Crossing;
pub use edges::edge_newton::{Edge, Sought, Wanted, seek};
pub use fold::FoldPoint;
pub use lattice::guesses::Guess;
pub use row::Row;

use crate::rod::{Rest, Rod, Side};
use crate::shooting::ShootingMap;
use crate::shooting::batch::Method;
use continuation::pieces;
use edges::{Edges, crossings};
use fold::contact_nodes::Columns;
use lattice::Lattice;

/// How far below zero the load of an unloaded whisker may come out, relative to the fold's: at the soft tip of a
/// strongly curved cone the rounding of first touch (1e-13 of the length) is a load of 1e-8.
const UNLOADED: f64 = 1e-6;

/// The sheet of one whisker on one side, with the rows of a map.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The whisker and its pole.
    pub rod: Rod,
    /// The side.
    pub side: Side,
    /// `tau` and radius over the base radius at the tip.
    pub tip: [f64; 2],
    /// The rows.
    pub rows: Vec<Row>,
    /// Per row: where it leaves and enters the sheet. The end of a push from first touch comes first, if there is one;
    /// then the ends of each other piece of the row, in the direction of growing push angles.
    pub crossings: Vec<Vec<Crossing>>,
    method: Method,
    columns: Columns,
    lattice: Lattice,
    edges: Edges,
}

impl Sheet {
    /// The sheet of `rod`, computed by `method`, for rows at these distances (first touch, in whisker lengths); `None` if some
    /// contact has no fold, or no stable state at first touch, which no whisker is known for.
    #[must_use]
    pub fn new(method: Method, rod: &Rod, side: Side, distances: &[f64]) -> Option<Self> {
        let rest = Rest::new(rod);
        let rows: Vec<Row> = distances.iter().map(|d| Row::new(&rest, *d)).collect();
        let nearest = rows
            .iter()
            .min_by(|a, b| a.pole_distance.total_cmp(&b.pole_distance))?;
        let columns = Columns::new(method, rod, side, nearest)?;
        let lattice = Lattice::new(method.coarsely(), rod, side, &columns);
        let edges = Edges::new(method, rod, &rest, &columns, &lattice);
        let mut crossings = crossings::crossings(method, rod, side, &edges, &rows);
        let fold_grows = edges.fold_grows;
        for (row, crossings) in rows.iter().zip(&mut crossings) {
            let touches = row.is_reached();
            let pair = fold_grows && usize::from(touches) + crossings.len() == 2;
            if !(crossings.is_empty() || pair && crossings.iter().all(Crossing::is_sound)) {
                let level = LevelCurve {
                    method,
                    rod: *rod,
                    side,
                    row: *row,
                    forward: true,
                };
                *crossings = pieces::connect(&level, touches, crossings);
            }
        }
        let tip = rod.tau_tip();
        Some(Self {
            rod: *rod,
            side,
            tip: [tip, rod.radius(tip)],
            rows,
            crossings,
            method,
            columns,
            lattice,
            edges,
        })
    }

    /// The fold with the contact at the tip, where slip-off turns into pull-off; `None` if it is not found.
    #[must_use]
    pub fn fold_at_tip(method: Method, rod: &Rod, side: Side) -> Option<FoldPoint> {
        fold::first_folds(method, rod, side, &[rod.tau_tip()]).pop()?
    }

    /// The level curve of `row`.
    #[must_use]
    pub fn level(&self, row: usize) -> LevelCurve {
        LevelCurve {
            method: self.method,
            rod: self.rod,
            side: self.side,
            row: self.rows[row],
            forward: true,
        }
    }

    /// Whether the whisker at rest reaches the pole of `row`.
    #[must_use]
    pub fn touches(&self, row: usize) -> bool {
        self.rows[row].is_reached()
    }

    /// How far from the tip, in `tau`, the integration cannot tell a contact from one at the tip.
    #[must_use]
    pub fn tip_blur(&self) -> f64 {
        2.0 * self.edges.tip_error
    }

    /// Guesses for the cells of `row` at growing `pushes` (magnitudes, in radians); `None` outside the sheet.
    pub fn guesses(&self, row: usize, pushes: impl Iterator<Item = f64>) -> Vec<Option<Guess>> {
        self.lattice
            .level(&self.columns, &self.rows[row])
            .guesses(pushes)
    }

    /// Whether a state, as far as the fold goes, is on the sheet: loaded toward the pole, on the stable side of
    /// the Jacobian's first singularity.
    #[must_use]
    pub fn is_stable(&self, tau: f64, load: f64, map: &ShootingMap) -> bool {
        let load = self.side.sign() * load;
        let is_loaded = load >= 0.0 && self.columns.is_below_folds(tau, load) || {
            let part = load / self.columns.fold_load(tau);
            part > -UNLOADED && part < 1.0 + 1e-4
        };
        let scale = map.by_tau.length() * map.by_load.length();
        is_loaded && map.det() > -1e-7 * scale
    }
}
