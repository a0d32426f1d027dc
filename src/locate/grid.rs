//! Grid of states over contact and load on one side of a whisker, and the grid's cells in which a state has given numbers at the base.
//!
//! The contacts are evenly spaced in `u = ln tau + tau`, from the tip inward; the loads are parts of the first fold's. A pair of numbers
//! `w` is the force times the lever `l`. In a follicle, the forces have the frame of its axis, from which the base turns by the moment times the
//! compliance. With a measured moment the turn is known, and the levers are those of a clamped base. Without it, size and direction of the force are
//! compared. In a cell that has such a state, `l x w` and `l . (f l - w)` have zeros, so that both change
//! their signs between its corners. Without a load, the resting whisker gives the lever, so that small loads need no more cells.
//! Where the Jacobian of the pair changes its sign, a cell may have two states; such cells and their neighbours have more starts.

use super::levers::{ACROSS, ALONG, NodeForces, NodeLevers, PAIRS, SearchedPair};
use crate::sheet::{SheetCase, directions, first_folds, tau_of, u_of};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use whiskmap_mechanics::numerics::nearest_turn;
use whiskmap_mechanics::rod::{Rest, Rod, Side, Units};
use whiskmap_mechanics::shooting::batch::{Batch, Method};
use whiskmap_mechanics::shooting::{FirstVariation, Reader, ShootingMap};

/// Arclength to which the grid extends toward the base, in whisker lengths. A push against a thick pole moves contacts nearer to the base than the
/// pole's radius.
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

/// Least part of a cell at which a search starts, so that the load is not 0.
const INSIDE: f64 = 1e-6;

/// Part of the range of a miss in a cell beyond which it has no zero there, although its derivative may have one.
const SLACK: f64 = 0.5;

/// Returns the least and the greatest of four numbers.
fn span(numbers: [f64; 4]) -> [f64; 2] {
    let least = numbers.into_iter().fold(f64::INFINITY, f64::min);
    let most = numbers.into_iter().fold(f64::NEG_INFINITY, f64::max);
    [least, most]
}

/// Grid of the states of a whisker with its pole on one side.
pub struct SheetGrid {
    pub rod: Rod,
    /// The rod with a clamped base.
    pub clamped: Rod,
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
    /// Levers with a clamped base.
    in_clamp: NodeLevers,
    /// Forces in the follicle; `None` without one.
    in_follicle: Option<NodeForces>,
    /// False for a pair of which one number follows from the other, `[pair]`.
    is_determined: [bool; 3],
}

/// Returns the parts of the fold's load, `[part]`.
fn parts() -> Vec<f64> {
    let next = |part: &f64| {
        let next = part + PART_STEP * part / (1.0 + 8.0 * part);
        (*part < LAST_PART).then_some(next.min(LAST_PART))
    };
    std::iter::once(0.0).chain(std::iter::successors(Some(FIRST_PART), next)).collect()
}

impl SheetGrid {
    /// Computes the grid of `rod` with the pole on `side`, from one contact beyond the tip inward to a thousandth of the length from the base, or the
    /// first contact without a fold.
    pub fn new(method: Method, rod: Rod, side: Side, units: Units) -> Self {
        let case = SheetCase { method, rod: &rod, side };
        let tip = rod.tau_tip();
        let range = u_of(&rod, tip) - u_of(&rod, rod.tau(NEAREST));
        // The first contact is beyond the tip.
        let count = (range / CONTACT_STEP).ceil() as usize + 2;
        let inward: Vec<f64> = (0..count)
            .scan(tip, |tau, i| {
                if i != 1 {
                    let beyond = CONTACT_STEP * (1.0 - i as f64);
                    *tau = tau_of(&rod, u_of(&rod, tip) + beyond, *tau);
                } else {
                    *tau = tip;
                }
                Some(*tau)
            })
            .collect();
        let folds = first_folds(case, &inward).into_iter().map_while(|fold| fold);
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
        let clamped = Rod { mount: 0.0, ..rod.clone() };
        let levers = NodeLevers::new(&rod, &nodes, parts.len());
        let is_determined = levers.is_determined;
        let (in_clamp, in_follicle) = match rod.mount == 0.0 {
            true => (levers, None),
            false => {
                let points = points.iter().copied();
                let nodes: Vec<FirstVariation> = Batch::new(method).shoot_at(&clamped, points);
                let in_clamp = NodeLevers::new(&clamped, &nodes, parts.len());
                let forces = NodeForces::new(rod.mount, &in_clamp, &levers.sines[2], parts.len());
                (in_clamp, Some(forces))
            }
        };
        Self {
            rest: Rest::new(&rod),
            reader: Reader::new(units, &rod),
            method,
            taus: contacts.iter().map(|[tau, _]| *tau).collect(),
            ln_qs: contacts.iter().map(|[_, q]| libm::log(*q)).collect(),
            phis: phis.collect(),
            in_clamp,
            in_follicle,
            is_determined,
            clamped,
            parts,
            side,
            rod,
        }
    }

    /// Returns true if a pair of numbers, by its index in [`PAIRS`], determines states.
    pub const fn is_determined(&self, pair: usize) -> bool {
        self.is_determined[pair]
    }

    /// Adds to `starts` points `(tau, load)` near all states with the pair of numbers of `wanted`, by the index of the pair in [`PAIRS`].
    /// The base of the states has turned by `turn` in the follicle, if the moment is measured. `signs` is memory for the search.
    pub fn add_starts(
        &self,
        pair: usize,
        wanted: DVec3,
        turn: Option<f64>,
        signs: &mut Vec<u8>,
        starts: &mut Vec<DVec2>,
    ) {
        let numbers = DVec2::from(PAIRS[pair].map(|i| wanted[i]));
        if let (Some(forces), None) = (&self.in_follicle, turn) {
            self.add_starts_in_follicle(forces, numbers, starts);
            return;
        }
        let searched = SearchedPair::new(&self.in_clamp, pair, turn.unwrap_or_default(), numbers);
        let count = self.parts.len();
        let turns = searched.signs(count, signs);
        let columns = signs.chunks(count).zip(signs.chunks(count).skip(1));
        for (i, (here, next)) in columns.enumerate() {
            for k in 0..count - 1 {
                let corners = [here[k], here[k + 1], next[k], next[k + 1]];
                let any = corners[0] | corners[1] | corners[2] | corners[3];
                let all = corners[0] & corners[1] & corners[2] & corners[3];
                if any & !all == ACROSS | ALONG {
                    let cell = i * count + k;
                    starts.push(self.start(cell, self.corners(cell, |node| searched.misses(node))));
                }
            }
        }
        for &cell in turns.iter() {
            let corners = self.corners(cell, |node| searched.misses(node));
            self.add_turn(cell, corners, starts);
        }
    }

    /// Adds to `starts` points near all states with this force in the frame of the follicle, where no moment gives the turn of the base.
    fn add_starts_in_follicle(&self, forces: &NodeForces, force: DVec2, starts: &mut Vec<DVec2>) {
        let (size, angle) = (force.length(), force.to_angle());
        let count = self.parts.len();
        let at = |node: usize| DVec2::new(forces.angles[node] - angle, forces.sizes[node] - size);
        let turns_of = |corners: &[DVec2; 4], slack: f64| {
            let angles = corners.map(|corner| corner.x / TAU);
            let [least, most] = span(angles);
            let slack = slack * (most - least);
            let turns = (least - slack).ceil() as i32..=(most + slack).floor() as i32;
            let corners = *corners;
            turns.map(move |turn| corners.map(|at| at - DVec2::new(TAU * f64::from(turn), 0.0)))
        };
        for i in 0..self.taus.len().saturating_sub(1) {
            for cell in i * count..(i + 1) * count - 1 {
                let corners = self.corners(cell, at);
                let [least, most] = span(corners.map(|corner| corner.y));
                if least <= 0.0 && most >= 0.0 {
                    let corners = turns_of(&corners, 0.0);
                    starts.extend(corners.map(|corners| self.start(cell, corners)));
                }
            }
        }
        for &cell in &forces.turns {
            let corners = self.corners(cell, at);
            for corners in turns_of(&corners, SLACK) {
                self.add_turn(cell, corners, starts);
            }
        }
    }

    /// Adds starts in a cell that may have two states, if both misses may vanish in it.
    fn add_turn(&self, cell: usize, corners: [DVec2; 4], starts: &mut Vec<DVec2>) {
        let may_vanish = |i: usize| {
            let [least, most] = span(corners.map(|corner| corner[i]));
            let slack = SLACK * (most - least);
            least - slack <= 0.0 && most + slack >= 0.0
        };
        if may_vanish(0) && may_vanish(1) {
            let places = [[0.2, 0.2], [0.2, 0.8], [0.8, 0.2], [0.8, 0.8]];
            starts.extend(places.map(|place| self.point(cell, DVec2::from(place))));
        }
    }

    /// Returns the misses `at` the corners of the cell, `[contact * 2 + part]`.
    fn corners(&self, cell: usize, at: impl Fn(usize) -> DVec2) -> [DVec2; 4] {
        let next = cell + self.parts.len();
        [cell, cell + 1, next, next + 1].map(at)
    }

    /// Returns the point of a cell at which both misses vanish if they are linear, or the nearest point in the cell.
    fn start(&self, cell: usize, [a, b, c, d]: [DVec2; 4]) -> DVec2 {
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
        let is_pole_outside = map.pole.length() > self.rod.pole.abs();
        if !(is_on_whisker && load > 0.0 && map.is_stable() && is_pole_outside) {
            return None;
        }
        let (i, interpolated) = self.fold(tau);
        let jumps = (self.ln_qs[i + 1] - self.ln_qs[i]).abs() > FOLD_JUMP;
        let case = SheetCase { method: self.method, rod: &self.rod, side: self.side };
        let q = match jumps {
            true => first_folds(case, &[tau]).pop()??.q(),
            false => interpolated,
        };
        let part = load * tau * tau / q;
        let before = self.parts.partition_point(|node| *node < part).saturating_sub(1);
        let near = self.phis[i * self.parts.len() + before];
        (part < NEAR_FOLD).then(|| nearest_turn(map.pole.to_angle(), near))
    }
}

/// Distance beyond the tip, in whisker lengths, within which a contact counts as on the whisker.
const ON_TIP: f64 = 1e-9;
