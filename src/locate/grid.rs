//! Grid of states over contact and load on one side of a whisker, and the grid's cells in which a state has given numbers at the base.
//!
//! The contacts are evenly spaced in `u = ln tau + tau`, from the tip inward; the loads are parts of the first fold's. A pair of numbers
//! `w` is the force times the lever `l`. In a cell that has such a state, `l x w` and `l . (f l - w)` have zeros, so that both change
//! their signs between its corners. Without a load, the resting whisker gives the lever, so that small loads need no more cells.
//! Where the Jacobian of the pair changes its sign, a cell may have two states; such cells and their neighbours have more starts.

use super::newton::{lever, lever_by};
use crate::sheet::{SheetCase, directions, first_folds, tau_of, u_of};
use glam::{DVec2, DVec3};
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::rod::{Rest, Rod, Side, Units};
use whiskmap_mechanics::shooting::batch::{Batch, Method};
use whiskmap_mechanics::shooting::{FirstVariation, Reader, ShootingMap};

/// Indices of the two numbers of each pair in `[M, Fx, Fy]`.
pub const PAIRS: [[usize; 2]; 3] = [[0, 2], [0, 1], [1, 2]];

/// Arclength of the contact nearest to the base, in whisker lengths, as for the poles of a scene.
const NEAREST: f64 = 1e-3;

/// Spacing of the contacts in `u`.
const CONTACT_STEP: f64 = 0.12;

/// Smallest part of the fold's load beside 0.
const FIRST_PART: f64 = 1e-4;

/// Step between parts of the fold's load: relative to small parts; near the fold, an eighth of this step.
const PART_STEP: f64 = 0.35;

/// Largest part of the fold's load: beyond 1, since the fold is interpolated between contacts.
const LAST_PART: f64 = 1.02;

/// Part of the interpolated fold's load up to which a state may be below the fold; its determinant decides.
const NEAR_FOLD: f64 = 1.01;

/// Change of `ln q` of the fold from contact to contact from which on the fold is computed again at the contact of a state.
const FOLD_JUMP: f64 = 0.3;

/// Sine of the angle between the gradients of a pair of numbers below which its sign is rounding.
const SINE_ROUNDING: f64 = 1e-9;

/// Largest sine of the angle between the gradients of a pair that determines no state.
const DEPENDENT: f64 = 1e-7;

/// Least part of a cell at which a search starts, so that the load is not 0.
const INSIDE: f64 = 1e-6;

/// Levers of a pair of numbers at the nodes of a grid.
struct PairGrid {
    /// First and second component of the lever, `[node]`.
    levers: [Vec<f64>; 2],
    /// Signed force times the square of the lever, `[node]`.
    sizes: Vec<f64>,
    /// Cells with a singular Jacobian and their neighbours, by the index of the first node.
    turns: Vec<usize>,
    /// False if one number of the pair follows from the other.
    is_determined: bool,
}

/// Grid of the states of a whisker with its pole on one side.
pub struct SheetGrid {
    pub rod: Rod,
    pub side: Side,
    pub rest: Rest,
    pub reader: Reader,
    method: Method,
    /// Contacts from the base outward, `[contact]`.
    taus: Vec<f64>,
    /// Logarithm of `|load| tau^2` of the first fold, `[contact]`.
    ln_qs: Vec<f64>,
    /// Parts of the fold's load, `[part]`.
    parts: Vec<f64>,
    /// Direction of the pole in radians, continuous from first touch, `[contact * parts + part]`.
    phis: Vec<f64>,
    pairs: [PairGrid; 3],
}

/// Returns the parts of the fold's load, `[part]`.
fn parts() -> Vec<f64> {
    let next = |part: &f64| {
        let next = part + PART_STEP * part / (1.0 + 8.0 * part);
        (*part < LAST_PART).then_some(next.min(LAST_PART))
    };
    std::iter::once(0.0)
        .chain(std::iter::successors(Some(FIRST_PART), next))
        .collect()
}

impl SheetGrid {
    /// Computes the grid of `rod` with the pole on `side`, from one contact beyond the tip inward to the pole's radius or a thousandth of
    /// the length from the base, or the first contact without a fold.
    pub fn new(method: Method, rod: Rod, side: Side, units: Units) -> Self {
        let case = SheetCase {
            method,
            rod: &rod,
            side,
        };
        let tip = rod.tau_tip();
        let nearest = u_of(&rod, rod.tau(rod.pole.abs().max(NEAREST)));
        let range = u_of(&rod, tip) - nearest;
        let count = (range / CONTACT_STEP).ceil() as usize + 1;
        let inward = (0..count).scan(tip, |tau, i| {
            if i != 1 {
                let beyond = CONTACT_STEP * (1.0 - i as f64);
                *tau = tau_of(&rod, u_of(&rod, tip) + beyond, *tau);
            } else {
                *tau = tip;
            }
            Some(*tau)
        });
        let inward: Vec<f64> = inward.collect();
        let folds = first_folds(case, &inward)
            .into_iter()
            .map_while(|fold| fold);
        let mut contacts: Vec<[f64; 2]> = folds.map(|fold| [fold.tau, fold.q()]).collect();
        contacts.reverse();
        let parts = parts();
        let load = |[tau, q]: [f64; 2], part: f64| side.sign() * part * q / (tau * tau);
        let points = contacts.iter().flat_map(|contact| {
            let loads = parts.iter().map(|part| load(*contact, *part));
            loads.map(|load| (contact[0], load))
        });
        let points: Vec<(f64, f64)> = points.collect();
        let nodes: Vec<FirstVariation> = Batch::new(method).shoot_at(&rod, points.iter().copied());
        let maps: Vec<ShootingMap> = nodes.iter().map(|node| node.full.map).collect();
        let columns = points.chunks(parts.len()).zip(maps.chunks(parts.len()));
        let phis = columns.flat_map(|(points, maps)| {
            let loads = points.iter().map(|(_, load)| *load);
            directions(0.0, loads.zip(maps))
        });
        Self {
            rest: Rest::new(&rod),
            reader: Reader::new(units, &rod),
            method,
            taus: contacts.iter().map(|[tau, _]| *tau).collect(),
            ln_qs: contacts.iter().map(|[_, q]| libm::log(*q)).collect(),
            phis: phis.collect(),
            pairs: PAIRS.map(|pair| PairGrid::new(&rod, &nodes, parts.len(), pair)),
            parts,
            side,
            rod,
        }
    }

    /// Returns true if a pair of numbers, by its index in [`PAIRS`], determines states.
    pub const fn is_determined(&self, pair: usize) -> bool {
        self.pairs[pair].is_determined
    }

    /// Adds to `starts` points `(tau, load)` near all states with the pair of numbers of `wanted`, by the index of the pair in [`PAIRS`].
    /// `signs` is memory for the search.
    pub fn add_starts(
        &self,
        pair: usize,
        wanted: DVec3,
        signs: &mut Vec<u8>,
        starts: &mut Vec<DVec2>,
    ) {
        let pair_grid = &self.pairs[pair];
        let wanted = DVec2::from(PAIRS[pair].map(|i| wanted[i]));
        let count = self.parts.len();
        signs.clear();
        let [first, second] = &pair_grid.levers;
        let nodes = first.iter().zip(second).zip(&pair_grid.sizes);
        signs.extend(nodes.map(|((x, y), size)| {
            let [across, along] = misses(DVec2::new(*x, *y), *size, wanted);
            u8::from(across > 0.0) | u8::from(along > 0.0) << 1
        }));
        let columns = signs.chunks(count).zip(signs.chunks(count).skip(1));
        for (i, (here, next)) in columns.enumerate() {
            for k in 0..count - 1 {
                let corners = [here[k], here[k + 1], next[k], next[k + 1]];
                let any = corners[0] | corners[1] | corners[2] | corners[3];
                let all = corners[0] & corners[1] & corners[2] & corners[3];
                if any & !all == 3 {
                    starts.push(self.start(pair_grid, i * count + k, wanted));
                }
            }
        }
        for &cell in &pair_grid.turns {
            let corners = self.corners(pair_grid, cell, wanted);
            let may_vanish = |i: usize| {
                let values = corners.map(|corner| corner[i]);
                let least = values.into_iter().fold(f64::INFINITY, f64::min);
                let most = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
                let slack = 0.5 * (most - least);
                least - slack <= 0.0 && most + slack >= 0.0
            };
            if may_vanish(0) && may_vanish(1) {
                let places = [[0.2, 0.2], [0.2, 0.8], [0.8, 0.2], [0.8, 0.8]];
                starts.extend(places.map(|place| self.point(cell, DVec2::from(place))));
            }
        }
    }

    /// Returns the misses at the corners of the cell, `[contact * 2 + part][across, along]`.
    fn corners(&self, pair: &PairGrid, cell: usize, wanted: DVec2) -> [[f64; 2]; 4] {
        let next = cell + self.parts.len();
        [cell, cell + 1, next, next + 1].map(|node| {
            let lever = DVec2::new(pair.levers[0][node], pair.levers[1][node]);
            misses(lever, pair.sizes[node], wanted)
        })
    }

    /// Returns the point of a cell at which both misses vanish if they are linear, or the nearest point in the cell.
    fn start(&self, pair: &PairGrid, cell: usize, wanted: DVec2) -> DVec2 {
        let corners = self.corners(pair, cell, wanted).map(DVec2::from);
        let [a, b, c, d] = corners;
        let middle = 0.25 * (a + b + c + d);
        let [by_contact, by_part] = [0.5 * (c + d - a - b), 0.5 * (b + d - a - c)];
        let det = by_contact.perp_dot(by_part);
        let step = DVec2::new(by_part.perp_dot(middle), middle.perp_dot(by_contact)) / det;
        let step = if step.is_finite() { step } else { DVec2::ZERO };
        let place = (0.5 + step).clamp(DVec2::new(0.0, INSIDE), DVec2::ONE);
        self.point(cell, place)
    }

    /// Returns the point `(tau, load)` at a place of a cell, `[contact, part]` from 0 to 1.
    fn point(&self, cell: usize, place: DVec2) -> DVec2 {
        let (i, k) = (cell / self.parts.len(), cell % self.parts.len());
        let between = |[from, to]: [f64; 2], at: f64| from + at * (to - from);
        let ln_taus = [self.taus[i], self.taus[i + 1]].map(libm::log);
        let tau = libm::exp(between(ln_taus, place.x));
        let q = libm::exp(between([self.ln_qs[i], self.ln_qs[i + 1]], place.x));
        let part = between([self.parts[k], self.parts[k + 1]], place.y);
        DVec2::new(tau, self.side.sign() * part * q / (tau * tau))
    }

    /// Returns the contact before `tau`, and `|load| tau^2` of the first fold at `tau`, interpolated.
    fn fold(&self, tau: f64) -> (usize, f64) {
        let after = self.taus.partition_point(|node| *node < tau);
        let i = after.clamp(1, self.taus.len() - 1) - 1;
        let [from, to] = [self.taus[i], self.taus[i + 1]].map(libm::log);
        let at = (libm::log(tau) - from) / (to - from);
        let ln_q = self.ln_qs[i] + at * (self.ln_qs[i + 1] - self.ln_qs[i]);
        (i, libm::exp(ln_q))
    }

    /// Returns the direction of the pole of a stable state at `(tau, load)`, in radians, continuous from first touch. `None` if the state is
    /// not stable, not on the whisker, or the base is inside the pole.
    pub fn direction(&self, at: DVec2, map: &ShootingMap) -> Option<f64> {
        let [tau, load] = [at.x, self.side.sign() * at.y];
        let is_on_whisker =
            tau >= self.taus[0] && self.rod.radius(tau) * (tau - self.rod.tau_tip()) <= ON_TIP;
        let scale = map.by_tau.length() * map.by_load.length();
        let is_pole_outside = map.pole.length() > self.rod.pole.abs();
        if !(is_on_whisker && load > 0.0 && map.det() > -FLAT * scale && is_pole_outside) {
            return None;
        }
        let (i, interpolated) = self.fold(tau);
        let jumps = (self.ln_qs[i + 1] - self.ln_qs[i]).abs() > FOLD_JUMP;
        let case = SheetCase {
            method: self.method,
            rod: &self.rod,
            side: self.side,
        };
        let q = match jumps {
            true => first_folds(case, &[tau]).pop()??.q(),
            false => interpolated,
        };
        let part = load * tau * tau / q;
        let before = self
            .parts
            .partition_point(|node| *node < part)
            .saturating_sub(1);
        let near = self.phis[i * self.parts.len() + before];
        (part < NEAR_FOLD).then(|| nearest_turn(map.pole.to_angle(), near))
    }
}

/// Distance beyond the tip, in whisker lengths, within which a contact counts as on the whisker.
const ON_TIP: f64 = 1e-9;

/// Determinant of a stable state at the fold, relative to its scale, that is rounding ([`Sheet::is_stable`](crate::sheet::Sheet::is_stable)).
const FLAT: f64 = 1e-7;

/// Returns `lever x wanted` and `size - lever . wanted`, where `size` is the force times the square of the lever. Both are 0 in a state with
/// the numbers `wanted`.
#[inline(always)]
fn misses(lever: DVec2, size: f64, wanted: DVec2) -> [f64; 2] {
    [lever.perp_dot(wanted), size - lever.dot(wanted)]
}

impl PairGrid {
    fn new(rod: &Rod, nodes: &[FirstVariation], parts: usize, pair: [usize; 2]) -> Self {
        let both = |of: DVec3| DVec2::from(pair.map(|i| of[i]));
        let levers: Vec<DVec2> = nodes.iter().map(|node| both(lever(&node.full))).collect();
        let sizes = nodes.iter().zip(&levers);
        let sizes = sizes.map(|(node, lever)| node.full.force * lever.length_squared());
        // The gradients by contact and load, over the force and without it.
        let sines = nodes.iter().zip(&levers).map(|(node, lever)| {
            let full = &node.full;
            let by_tau = both(lever_by(full, &node.by_tau)) - 2.0 * rod.taper * *lever;
            let by_load =
                node.by_load.force * *lever + full.force * both(lever_by(full, &node.by_load));
            let sine = by_tau.perp_dot(by_load) / (by_tau.length() * by_load.length());
            if sine.abs() > SINE_ROUNDING {
                sine
            } else {
                0.0
            }
        });
        let sines: Vec<f64> = sines.collect();
        let turns_in = |cell: usize| {
            let corners = [cell, cell + 1, cell + parts, cell + parts + 1].map(|node| sines[node]);
            corners.iter().any(|sine| *sine > 0.0) && corners.iter().any(|sine| *sine < 0.0)
        };
        let cells = nodes.len() / parts.max(1);
        let cell = |i: usize, k: usize| i * parts + k;
        let near = |i: usize, k: usize| {
            let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
            around(i, cells - 1).any(|i| around(k, parts - 1).any(|k| turns_in(cell(i, k))))
        };
        let all = (0..cells.saturating_sub(1)).flat_map(|i| (0..parts - 1).map(move |k| (i, k)));
        let turns = all.filter(|(i, k)| near(*i, *k)).map(|(i, k)| cell(i, k));
        Self {
            turns: turns.collect(),
            is_determined: sines.iter().any(|sine| sine.abs() > DEPENDENT),
            sizes: sizes.collect(),
            levers: [
                levers.iter().map(|lever| lever.x).collect(),
                levers.iter().map(|lever| lever.y).collect(),
            ],
        }
    }
}
