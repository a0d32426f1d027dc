//! Numbers at the nodes of a grid: levers of moment and force, sizes and directions of forces, and the misses of a pair of wanted numbers.

use super::newton::{lever, lever_by};
use glam::{DVec2, DVec3};
use std::borrow::Cow;
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::FirstVariation;

/// Indices of the two numbers of each pair in `[M, Fx, Fy]`.
pub const PAIRS: [[usize; 2]; 3] = [[0, 2], [0, 1], [1, 2]];

/// Sine of the angle between the gradients of a pair of numbers below which its sign is rounding.
const SINE_ROUNDING: f64 = 1e-9;

/// Largest sine of the angle between the gradients of a pair that determines no state.
const DEPENDENT: f64 = 1e-7;

/// Bit of a positive miss across the lever.
pub const ACROSS: u8 = 1;

/// Bit of a positive miss along the lever.
pub const ALONG: u8 = 2;

/// Levers of moment and force at the nodes of a grid, with a clamped base or in the follicle.
pub struct NodeLevers {
    /// Levers of the moment, and of the force along the first and the second axis, `[number][node]`.
    levers: [Vec<f64>; 3],
    /// Signed forces at the contact, `[node]`.
    forces: Vec<f64>,
    /// Sine of the angle between the gradients of each pair of numbers, by its index in [`PAIRS`], up to a factor of the order of 1:
    /// `[pair][node]`. 0 if it is rounding.
    pub sines: [Vec<f64>; 3],
    /// Cells in which a pair's Jacobian is singular, and their neighbours: `[pair]`, by the index of the first node.
    turns: [Vec<usize>; 3],
    /// False for a pair of which one number follows from the other, `[pair]`.
    pub is_determined: [bool; 3],
}

/// Size and direction of the force at the nodes of a grid, in the frame of the follicle.
pub struct NodeForces {
    /// Sizes of the forces, `[node]`.
    pub sizes: Vec<f64>,
    /// Angles of the forces from the axis of the follicle in radians, continuous between neighbours, `[node]`.
    pub angles: Vec<f64>,
    /// Cells with a singular Jacobian of both forces and their neighbours, by the index of the first node.
    pub turns: Vec<usize>,
}

/// Pair of numbers that are searched.
pub struct SearchedPair<'a> {
    /// Lever of the first number, `[node]`.
    first: &'a [f64],
    second: SecondNumber<'a>,
    /// Signed forces at the contact, `[node]`.
    forces: &'a [f64],
    wanted: DVec2,
}

/// Second number of a searched pair.
enum SecondNumber<'a> {
    /// Number in the frame of the clamped base: its lever, `[node]`, and the cells with a singular Jacobian and their neighbours.
    OfBase { lever: &'a [f64], turns: &'a [usize] },
    /// Force along an axis in this frame: the levers of both components, `[component][node]`, and their sines with the first number.
    AlongAxis { axis: DVec2, levers: [&'a [f64]; 2], sines: [&'a [f64]; 2] },
}

impl<'a> SearchedPair<'a> {
    /// Creates the pair with this index in [`PAIRS`], with `wanted` numbers in a frame from which the base has turned by `turn`, in radians.
    pub fn new(nodes: &'a NodeLevers, pair: usize, turn: f64, wanted: DVec2) -> Self {
        let [first, second] = PAIRS[pair];
        let [moment, x, y] = &nodes.levers;
        let turned = DVec2::from_angle(turn);
        let axis = if second == 1 { DVec2::X } else { DVec2::Y };
        let is_of_forces = first != 0;
        let [by_y, by_x, _] = &nodes.sines;
        Self {
            first: if is_of_forces { x } else { moment },
            second: if is_of_forces || turn == 0.0 {
                SecondNumber::OfBase { lever: &nodes.levers[second], turns: &nodes.turns[pair] }
            } else {
                SecondNumber::AlongAxis {
                    axis: turned.rotate(axis),
                    levers: [x, y],
                    sines: [by_x, by_y],
                }
            },
            forces: &nodes.forces,
            wanted: if is_of_forces { turned.rotate(wanted) } else { wanted },
        }
    }

    /// Returns the misses of a node from its levers and its force: `[across, along]`.
    #[inline(always)]
    fn misses_of(&self, lever: DVec2, force: f64) -> DVec2 {
        let size = force * lever.length_squared();
        DVec2::new(lever.perp_dot(self.wanted), size - lever.dot(self.wanted))
    }

    /// Writes the `signs` of the misses at all nodes, `[node]`, of a grid with so many `parts` at each contact. Returns the cells with a singular
    /// Jacobian and their neighbours, by the index of the first node.
    pub fn signs(&self, parts: usize, signs: &mut Vec<u8>) -> Cow<'a, [usize]> {
        let bits = |first: f64, second: f64, force: f64| {
            let misses = self.misses_of(DVec2::new(first, second), force);
            (u8::from(misses.x > 0.0) * ACROSS) | (u8::from(misses.y > 0.0) * ALONG)
        };
        let nodes = self.first.iter().zip(self.forces);
        signs.clear();
        match self.second {
            SecondNumber::OfBase { lever, turns } => {
                let nodes = nodes.zip(lever);
                signs.extend(nodes.map(|((first, force), second)| bits(*first, *second, *force)));
                Cow::Borrowed(turns)
            }
            SecondNumber::AlongAxis { axis, levers: [x, y], sines: [by_x, by_y] } => {
                let along = |x: f64, y: f64| axis.x * x + axis.y * y;
                let nodes = nodes.zip(x).zip(y);
                signs.extend(
                    nodes.map(|(((first, force), x), y)| bits(*first, along(*x, *y), *force)),
                );
                let sines = by_x.iter().zip(by_y).map(|(x, y)| along(*x, *y));
                Cow::Owned(turns(sines, parts))
            }
        }
    }

    /// Returns the misses at a node: `[across, along]`.
    pub fn misses(&self, node: usize) -> DVec2 {
        let second = match self.second {
            SecondNumber::OfBase { lever, .. } => lever[node],
            SecondNumber::AlongAxis { axis, levers: [x, y], .. } => {
                axis.x * x[node] + axis.y * y[node]
            }
        };
        self.misses_of(DVec2::new(self.first[node], second), self.forces[node])
    }
}

/// Returns the cells in which the `sines` of a pair, `[node]`, change their sign, and their neighbours, by the index of the first node. The grid has
/// so many `parts` at each contact.
fn turns(sines: impl ExactSizeIterator<Item = f64>, parts: usize) -> Vec<usize> {
    let contacts = sines.len() / parts;
    let signs: Vec<u8> =
        sines.map(|sine| u8::from(sine > 0.0) | u8::from(sine < 0.0) << 1).collect();
    let mut turned = Vec::new();
    let columns = signs.chunks(parts).zip(signs.chunks(parts).skip(1));
    for (i, (here, next)) in columns.enumerate() {
        let cells = here.windows(2).zip(next.windows(2)).enumerate();
        let cells = cells.filter(|(_, (here, next))| here[0] | here[1] | next[0] | next[1] == 3);
        turned.extend(cells.map(|(k, _)| [i, k]));
    }
    neighbours(&turned, [contacts, parts])
}

/// Returns the cells with these indices `[contact, part]` and their neighbours, by the index of the first node, in a grid with so many contacts and
/// parts.
fn neighbours(cells: &[[usize; 2]], [contacts, parts]: [usize; 2]) -> Vec<usize> {
    let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    let cells = cells.iter().flat_map(|&[i, k]| {
        let columns = around(i, contacts - 1);
        columns.flat_map(move |i| around(k, parts - 1).map(move |k| i * parts + k))
    });
    let mut cells: Vec<usize> = cells.collect();
    cells.sort_unstable();
    cells.dedup();
    cells
}

impl NodeLevers {
    /// Creates the levers of `rod` from its `nodes`, with so many `parts` at each contact.
    pub fn new(rod: &Rod, nodes: &[FirstVariation], parts: usize) -> Self {
        let levers: Vec<DVec3> = nodes.iter().map(|node| lever(&node.full)).collect();
        // The gradients by contact and load, over the force and without it.
        let gradients = nodes.iter().zip(&levers).map(|(node, lever)| {
            let full = &node.full;
            let by_tau = lever_by(full, &node.by_tau) - 2.0 * rod.taper * *lever;
            let by_load = node.by_load.force * *lever + full.force * lever_by(full, &node.by_load);
            [by_tau, by_load]
        });
        let gradients: Vec<[DVec3; 2]> = gradients.collect();
        let mut is_determined = [false; 3];
        let sines: [Vec<f64>; 3] = [0, 1, 2].map(|pair| {
            let sine = |gradients: &[DVec3; 2]| {
                let both = |of: DVec3| DVec2::from(PAIRS[pair].map(|i| of[i]));
                let [by_tau, by_load] = gradients.map(both);
                let det = by_tau.perp_dot(by_load);
                let sine = (det / (by_tau.length() * by_load.length())).abs();
                is_determined[pair] |= sine > DEPENDENT;
                // All pairs of a node have one scale, so that the sine of a turned axis is a sum.
                let scale = gradients[0].length() * gradients[1].length();
                if sine > SINE_ROUNDING { det / scale } else { 0.0 }
            };
            gradients.iter().map(sine).collect()
        });
        Self {
            levers: [0, 1, 2].map(|i| levers.iter().map(|lever| lever[i]).collect()),
            forces: nodes.iter().map(|node| node.full.force).collect(),
            turns: [0, 1, 2].map(|pair| turns(sines[pair].iter().copied(), parts)),
            sines,
            is_determined,
        }
    }
}

impl NodeForces {
    /// Creates the forces in a follicle of this compliance from the levers `in_clamp` and the `sines` of both forces, of nodes with so many
    /// `parts` at each contact.
    pub fn new(compliance: f64, in_clamp: &NodeLevers, sines: &[f64], parts: usize) -> Self {
        let [moments, x, y] = &in_clamp.levers;
        let forces = &in_clamp.forces;
        let mut directions: Vec<f64> = Vec::with_capacity(forces.len());
        for (node, force) in forces.iter().enumerate() {
            // Without a load, the direction is that of the smallest load.
            let loaded = if *force == 0.0 { node + 1 } else { node };
            let direction = DVec2::new(x[node], y[node]) * forces[loaded].signum();
            let before = match node % parts {
                0 => node.checked_sub(parts),
                _ => Some(node - 1),
            };
            let near = before.map_or(0.0, |before| directions[before]);
            directions.push(nearest_turn(direction.to_angle(), near));
        }
        let of_base = forces.iter().zip(moments);
        let of_base = of_base.map(|(force, moment)| compliance * force * moment);
        Self {
            sizes: forces.iter().map(|force| force.abs()).collect(),
            angles: directions.iter().zip(of_base).map(|(angle, turn)| angle + turn).collect(),
            turns: turns(sines.iter().copied(), parts),
        }
    }
}
