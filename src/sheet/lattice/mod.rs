//! The lattice of trajectories over the stable sheet, from which the guesses come.
//!
//! Its points lie at the contact nodes, and for each of them at Chebyshev-Lobatto nodes of the load from first touch to the fold:
//! so many that most guesses are a last Newton step away from the state. A row of a map is a level curve of `D` on the lattice;
//! along it the push angle grows from first touch to detachment.

mod row_span;

use crate::numerics::lobatto::{LOBATTO_COUNT, LOBATTO_NODES};
use crate::numerics::nearest_turn;
use crate::numerics::newton_form::through_slopes;
use crate::numerics::newton_form_simd::Numbers;
use crate::rod::{Rod, Side};
use crate::sheet::certificate::stays_positive;
use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::fold::coordinate::TERMS;
use crate::shooting::ShootingMap;
use crate::shooting::batch::{Batch, InitialCondition, Method};

/// The lattice.
#[derive(Clone, Debug)]
pub struct Lattice {
    side: Side,
    /// By contact node.
    lines: Vec<LoadLine>,
    /// By the first node of their stencils.
    patches: Vec<Patch>,
}

/// The points of one contact node, by load.
#[derive(Clone, Copy, Debug, Default)]
struct LoadLine {
    ln_distance: Numbers,
    /// Direction of the pole, continuous from first touch.
    phi: Numbers,
    /// Slopes of both, per contact node.
    slopes: [Numbers; 2],
    /// `det D^2` over that at first touch and the part of the load that is left to the fold: positive and smooth up to the fold.
    clearance: Numbers,
}

/// Along one stencil of contact nodes: Hermite polynomials by their divided differences, one for every load.
#[derive(Clone, Copy, Debug)]
struct Patch {
    ln_distance: [Numbers; TERMS],
    /// Of the direction of the pole.
    phi: [Numbers; TERMS],
}

impl LoadLine {
    /// The `maps`, load by load, at the contact node `i`.
    fn new<'a>(
        contacts: &ContactNodes,
        i: usize,
        maps: impl Iterator<Item = &'a ShootingMap> + Clone,
    ) -> Self {
        let mut line = Self::default();
        let load = contacts.folds[i].load;
        directions(load, &*LOBATTO_NODES, maps.clone(), &mut line.phi);
        let mut at_touch = 1.0;
        for (m, (map, part)) in maps.zip(LOBATTO_NODES.iter()).enumerate() {
            line.ln_distance[m] = libm::log(map.pole.length());
            [line.slopes[0][m], line.slopes[1][m]] = contacts.slope(i, *part, map).to_array();
            let det = map.det() * map.pole.length_squared();
            if m == 0 {
                at_touch = det.abs();
            }
            line.clearance[m] = det / (at_touch * (1.0 - part));
        }
        line
    }
}

impl Lattice {
    /// The lattice over the `contacts`.
    pub fn new(method: Method, rod: &Rod, side: Side, contacts: &ContactNodes) -> Self {
        let conditions: Vec<InitialCondition> = LOBATTO_NODES
            .iter()
            .flat_map(|part| {
                contacts.folds.iter().map(move |fold| InitialCondition {
                    rod,
                    tau: fold.tau,
                    load: part * fold.load,
                })
            })
            .collect();
        let maps = Batch::new(method)
            .padded()
            .shoot::<ShootingMap>(&conditions);
        let count = contacts.folds.len();
        let lines: Vec<LoadLine> = (0..count)
            .map(|i| LoadLine::new(contacts, i, maps[i..].iter().step_by(count)))
            .collect();
        Self {
            side,
            patches: patches(&lines),
            lines,
        }
    }

    /// Whether no fold hides below the first folds of the contact nodes, at them or between them. The loads are evenly spaced in
    /// the angle of which they are the cosine.
    pub fn is_certified(&self) -> bool {
        const BELOW_FOLD: usize = LOBATTO_COUNT - 1;
        let count = self.lines.len();
        self.lines
            .iter()
            .all(|line| stays_positive(BELOW_FOLD, |m| line.clearance[m]))
            && (0..BELOW_FOLD).all(|m| stays_positive(count, |i| self.lines[i].clearance[m]))
    }

    /// Direction of the pole at the fold, contact node by contact node, continuous from first touch.
    pub fn phi_at_fold(&self) -> impl Iterator<Item = f64> {
        self.lines.iter().map(|line| line.phi[LOBATTO_COUNT - 1])
    }
}

/// Through each [`STENCIL`](crate::sheet::fold::coordinate::STENCIL) neighbours of `lines`, or through all where there are fewer.
fn patches(lines: &[LoadLine]) -> Vec<Patch> {
    let through = |value: fn(&LoadLine) -> Numbers, slope: usize| {
        let values: Vec<Numbers> = lines.iter().map(value).collect();
        let slopes: Vec<Numbers> = lines.iter().map(|line| line.slopes[slope]).collect();
        through_slopes(&values, &slopes).into_iter()
    };
    through(|line| line.ln_distance, 0)
        .zip(through(|line| line.phi, 1))
        .map(|(ln_distance, phi)| Patch { ln_distance, phi })
        .collect()
}

/// Writes into `phis` the directions of the pole, continuous from first touch, of `maps` of one contact under these `parts` of its fold's
/// `load`.
pub fn directions<'a>(
    load: f64,
    parts: &[f64],
    maps: impl Iterator<Item = &'a ShootingMap>,
    phis: &mut [f64],
) {
    let mut before: Option<(&ShootingMap, f64, f64)> = None;
    for (slot, (map, part)) in phis.iter_mut().zip(maps.zip(parts)) {
        let near = before.map_or(0.0, |(there, phi, part_there)| {
            let slopes = there.by_load.y + map.by_load.y;
            0.5f64.mul_add(slopes * load * (part - part_there), phi)
        });
        let phi = nearest_turn(map.pole.to_angle(), near);
        before = Some((map, phi, *part));
        *slot = phi;
    }
}
