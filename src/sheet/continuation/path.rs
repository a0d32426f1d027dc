//! Path: the part of a level curve that a continuation has followed.

use crate::sheet::continuation::level_curve::{CurveNode, LevelCurve, ON_CURVE};
use crate::sheet::row::{Crossing, Edge, STEEP};
use glam::DVec2;
use whiskmap_mechanics::numerics::newton_form::{Polynomial, stencil, through_nodes};

/// Maximum number of nodes through which a polynomial along a path passes.
const STENCIL: usize = 6;

/// Part of a level curve that a continuation has followed: states in front of one pole.
#[derive(Clone, Debug)]
pub struct Path {
    /// Level curve of the path, with which its states are computed.
    pub level: LevelCurve,
    /// Nodes of the path, from its start to its end, `[node]`.
    pub nodes: Vec<CurveNode>,
    /// Index of the path's node at the fold; `None` if the tip comes first.
    pub fold: Option<usize>,
    /// Edge of the sheet at the last node. `None` means that the push angle exceeds the turns that are followed before the curve meets an edge.
    pub end: Option<Edge>,
}

impl Path {
    /// Returns the nodes up to the fold, or up to the end of a path without a fold: the stable states of a path from first touch.
    #[must_use]
    pub fn stable(&self) -> &[CurveNode] {
        self.fold.map_or(&self.nodes, |fold| &self.nodes[..=fold])
    }

    /// Returns the nodes from the fold to the end, which are unstable states; `None` without a fold.
    #[must_use]
    pub fn unstable(&self) -> Option<&[CurveNode]> {
        self.fold.map(|fold| &self.nodes[fold..])
    }

    /// Returns the crossing of the edge at the last node; `None` if the path does not end at an edge.
    #[must_use]
    pub fn crossing(&self) -> Option<Crossing> {
        let (edge, end, level) = (self.end?, self.nodes.last()?, &self.level);
        let distance = end.full.map.pole.length();
        Some(Crossing {
            edge,
            tau: end.point.x,
            load: end.point.y,
            push: level.side.sign() * end.signed_push,
            residual: libm::log(level.row.pole_distance / distance).abs(),
            slope: edge.slope(&end.full.map),
        })
    }

    /// Returns the length of the path from its start to each node, in the measure of [`LevelCurve::length`]: `[node]`.
    #[must_use]
    pub fn lengths(&self) -> Vec<f64> {
        let mut length = 0.0;
        let steps = self.nodes.windows(2);
        let rest = steps.map(|pair| {
            length += self.level.length(&pair[0], &pair[1]);
            length
        });
        std::iter::once(0.0).chain(rest).collect()
    }

    /// Returns the state at each of the `targets`, lengths along the path; `None` where the corrector fails. `lengths` are those of the nodes.
    #[must_use]
    pub fn at_lengths(&self, lengths: &[f64], targets: &[f64]) -> Vec<Option<CurveNode>> {
        let start = |target: &f64| {
            let near = lengths.partition_point(|length| length <= target);
            let near = near.saturating_sub(1);
            let around = lengths.iter().zip(&self.nodes);
            let around = around.skip(stencil(near, STENCIL, self.nodes.len()));
            let point = |(length, node): (&f64, &CurveNode)| (*length, node.point.to_array());
            let polynomials: [Polynomial<STENCIL>; 2] = through_nodes(around.map(point));
            let point = polynomials.map(|polynomial| polynomial.at(*target).0);
            (&self.nodes[near], DVec2::from(point))
        };
        let (near, starts): (Vec<&CurveNode>, Vec<DVec2>) = targets.iter().map(start).unzip();
        let corrected = self.level.correct(&starts, ON_CURVE);
        let states = near.into_iter().zip(corrected);
        states
            .map(|(near, corrected)| {
                let (point, full) = corrected?;
                Some(self.level.node(point, &full, near.signed_push, near.angle))
            })
            .collect()
    }

    /// Returns true if the push angle changes so fast along an edge at the first fold or the end that these need more steps.
    pub(super) fn is_steep(&self) -> bool {
        let last = self.end.zip(self.nodes.last());
        let fold = self.fold.map(|fold| (Edge::Fold, &self.nodes[fold]));
        let slopes = fold.into_iter().chain(last);
        slopes.into_iter().any(|(edge, node)| edge.slope(&node.full.map).abs() > STEEP)
    }
}
