//! Numbers at the nodes of a grid: levers of moment and force, sizes and directions of forces, and the misses of a pair of wanted numbers.

use super::newton::{lever, lever_by};
use glam::{DVec2, DVec3};
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::FirstVariation;

/// Indices of the two numbers of each pair in `[M, Fx, Fy]`.
pub const PAIRS: [[usize; 2]; 3] = [[0, 2], [0, 1], [1, 2]];

/// Sine of the angle between the gradients of a pair of numbers below which its sign is rounding.
const SINE_ROUNDING: f64 = 1e-9;

/// Largest sine of the angle between the gradients of a pair that determines no state.
const DEPENDENT: f64 = 1e-7;

/// Bits of the signs at a node: of both misses, and of the Jacobian if it is positive or negative.
pub const ACROSS: u8 = 1;
pub const ALONG: u8 = 2;
pub const POSITIVE: u8 = 4;
pub const NEGATIVE: u8 = 8;

/// Levers of moment and force at the nodes of a grid, with a clamped base or in the follicle.
pub struct NodeLevers {
    /// Levers of the moment, and of the force along the first and the second axis, `[number][node]`.
    levers: [Vec<f64>; 3],
    /// Signed forces at the contact, `[node]`.
    forces: Vec<f64>,
    /// Sine of the angle between the gradients of each pair of numbers, by its index in [`PAIRS`], up to a factor of the order of 1:
    /// `[pair][node]`. 0 if it is rounding.
    pub sines: [Vec<f64>; 3],
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

/// Pair of numbers that are searched: a first one, and a sum of two others.
pub struct SearchedPair<'a> {
    /// Lever of the first number, `[node]`.
    first: &'a [f64],
    /// Levers of the two others, `[node]`.
    others: [&'a [f64]; 2],
    /// Sines of the first number with each of the others, `[node]`.
    sines: [&'a [f64]; 2],
    /// Signed forces at the contact, `[node]`.
    forces: &'a [f64],
    /// Factors of the two others.
    axis: DVec2,
    wanted: DVec2,
}

impl<'a> SearchedPair<'a> {
    /// Creates the pair of the moment and the force along an `axis`.
    pub fn of_moment(nodes: &'a NodeLevers, axis: DVec2, wanted: DVec2) -> Self {
        let [moment, x, y] = &nodes.levers;
        let [by_y, by_x, _] = &nodes.sines;
        Self {
            first: moment,
            others: [x, y],
            sines: [by_x, by_y],
            forces: &nodes.forces,
            axis,
            wanted,
        }
    }

    /// Creates the pair of both forces.
    pub fn of_forces(nodes: &'a NodeLevers, wanted: DVec2) -> Self {
        let [_, x, y] = &nodes.levers;
        let [.., sines] = &nodes.sines;
        Self {
            first: x,
            others: [x, y],
            sines: [sines; 2],
            forces: &nodes.forces,
            axis: DVec2::Y,
            wanted,
        }
    }

    /// Returns the misses of a node from its levers and its force: `[across, along]`.
    #[inline(always)]
    fn misses_of(&self, first: f64, x: f64, y: f64, force: f64) -> DVec2 {
        let lever = DVec2::new(first, self.axis.x * x + self.axis.y * y);
        let size = force * lever.length_squared();
        DVec2::new(lever.perp_dot(self.wanted), size - lever.dot(self.wanted))
    }

    /// Writes the signs of all nodes, `[node]`.
    pub fn signs(&self, signs: &mut Vec<u8>) {
        let [x, y] = self.others;
        let [one, other] = self.sines;
        let levers = self.first.iter().zip(x).zip(y).zip(self.forces);
        let nodes = levers.zip(one).zip(other);
        signs.clear();
        signs.extend(nodes.map(|(((((first, x), y), force), one), other)| {
            let misses = self.misses_of(*first, *x, *y, *force);
            let sine = self.axis.x * one + self.axis.y * other;
            (u8::from(misses.x > 0.0) * ACROSS)
                | (u8::from(misses.y > 0.0) * ALONG)
                | (u8::from(sine > 0.0) * POSITIVE)
                | (u8::from(sine < 0.0) * NEGATIVE)
        }));
    }

    /// Returns the misses at a node: `[across, along]`.
    pub fn misses(&self, node: usize) -> DVec2 {
        let [x, y] = self.others;
        self.misses_of(self.first[node], x[node], y[node], self.forces[node])
    }
}

/// Returns the cells with these indices `[contact, part]` and their neighbours, by the index of the first node, in a grid with so many contacts and
/// parts.
pub fn neighbours(cells: &[[usize; 2]], [contacts, parts]: [usize; 2]) -> Vec<usize> {
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
    pub fn new(rod: &Rod, nodes: &[FirstVariation]) -> Self {
        let levers = nodes.iter().map(|node| lever(&node.full));
        let levers: Vec<DVec3> = levers.collect();
        // The gradients by contact and load, over the force and without it.
        let gradients = nodes.iter().zip(&levers).map(|(node, lever)| {
            let full = &node.full;
            let by_tau = lever_by(full, &node.by_tau) - 2.0 * rod.taper * *lever;
            let by_load = node.by_load.force * *lever + full.force * lever_by(full, &node.by_load);
            [by_tau, by_load]
        });
        let gradients: Vec<[DVec3; 2]> = gradients.collect();
        let mut is_determined = [false; 3];
        let sines = [0, 1, 2].map(|pair| {
            let sine = |gradients: &[DVec3; 2]| {
                let both = |of: DVec3| DVec2::from(PAIRS[pair].map(|i| of[i]));
                let [by_tau, by_load] = gradients.map(both);
                let det = by_tau.perp_dot(by_load);
                let sine = (det / (by_tau.length() * by_load.length())).abs();
                is_determined[pair] |= sine > DEPENDENT;
                // All pairs of a node have one scale, so that the sine of a turned axis is a sum.
                let scale = gradients[0].length() * gradients[1].length();
                if sine > SINE_ROUNDING {
                    det / scale
                } else {
                    0.0
                }
            };
            gradients.iter().map(sine).collect()
        });
        Self {
            levers: [0, 1, 2].map(|i| levers.iter().map(|lever| lever[i]).collect()),
            forces: nodes.iter().map(|node| node.full.force).collect(),
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
        let turns = forces.iter().zip(moments);
        let turns = turns.map(|(force, moment)| compliance * force * moment);
        let sign = |node: usize| [sines[node] > 0.0, sines[node] < 0.0];
        let contacts = forces.len() / parts;
        let all = (0..contacts.saturating_sub(1)).flat_map(|i| (0..parts - 1).map(move |k| [i, k]));
        let is_turn = |[i, k]: &[usize; 2]| {
            let cell = i * parts + k;
            let corners = [cell, cell + 1, cell + parts, cell + parts + 1].map(sign);
            [0, 1].map(|of| corners.iter().any(|signs| signs[of])) == [true, true]
        };
        let turned: Vec<[usize; 2]> = all.filter(is_turn).collect();
        Self {
            sizes: forces.iter().map(|force| force.abs()).collect(),
            angles: directions
                .iter()
                .zip(turns)
                .map(|(angle, turn)| angle + turn)
                .collect(),
            turns: neighbours(&turned, [contacts, parts]),
        }
    }
}
