//! States on a level curve: at first touch, at a crossing, at a push angle, and the nearest states to given points.

use crate::sheet::continuation::corrector::correct;
use crate::sheet::continuation::level_curve::{CurveNode, LevelCurve, ON_CURVE};
use crate::sheet::row::Crossing;
use glam::DVec2;
use whiskmap_mechanics::numerics::{Root, illinois};
use whiskmap_mechanics::rod::arclength;
use whiskmap_mechanics::shooting::batch::Batch;
use whiskmap_mechanics::shooting::{FirstVariation, FullState};

/// Rounding error near states of a scaled load `q`, in parts of [`ON_CURVE`] for each unit of `q`. 1.4e-14 at `q` = 38 was too little,
/// for 800 states on branches of cones up to there.
const ROUGHENING: f64 = 0.1;

impl LevelCurve {
    /// Returns the level curve's state at first touch, from which push angles are counted.
    #[must_use]
    pub fn touch(&self) -> CurveNode {
        let at_touch = self.row.first_touch(&self.rod);
        let FirstVariation { full, .. } =
            Batch::new(self.method).shoot_at(&self.rod, [at_touch])[0];
        CurveNode { signed_push: 0.0, ..self.node(at_touch, &full, 0.0, 0.0) }
    }

    /// Returns the level curve's state at a crossing, or `None` if the corrector fails.
    #[must_use]
    pub fn at_crossing(&self, crossing: &Crossing) -> Option<CurveNode> {
        let at = DVec2::new(crossing.tau, crossing.load);
        let (point, full) = self.correct(&[at], ON_CURVE).pop()??;
        Some(self.node(point, &full, self.side.sign() * crossing.push, 0.0))
    }

    /// Returns the level curve's state at `signed_push`, in radians, between two of the `nodes`, along which the push angle grows or
    /// falls throughout. Returns `None` outside the nodes, or if the corrector fails.
    #[must_use]
    pub fn state_at_push(&self, nodes: &[CurveNode], signed_push: f64) -> Option<CurveNode> {
        Some(self.bracketed_push(nodes, signed_push)?.0)
    }

    /// Returns the level curve's state at `signed_push`, in radians, and the root search that found it. The search uses no slopes,
    /// because the slope of the push angle is zero at the fold.
    pub(super) fn bracketed_push(
        &self,
        nodes: &[CurveNode],
        signed_push: f64,
    ) -> Option<(CurveNode, Root)> {
        let miss = |node: &CurveNode| node.signed_push - signed_push;
        let is_between = |pair: &&[CurveNode]| miss(&pair[0]) * miss(&pair[1]) <= 0.0;
        let [from, to] = nodes.windows(2).find(is_between)? else {
            return None;
        };
        let is_from_closer = miss(from).abs() < miss(to).abs();
        let mut best = if is_from_closer { *from } else { *to };
        let ends = [[0.0, miss(from)], [1.0, miss(to)]];
        // The corrector leaves an error of this size.
        let tolerance = self.rounding(from).max(self.rounding(to)) * signed_push.abs().max(1.0);
        let root = illinois(ends, tolerance, |part| {
            let start = from.point.lerp(to.point, part);
            let (point, full) = self.correct(&[start], ON_CURVE).pop()??;
            let node = self.node(point, &full, from.signed_push, from.angle);
            if miss(&node).abs() < miss(&best).abs() {
                best = node;
            }
            Some(miss(&node))
        })?;
        Some((best, root))
    }

    /// Returns the rounding error in `ln D` and in the push angle near a node. It comes from the lever arms, through which the load turns
    /// the rod.
    pub(super) fn rounding(&self, node: &CurveNode) -> f64 {
        let s = arclength(&self.rod, node.point.x);
        let q = (node.point.y * s * s).abs() * self.rod.softness(node.point.x);
        ON_CURVE * (ROUGHENING * q).max(1.0)
    }

    /// Moves each point onto the level curve, to `tolerance` in `ln D` or to rounding. Returns `(tau, load)` and the state of each point,
    /// `[point]`, or `None` where the corrector fails.
    #[must_use]
    pub fn correct(&self, points: &[DVec2], tolerance: f64) -> Vec<Option<(DVec2, FullState)>> {
        let point = |point: &DVec2| (self, *point, tolerance);
        correct(&points.iter().map(point).collect::<Vec<_>>())
    }
}
