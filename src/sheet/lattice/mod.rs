//! The lattice of trajectories over the stable sheet.
//!
//! Nodes lie at the columns and at [`LOADS`] loads from first touch to the fold, so many that most guesses are a last Newton
//! step away from the state. A row of a map is a level curve of `D` on the lattice; along it the push angle grows from
//! first touch to detachment.

mod bracket;
pub mod guesses;
mod simd_roots;

use crate::numerics::lobatto::{LOADS, PARTS};
use crate::numerics::nearest_turn;
use crate::numerics::newton_form::{oriented, stencil, through_slopes};
use crate::numerics::newton_form_simd::Numbers;
use crate::numerics::{Unit, WIDTH};
use crate::rod::{Rod, Side};
use crate::sheet::fold::contact_nodes::{AROUND, Columns, Line, TERMS, line};
use crate::sheet::lattice::guesses::Level;
use crate::sheet::lattice::simd_roots::{Across, Patch};
use crate::sheet::row::Row;
use crate::shooting::ShootingMap;
use crate::shooting::batch::{Batch, InitialCondition, Method};

/// Intervals between columns over which the loads of a row are looked for in one patch: one from its middle, interpolation is
/// half as good.
const SPAN: usize = 3;

/// The last step of Newton's method, in distances of columns: its square is left, and interpolation leaves more than that.
const LAST_STEP: f64 = 5e-5;

const _: () = assert!(LOADS <= WIDTH, "a row's loads go together");

/// The nodes.
#[derive(Clone, Debug)]
pub struct Lattice {
    side: Side,
    /// By column.
    nodes: Vec<Nodes>,
    /// By their first column.
    patches: Vec<Patch>,
}

/// The nodes of one column, by load.
#[derive(Clone, Copy, Debug)]
struct Nodes {
    ln_distance: Numbers,
    /// Direction of the pole, continuous from first touch.
    phi: Numbers,
    /// Slopes of both, per column.
    slopes: [Numbers; 2],
}

impl Nodes {
    /// The `maps`, load by load, at `column`.
    fn new<'a>(
        columns: &Columns,
        column: usize,
        maps: impl Iterator<Item = &'a ShootingMap> + Clone,
    ) -> Self {
        let mut nodes = Self {
            ln_distance: [0.0; WIDTH],
            phi: [0.0; WIDTH],
            slopes: [[0.0; WIDTH]; 2],
        };
        nodes.phi[..LOADS].copy_from_slice(&directions(columns.folds[column].load, maps.clone()));
        for (m, (map, part)) in maps.zip(PARTS.iter()).enumerate() {
            nodes.ln_distance[m] = map.pole.length().ln();
            [nodes.slopes[0][m], nodes.slopes[1][m]] = columns.slope(column, *part, map).to_array();
        }
        nodes
    }
}

impl Lattice {
    /// The lattice over `columns`.
    pub fn new(method: Method, rod: &Rod, side: Side, columns: &Columns) -> Self {
        let conditions: Vec<InitialCondition> = PARTS
            .iter()
            .flat_map(|part| {
                columns.folds.iter().map(move |fold| InitialCondition {
                    rod,
                    tau: fold.tau,
                    load: part * fold.load,
                })
            })
            .collect();
        let maps = Batch::new(method)
            .padded()
            .shoot::<ShootingMap>(&conditions);
        let count = columns.folds.len();
        let nodes: Vec<Nodes> = (0..count)
            .map(|column| {
                let of_column = maps[column..].iter().step_by(count);
                Nodes::new(columns, column, of_column)
            })
            .collect();
        let patches = patches(&nodes);
        Self {
            side,
            nodes,
            patches,
        }
    }

    /// Direction of the pole at the fold, column by column, continuous from first touch.
    pub fn phi_at_fold(&self) -> impl Iterator<Item = f64> {
        self.nodes.iter().map(|nodes| nodes.phi[LOADS - 1])
    }

    /// The column after which `ln D` crosses `target` at the load `m`; the one nearest to `near` if there are several.
    fn crossing(&self, m: usize, target: f64, near: usize) -> Option<usize> {
        let last = self.nodes.len() - 1;
        let is_before = |k: usize| self.nodes[k].ln_distance[m] <= target;
        let crosses = |k: usize| k < last && is_before(k) != is_before(k + 1);
        for away in 0..=last {
            if near >= away && crosses(near - away) {
                return Some(near - away);
            }
            if crosses(near + away) {
                return Some(near + away);
            }
        }
        None
    }

    /// The level curve of `row` on the lattice.
    #[must_use]
    pub fn level(&self, columns: &Columns, row: &Row) -> Level {
        let target = row.pole_distance.ln();
        let mut level = Level::default();
        let mut after = [0; LOADS];
        let mut near = 0;
        for (m, after) in after.iter_mut().enumerate() {
            let Some(k) = self.crossing(m, target, near) else {
                if level.count == 0 {
                    continue;
                }
                break;
            };
            if level.count == 0 {
                level.first = m;
            }
            near = k;
            *after = k;
            level.count += 1;
        }
        let end = level.first + level.count;
        let mut from = level.first;
        while from < end {
            let [mut low, mut high] = [after[from]; 2];
            let mut to = from + 1;
            while to < end && high.max(after[to]) - low.min(after[to]) < SPAN {
                [low, high] = [low.min(after[to]), high.max(after[to])];
                to += 1;
            }
            let start = stencil((low + high) / 2, AROUND, self.nodes.len());
            self.cross(columns, row, start, &after[from..to], from, &mut level);
            from = to;
        }
        level
    }

    /// Sets the nodes of `level` from the load `from` on, where `ln D` crosses that of `row` after the columns `after`.
    fn cross(
        &self,
        columns: &Columns,
        row: &Row,
        start: usize,
        after: &[usize],
        from: usize,
        level: &mut Level,
    ) {
        let (patch, target) = (&self.patches[start], row.pole_distance.ln());
        let between = |k: usize| {
            let offset = k as f64 - start as f64;
            [offset, offset + 1.0]
        };
        let mut near = [0.0; WIDTH];
        for (m, &k) in (from..).zip(after) {
            let [here, next] = [k, k + 1].map(|k| self.nodes[k].ln_distance[m]);
            near[m] = between(k)[0] + (target - here) / (next - here);
        }
        let (ln_tau, ln_q) = (&columns.ln_tau[start], &columns.ln_q[start]);
        let crossed = Unit::detect().run(Across {
            patch,
            ln_tau,
            ln_q,
            target,
            near,
        });
        let sign = self.side.sign();
        for (m, &k) in (from..).zip(after) {
            let place = crossed.place[m];
            let [low, high] = between(k);
            let is_known = crossed.step[m].abs() < LAST_STEP && low <= place && place <= high;
            let [phi, tau, q] = if is_known {
                [crossed.phi[m], crossed.tau[m], crossed.q[m]]
            } else {
                let lane = |differences: &[Numbers; TERMS]| line(differences.map(|term| term[m]));
                let distances = lane(&patch.ln_distance);
                let ends = oriented(
                    [low, high],
                    [k, k + 1].map(|k| self.nodes[k].ln_distance[m]),
                );
                let place = distances.solve(target, near[m], ends, LAST_STEP);
                let at = |line: &Line| line.at(place).0;
                [at(&lane(&patch.phi)), at(ln_tau).exp(), at(ln_q).exp()]
            };
            let i = m - level.first;
            level.push[i] = sign * (phi - row.touch);
            level.tau[i] = tau;
            level.load[i] = sign * q / (tau * tau) * PARTS[m];
        }
    }
}

/// Through each [`AROUND`] neighbours of `nodes`, or through all where there are fewer.
fn patches(nodes: &[Nodes]) -> Vec<Patch> {
    let lines = |value: fn(&Nodes) -> Numbers, slope: usize| {
        let values: Vec<Numbers> = nodes.iter().map(value).collect();
        let slopes: Vec<Numbers> = nodes.iter().map(|nodes| nodes.slopes[slope]).collect();
        through_slopes(&values, &slopes).into_iter()
    };
    lines(|nodes| nodes.ln_distance, 0)
        .zip(lines(|nodes| nodes.phi, 1))
        .map(|(ln_distance, phi)| Patch { ln_distance, phi })
        .collect()
}

/// Directions of the pole, continuous from first touch, of `maps` of one contact under these parts of its fold's `load`.
pub fn directions<'a>(load: f64, maps: impl Iterator<Item = &'a ShootingMap>) -> [f64; LOADS] {
    let mut phis = [0.0; LOADS];
    let mut before: Option<(&ShootingMap, f64, f64)> = None;
    for (slot, (map, part)) in phis.iter_mut().zip(maps.zip(PARTS.iter())) {
        let near = before.map_or(0.0, |(there, phi, part_there)| {
            let slopes = there.by_load.y + map.by_load.y;
            0.5f64.mul_add(slopes * load * (part - part_there), phi)
        });
        let phi = nearest_turn(map.pole.to_angle(), near);
        before = Some((map, phi, *part));
        *slot = phi;
    }
    phis
}
