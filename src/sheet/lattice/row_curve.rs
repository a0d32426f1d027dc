//! The level curve of `D` of one row on the lattice, load by load, and the intervals between its points.

use crate::numerics::lobatto::{LOBATTO_COUNT, LOBATTO_NODES, LobattoPolynomial, through_lobatto};
use crate::numerics::newton_form::{RootProblem, stencil};
use crate::numerics::newton_form_simd::{Numbers, SimdRoots, Terms, keep, pack};
use crate::numerics::{Bracket, Lanes, SimdTask, Unit, WIDTH};
use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::fold::coordinate::STENCIL;
use crate::sheet::lattice::Lattice;
use crate::sheet::row::Row;
use crate::shooting::contact::exp;

/// Intervals between contact nodes over which one patch serves the loads of a row: one interval from its middle, interpolation is
/// half as good.
const SPAN: usize = 3;

/// The last Newton step toward the contact of a row, in contact nodes: its square is left, and interpolation leaves more than that.
const LAST_CONTACT_STEP: f64 = 5e-5;

const _: () = assert!(LOBATTO_COUNT <= WIDTH, "a row's loads go together");

/// The level curve of `D` of one row, at neighbouring loads of the lattice.
#[derive(Clone, Copy, Debug, Default)]
pub struct RowCurve {
    /// Which load the first point has.
    pub first: usize,
    /// Points.
    pub count: usize,
    /// Push angle since first touch at each point, in radians, as a magnitude on the sheet's side.
    pub push: Numbers,
    /// `tau` of the contact.
    pub tau: Numbers,
    /// Signed load.
    pub load: Numbers,
}

impl Lattice {
    /// The contact node after which `ln D` crosses `target` at the load `m`; the one nearest to `near` if there are several.
    fn crossing(&self, m: usize, target: f64, near: usize) -> Option<usize> {
        let last = self.lines.len() - 1;
        let is_before = |i: usize| self.lines[i].ln_distance[m] <= target;
        let crosses = |i: usize| i < last && is_before(i) != is_before(i + 1);
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
    pub fn row_curve(&self, contacts: &ContactNodes, row: &Row) -> RowCurve {
        let target = libm::log(row.pole_distance);
        let mut curve = RowCurve::default();
        let mut after = [0; LOBATTO_COUNT];
        let mut near = 0;
        for (m, after) in after.iter_mut().enumerate() {
            let Some(i) = self.crossing(m, target, near) else {
                if curve.count == 0 {
                    continue;
                }
                break;
            };
            if curve.count == 0 {
                curve.first = m;
            }
            near = i;
            *after = i;
            curve.count += 1;
        }
        let end = curve.first + curve.count;
        let mut from = curve.first;
        while from < end {
            let [mut low, mut high] = [after[from]; 2];
            let mut to = from + 1;
            while to < end && high.max(after[to]) - low.min(after[to]) < SPAN {
                [low, high] = [low.min(after[to]), high.max(after[to])];
                to += 1;
            }
            let start = stencil((low + high) / 2, STENCIL, self.lines.len());
            self.cross(contacts, row, start, &after[from..to], from, &mut curve);
            from = to;
        }
        curve
    }

    /// Sets the points of `curve` from the load `from` on, where `ln D` crosses that of `row` after the contact nodes `after`. The
    /// patch from the node `start` on serves them all.
    fn cross(
        &self,
        contacts: &ContactNodes,
        row: &Row,
        start: usize,
        after: &[usize],
        from: usize,
        curve: &mut RowCurve,
    ) {
        let (patch, target) = (&self.patches[start], libm::log(row.pole_distance));
        let problem = |(m, &i): (usize, &usize)| {
            let offset = i as f64 - start as f64;
            let ends = [i, i + 1].map(|i| self.lines[i].ln_distance[m]);
            RootProblem {
                target,
                near: offset + (target - ends[0]) / (ends[1] - ends[0]),
                bracket: Bracket::new([offset, offset + 1.0], ends),
            }
        };
        let problems: Vec<RootProblem> = (from..).zip(after).map(problem).collect();
        let folds = [&contacts.ln_tau[start], &contacts.ln_q[start]];
        let roots = SimdRoots {
            nodes: &folds[0].nodes,
            terms: Terms::Each(&patch.ln_distance),
            others: [
                Terms::Each(&patch.phi),
                Terms::Same(&folds[0].differences),
                Terms::Same(&folds[1].differences),
            ],
        };
        let [phi, ln_tau, ln_q] = roots.solve(from, &problems, LAST_CONTACT_STEP);
        let [tau, q] = Unit::detect().run(Exponentials([ln_tau, ln_q]));
        let sign = self.side.sign();
        for m in from..from + after.len() {
            let point = m - curve.first;
            curve.push[point] = sign * (phi[m] - row.touch);
            curve.tau[point] = tau[m];
            curve.load[point] = sign * q[m] / (tau[m] * tau[m]) * LOBATTO_NODES[m];
        }
    }
}

/// The exponentials of some numbers.
struct Exponentials([Numbers; 2]);

impl SimdTask for Exponentials {
    type Output = [Numbers; 2];

    #[inline(always)]
    fn run<T: Lanes>(mut self) -> [Numbers; 2] {
        for numbers in &mut self.0 {
            for from in (0..WIDTH).step_by(T::LANES) {
                keep(numbers, from, exp::<T>(pack(numbers, from)));
            }
        }
        self.0
    }
}

/// Points of a polynomial near the end of a row that leaves the lattice.
pub const NEAR_CUT: usize = 7;

/// How far beyond the lattice's own detachment angle, in radians, a guess is still made: on most whiskers many times the
/// interpolation error. A row with a cell that is missed for all that is followed by continuation.
pub const MARGIN: f64 = 1e-4;

impl RowCurve {
    /// Push angle, contact and load by the part of the fold's load, through `count` points from the point `from` on.
    pub fn polynomials(&self, from: usize, count: usize) -> [LobattoPolynomial; 3] {
        let values = [&self.push, &self.tau, &self.load].map(|numbers| {
            let mut values = [0.0; LOBATTO_COUNT];
            values[..count].copy_from_slice(&numbers[from..from + count]);
            values
        });
        through_lobatto(self.first + from, count, values)
    }

    /// The intervals between the points. A row leaves the lattice between two loads: its end is moved to the next one, unless the
    /// push angle turns on the way there.
    pub fn intervals(&self) -> Intervals {
        let (first, count) = (self.first, self.count);
        let near_cut = count.min(NEAR_CUT);
        let (mut part, mut push) = ([0.0; WIDTH], self.push);
        part[..count].copy_from_slice(&LOBATTO_NODES[first..first + count]);
        if let Some(before) = first.checked_sub(1) {
            let node = LOBATTO_NODES[before];
            let at_node = self.polynomials(0, near_cut)[0].at(node).0;
            if at_node < self.push[0] {
                (part[0], push[0]) = (node, at_node);
            }
        }
        if let Some(node) = LOBATTO_NODES.get(first + count) {
            let ending = self.polynomials(count - near_cut, near_cut);
            let at_node = ending[0].at(*node).0;
            if at_node > self.push[count - 1] {
                (part[count - 1], push[count - 1]) = (*node, at_node);
            }
        }
        let summit = push[..count]
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        Intervals {
            part,
            push,
            summit,
            below: push.map(|push| (summit - push).max(0.0).sqrt()),
        }
    }
}

/// The points between which push angles are looked for.
pub struct Intervals {
    /// The loads, as parts of the fold's.
    part: Numbers,
    /// The push angles.
    pub push: Numbers,
    /// The largest of them.
    summit: f64,
    /// The roots of how far they are below it: at the fold the push angle is flat, and the load goes with this root.
    below: Numbers,
}

impl Intervals {
    /// Where to look for `push` between the point `i` and the next one; `None` where it is not near them.
    pub fn problem(&self, i: usize, push: f64) -> Option<RootProblem> {
        let pair = |numbers: &Numbers| [numbers[i], numbers[i + 1]];
        let ([low, high], [from, to]) = (pair(&self.part), pair(&self.push));
        if push < from - MARGIN || push > to + MARGIN {
            return None;
        }
        let target = push.max(from).min(to);
        let [below_low, below_high] = pair(&self.below);
        let below = (self.summit - target).max(0.0).sqrt();
        let between = if below_high < below_low {
            (below_low - below) / (below_low - below_high)
        } else {
            1.0
        };
        Some(RootProblem {
            target,
            near: low + between * (high - low),
            bracket: Bracket::new([low, high], [from, to]),
        })
    }
}
