//! The lattice of trajectories over the stable sheet, which provides the guesses for cells.
//!
//! Its points lie at the contact nodes, and for each node at Chebyshev-Lobatto points of the load from first touch to the fold. There are
//! so many of them that most guesses are one Newton step away from the state. A row of a map is a level curve of `D` on the lattice.
//! Along it the push angle grows from first touch to detachment.

mod row_span;

use crate::numerics::chebyshev::{CHEBYSHEV_COUNT, LOBATTO_NODES};
use crate::numerics::nearest_turn;
use crate::numerics::newton_form::through_runs;
use crate::numerics::newton_form_simd::LaneNumbers;
use crate::rod::Side;
use crate::sheet::case::SheetCase;
use crate::sheet::certificate::stays_positive;
use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::fold::coordinate::TERMS;
use crate::shooting::ShootingMap;

/// Lattice of trajectories by contact node and load, with polynomials between them.
#[derive(Clone, Debug)]
pub struct Lattice {
    side: Side,
    /// Load lines, one for each contact node.
    lines: Vec<LoadLine>,
    /// Patches, indexed by the first contact node of their stencil.
    patches: Vec<LatticePatch>,
}

/// Lattice points of one contact node, `[load]`.
#[derive(Clone, Copy, Debug, Default)]
struct LoadLine {
    ln_distance: LaneNumbers,
    /// Direction of the pole in radians, continuous from first touch.
    phi: LaneNumbers,
    /// Derivatives of `ln_distance` and `phi` by the index of the contact node.
    slopes: [LaneNumbers; 2],
    /// `det D^2`, divided by its value at first touch and by the remaining part of the load up to the fold. It is positive and smooth up
    /// to the fold.
    clearance: LaneNumbers,
}

/// Hermite polynomials along one stencil of contact nodes, as divided differences, one polynomial for each load.
#[derive(Clone, Copy, Debug)]
struct LatticePatch {
    ln_distance: [LaneNumbers; TERMS],
    /// Divided differences of the direction of the pole, in radians.
    phi: [LaneNumbers; TERMS],
}

impl LoadLine {
    /// Collects the `maps`, one for each load, of the contact node `i`.
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
    /// Computes the lattice of trajectories over `contacts`.
    pub fn new(case: SheetCase, contacts: &ContactNodes) -> Self {
        let folds = contacts.folds.iter();
        let points = LOBATTO_NODES.iter().flat_map(|part| {
            let folds = folds.clone();
            folds.map(move |fold| (fold.tau, part * fold.load))
        });
        let maps: Vec<ShootingMap> = case.shoot(points);
        let count = contacts.folds.len();
        let lines: Vec<LoadLine> = (0..count)
            .map(|i| LoadLine::new(contacts, i, maps[i..].iter().step_by(count)))
            .collect();
        let through = |value: fn(&LoadLine) -> LaneNumbers, slope: usize| {
            let values: Vec<LaneNumbers> = lines.iter().map(value).collect();
            let slopes: Vec<LaneNumbers> = lines.iter().map(|line| line.slopes[slope]).collect();
            through_runs(&values, &slopes).into_iter()
        };
        let patches = through(|line| line.ln_distance, 0).zip(through(|line| line.phi, 1));
        let patches = patches.map(|(ln_distance, phi)| LatticePatch { ln_distance, phi });
        Self {
            side: case.side,
            patches: patches.collect(),
            lines,
        }
    }

    /// Returns true if the lattice shows that no fold is hidden below the first folds, at the contact nodes or between them. The loads
    /// are evenly spaced in the angle of which they are the cosine.
    pub fn is_certified(&self) -> bool {
        const BELOW_FOLD: usize = CHEBYSHEV_COUNT - 1;
        let count = self.lines.len();
        self.lines
            .iter()
            .all(|line| stays_positive(BELOW_FOLD, |m| line.clearance[m]))
            && (0..BELOW_FOLD).all(|m| stays_positive(count, |i| self.lines[i].clearance[m]))
    }

    /// Returns the direction of the pole at the fold in radians, one for each contact node, continuous from first touch.
    pub fn phi_at_fold(&self) -> impl Iterator<Item = f64> {
        self.lines.iter().map(|line| line.phi[CHEBYSHEV_COUNT - 1])
    }
}

/// Writes into `phis` the directions of the pole in radians, continuous from first touch. The `maps` are those of one contact under these
/// `parts` of its fold's `load`.
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
