//! Row spans from the lattice: the level curve of `D` of one row, load by load.

use crate::numerics::chebyshev::{CHEBYSHEV_COUNT, LOBATTO_NODES};
use crate::numerics::newton_form::{RootProblem, stencil};
use crate::numerics::newton_form_simd::{LaneNumbers, SimdRoots, Terms, keep, pack};
use crate::numerics::{Bracket, Lanes, SimdTask, Unit, WIDTH};
use crate::sheet::fold::contact_nodes::ContactNodes;
use crate::sheet::fold::coordinate::STENCIL;
use crate::sheet::lattice::Lattice;
use crate::sheet::row::Row;
use crate::sheet::span::{RowSpan, SpanNode};
use crate::shooting::contact::exp;

/// Number of intervals between contact nodes in which one patch serves the loads of a row. One interval away from the middle of the
/// patch, interpolation is half as accurate.
const PATCH_SPAN: usize = 3;

/// Newton step toward the contact of a row, in contact nodes, after which the iteration stops. The remaining error is its square, which
/// is less than the interpolation error.
const LAST_CONTACT_STEP: f64 = 5e-5;

impl Lattice {
    /// Returns the contact node after which `ln D` crosses `target` at the load `m`, or the one nearest to `near` if there are several.
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

    /// Returns the span of `row` on the lattice, at neighbouring loads.
    #[must_use]
    pub fn span(&self, contacts: &ContactNodes, row: &Row) -> RowSpan {
        let target = libm::log(row.pole_distance);
        let mut after = [0; CHEBYSHEV_COUNT];
        let (mut first, mut count, mut near) = (0, 0, 0);
        for (m, after) in after.iter_mut().enumerate() {
            let Some(i) = self.crossing(m, target, near) else {
                if count == 0 {
                    continue;
                }
                break;
            };
            if count == 0 {
                first = m;
            }
            near = i;
            *after = i;
            count += 1;
        }
        let end = first + count;
        let mut nodes = Vec::with_capacity(count);
        let mut from = first;
        while from < end {
            let [mut low, mut high] = [after[from]; 2];
            let mut to = from + 1;
            while to < end && high.max(after[to]) - low.min(after[to]) < PATCH_SPAN {
                [low, high] = [low.min(after[to]), high.max(after[to])];
                to += 1;
            }
            let start = stencil((low + high) / 2, STENCIL, self.lines.len());
            self.cross(contacts, row, start, &after[from..to], from, &mut nodes);
            from = to;
        }
        // The fold load changes little from contact to contact.
        let next = |node: Option<&SpanNode>, m: usize, to: Option<usize>| {
            let part = LOBATTO_NODES.get(to?)?;
            Some(node?.w * part / LOBATTO_NODES[m])
        };
        let beyond = [
            next(nodes.first(), first, first.checked_sub(1)),
            next(nodes.last(), end.saturating_sub(1), Some(end)),
        ];
        RowSpan::on_lattice(self.side.sign(), nodes, beyond)
    }

    /// Adds the span's nodes from the load `from` on, where `ln D` crosses that of `row` after the contact nodes `after`. The patch that
    /// begins at the contact node `start` serves all of them.
    fn cross(
        &self,
        contacts: &ContactNodes,
        row: &Row,
        start: usize,
        after: &[usize],
        from: usize,
        nodes: &mut Vec<SpanNode>,
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
        nodes.extend((from..from + after.len()).map(|m| SpanNode {
            w: q[m] * LOBATTO_NODES[m],
            push: sign * (phi[m] - row.touch),
            tau: tau[m],
        }));
    }
}

/// SIMD task that computes the exponential of each number.
struct Exponentials([LaneNumbers; 2]);

impl SimdTask for Exponentials {
    type Output = [LaneNumbers; 2];

    #[inline(always)]
    fn run<T: Lanes>(mut self) -> [LaneNumbers; 2] {
        for numbers in &mut self.0 {
            for from in (0..WIDTH).step_by(T::LANES) {
                keep(numbers, from, exp::<T>(pack(numbers, from)));
            }
        }
        self.0
    }
}
