//! The lattice of trajectories over the stable sheet, and guesses from it.
//!
//! Nodes lie at the columns and at the loads `x = 0, 1/24, 2/24, ...` of the fold's load, two steps beyond the
//! fold, so that interpolation is as good at the fold as elsewhere, and that good that most guesses are a last Newton
//! step away from the state. A row of a map is a level curve of `D` on the lattice; along it the push angle grows from
//! first touch to detachment.

use super::columns::Columns;
use super::polynomial::{NODES, Polynomial, stencil};
use super::rows::Row;
use crate::model::batch::{Launch, Method, land};
use crate::model::{First, Nystrom8, Rod, Side, nearest_turn};

/// Steps in load from first touch to the fold.
const LOADS: usize = 24;

/// Nodes per column: two lie beyond the fold.
const NODES_PER_COLUMN: usize = LOADS + 3;

/// `(ln D, phi)` at the nodes.
#[derive(Clone, Debug)]
pub struct Lattice {
    side: Side,
    /// `ln_distance[m][k]`: load step `m`, column `k`.
    ln_distance: Vec<Vec<f64>>,
    phi: Vec<Vec<f64>>,
}

/// A guess for one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
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
        let landings = land::<Nystrom8, First>(method, &launches);
        let rows = || landings.chunks(columns.folds.len());
        let ln_distance = rows()
            .map(|row| row.iter().map(|l| l.pole.length().ln()).collect())
            .collect();
        let mut phi: Vec<Vec<f64>> = rows()
            .map(|row| row.iter().map(|l| l.pole.to_angle()).collect())
            .collect();
        for m in 1..phi.len() {
            for k in 0..phi[m].len() {
                phi[m][k] = nearest_turn(phi[m][k], phi[m - 1][k]);
            }
        }
        Self {
            side,
            ln_distance,
            phi,
        }
    }

    /// Direction of the pole at the fold, column by column, continuous from first touch.
    #[must_use]
    pub fn phi_at_fold(&self) -> &[f64] {
        &self.phi[LOADS]
    }

    /// The level curve of `row` on the lattice.
    #[must_use]
    pub fn level(&self, columns: &Columns, row: &Row) -> Level {
        let target = row.pole_distance.ln();
        let mut level = Level::default();
        let mut last: Option<usize> = None;
        for m in 0..NODES_PER_COLUMN {
            let ln_distance = &self.ln_distance[m];
            let crossings = ln_distance
                .windows(2)
                .enumerate()
                .filter(|(_, ends)| (ends[0] <= target) != (ends[1] <= target))
                .map(|(k, _)| k);
            let Some(k) = crossings.min_by_key(|k| last.map_or(0, |last| last.abs_diff(*k))) else {
                if level.nodes.is_empty() {
                    continue;
                }
                break;
            };
            if level.nodes.is_empty() {
                level.first = m;
            }
            last = Some(k);
            let start = stencil::<NODES>(k, ln_distance.len());
            let local =
                |values: &[f64]| Polynomial::through(values[start..].iter().take(NODES).copied());
            let offset = (k - start) as f64;
            let rising = ln_distance[k] <= target;
            let between = [offset, offset + 1.0];
            let t = local(ln_distance).solve(target, offset + 0.5, between, rising);
            let (tau, fold_load) = columns.at(start, t);
            let phi = local(&self.phi[m]).at(t).0;
            level.nodes.push(Node {
                push: self.side.sign() * (phi - row.touch),
                tau,
                load: self.side.sign() * fold_load * m as f64 / LOADS as f64,
            });
        }
        level
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    push: f64,
    tau: f64,
    load: f64,
}

/// A level curve of `D`, sampled at steps of load.
#[derive(Clone, Debug, Default)]
pub struct Level {
    /// Load step of the first node.
    first: usize,
    nodes: Vec<Node>,
}

/// How far beyond the lattice's own detachment angle, in radians, a guess is still made: many times the
/// interpolation error, so that no cell of the sheet is missed.
const MARGIN: f64 = 1e-3;

impl Level {
    /// Guesses for growing push angles (at least 0, in radians, as magnitudes); `None` outside the sheet.
    pub fn guesses(&self, pushes: impl Iterator<Item = f64>) -> Vec<Option<Guess>> {
        let n = self.nodes.len();
        if n < 2 {
            return pushes.map(|_| None).collect();
        }
        // The fold is the node at load step `LOADS`; intervals beyond it belong to the unstable sheet.
        let last = (LOADS - self.first.min(LOADS - 1)).min(n - 1);
        let mut interval = 0;
        let mut piece = Piece::new(self, 0, last == 1);
        pushes
            .map(|push| {
                while interval + 1 < last && push > self.nodes[interval + 1].push {
                    interval += 1;
                    piece = Piece::new(self, interval, interval + 1 == last);
                }
                piece.guess(push)
            })
            .collect()
    }
}

/// The level curve between two nodes. The first piece and the last one reach one step farther, the first one where its
/// polynomial still falls there, the last one up to the largest push angle of its own.
struct Piece {
    push: Polynomial,
    tau: Polynomial,
    load: Polynomial,
    /// Where it begins and ends, and the push angles there.
    ends: [f64; 2],
    pushes: [f64; 2],
    /// Where the last guess was, and how far it was from the one before, or from the beginning.
    near: f64,
    pace: f64,
}

impl Piece {
    fn new(level: &Level, interval: usize, is_last: bool) -> Self {
        let start = stencil::<NODES>(interval, level.nodes.len());
        let local = |f: fn(&Node) -> f64| {
            Polynomial::through(level.nodes[start..].iter().take(NODES).map(f))
        };
        let push = local(|node| node.push);
        let offset = (interval - start) as f64;
        let low = if interval == 0 && push.at(offset - 1.0).0 < push.at(offset).0 {
            offset - 1.0
        } else {
            offset
        };
        let high = if is_last {
            summit(&push, offset)
        } else {
            offset + 1.0
        };
        Self {
            tau: local(|node| node.tau),
            load: local(|node| node.load),
            ends: [low, high],
            pushes: [push.at(low).0, push.at(high).0],
            near: offset,
            pace: 0.0,
            push,
        }
    }

    fn guess(&mut self, push: f64) -> Option<Guess> {
        let ([low, high], [from, to]) = (self.ends, self.pushes);
        let t = if push < from {
            (push > from - MARGIN).then_some(low)?
        } else if push > to {
            (push < to + MARGIN).then_some(high)?
        } else {
            let near = (self.near + self.pace).clamp(low, high);
            self.push.solve(push, near, [low, high], true)
        };
        self.pace = t - self.near;
        self.near = t;
        Some(Guess {
            tau: self.tau.at(t).0,
            load: self.load.at(t).0,
        })
    }
}

/// Halvings: the push angle is flat at its summit, so that the place need not be known well.
const SUMMIT_ROUNDS: usize = 20;

/// Where the push angle is largest, within one step of the interval that begins at `offset`.
fn summit(push: &Polynomial, offset: f64) -> f64 {
    let (mut low, mut high) = (offset, offset + 2.0);
    if push.at(high).1 > 0.0 {
        return high;
    }
    for _ in 0..SUMMIT_ROUNDS {
        let middle = 0.5 * (low + high);
        if push.at(middle).1 > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
