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

    /// Returns the row span of `row` on the lattice. Its nodes are at consecutive loads of the lattice, one for each load at which the
    /// row crosses it.
    #[must_use]
    pub fn span(&self, contacts: &ContactNodes, row: &Row) -> RowSpan {
        let target = libm::log(row.pole_distance);
        // Each load at which the row crosses the lattice, and the contact node after which it does.
        let mut crossed: Vec<(usize, usize)> = Vec::with_capacity(CHEBYSHEV_COUNT);
        for m in 0..CHEBYSHEV_COUNT {
            let near = crossed.last().map_or(0, |(_, i)| *i);
            match self.crossing(m, target, near) {
                Some(i) => crossed.push((m, i)),
                None if crossed.is_empty() => {}
                None => break,
            }
        }
        let mut nodes = Vec::with_capacity(crossed.len());
        let mut rest = &crossed[..];
        while let [(_, i), ..] = rest {
            let [mut low, mut high] = [*i; 2];
            let fits = |(_, i): &&(usize, usize)| {
                (low, high) = (low.min(*i), high.max(*i));
                high - low < PATCH_SPAN
            };
            let (served, after) = rest.split_at(rest.iter().take_while(fits).count());
            self.cross(contacts, row, served, &mut nodes);
            rest = after;
        }
        // The fold load changes little from contact to contact.
        let next = |node: Option<&SpanNode>, crossed: Option<&(usize, usize)>, forward: bool| {
            let (node, (m, _)) = node.zip(crossed)?;
            let to = if forward { m + 1 } else { m.checked_sub(1)? };
            let part = LOBATTO_NODES.get(to)?;
            Some(node.w * part / LOBATTO_NODES[*m])
        };
        let beyond = [
            next(nodes.first(), crossed.first(), false),
            next(nodes.last(), crossed.last(), true),
        ];
        RowSpan::on_lattice(self.side.sign(), nodes, beyond)
    }

    /// Adds the span's nodes at neighbouring loads that one patch serves. Each load comes with the contact node after which `ln D` crosses
    /// that of `row`.
    fn cross(
        &self,
        contacts: &ContactNodes,
        row: &Row,
        crossed: &[(usize, usize)],
        nodes: &mut Vec<SpanNode>,
    ) {
        let after = crossed.iter().map(|(_, i)| *i);
        let [low, high] = [after.clone().min(), after.max()].map(Option::unwrap_or_default);
        let start = stencil((low + high) / 2, STENCIL, self.lines.len());
        let from = crossed.first().map_or(0, |(m, _)| *m);
        let (patch, target) = (&self.patches[start], libm::log(row.pole_distance));
        let problem = |&(m, i): &(usize, usize)| {
            let offset = i as f64 - start as f64;
            let ends = [i, i + 1].map(|i| self.lines[i].ln_distance[m]);
            RootProblem {
                target,
                near: offset + (target - ends[0]) / (ends[1] - ends[0]),
                bracket: Bracket::new([offset, offset + 1.0], ends),
            }
        };
        let problems: Vec<RootProblem> = crossed.iter().map(problem).collect();
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
        nodes.extend(crossed.iter().map(|&(m, _)| SpanNode {
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
