//! States of a branch: at a push angle, and on the course of a contact with friction.

use super::{BranchPoint, NoState, StableBranch};
use crate::friction::{ContactPhase, ContactQuery, FrictionState, Sliding, states};
use crate::sheet::{CurveNode, LevelCurve, Path};
use glam::DVec2;
use std::borrow::Cow;
use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::{FullState, Reader, Reading};

/// State of a branch at a push angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateAtPush {
    /// Contact coordinate and signed load of the state, `(tau, load)`, dimensionless.
    pub point: DVec2,
    /// Push angle of the state as requested, signed, in radians.
    pub signed_push: f64,
    /// Angle of the tangent at the contact, from the base's tangent, in radians.
    pub angle: f64,
    /// True if the state at the push angle is stable.
    pub stable: bool,
    /// Force ratio of the state: tangential over normal force at the contact, with the sign of the side; 0 without friction.
    pub ratio: f64,
    /// Sliding direction of the contact; `None` without friction.
    pub sliding: Option<Sliding>,
    /// Pole, pose of the base, force and energy of the state, in the frame of the contact, dimensionless.
    pub full: FullState,
}

impl StateAtPush {
    /// Creates the state of a node on the stable or the unstable part of a branch, with this force ratio and sliding direction.
    pub(super) fn of(node: &CurveNode, stable: bool, ratio: f64, sliding: Option<Sliding>) -> Self {
        Self {
            point: node.point,
            signed_push: node.signed_push,
            angle: node.angle,
            stable,
            ratio,
            sliding,
            full: node.full,
        }
    }
}

impl StableBranch {
    /// Returns the values of `state` in mm, deg, uN and nN m.
    #[must_use]
    pub fn read(&self, state: &StateAtPush) -> Reading {
        let reader = Reader::new(self.units, &self.rod(state.ratio));
        reader.read(state.point.x, &state.full, self.path.level.row.touch, state.signed_push)
    }

    /// Returns `state` as a point of the branch without a mark.
    #[must_use]
    pub fn point_of(&self, state: &StateAtPush) -> BranchPoint {
        self.point(state, self.peaks(std::slice::from_ref(state))[0])
    }

    /// Returns the stable state at `signed_push`, in radians.
    ///
    /// # Errors
    /// No such state exists. The error names how the whisker leaves the pole, and at which push angle.
    pub fn state(&self, signed_push: f64) -> Result<StateAtPush, NoState> {
        let Path { level, fold, .. } = &self.path;
        let outside = |[touch, end]: [f64; 2]| {
            let at_deg = end.to_degrees();
            match (level.side.sign() * signed_push < 0.0, fold) {
                (true, _) => NoState::LostTouch {
                    stays_deg: [touch.min(end), touch.max(end)].map(f64::to_degrees),
                },
                (false, Some(_)) => NoState::SlippedOff { at_deg },
                (false, None) => NoState::PulledOff { at_deg },
            }
        };
        let node = self.node_at(self.path.stable(), signed_push, outside)?;
        Ok(self.pushed(&[node])?[0])
    }

    /// Returns the node at `signed_push`, in radians, in a `part` of the path. For other push angles, `outside` returns the error from the first and
    /// the last push angle of the part.
    pub(super) fn node_at(
        &self,
        part: &[CurveNode],
        signed_push: f64,
        outside: impl FnOnce([f64; 2]) -> NoState,
    ) -> Result<CurveNode, NoState> {
        let ends @ [first, last] = [part[0].signed_push, part[part.len() - 1].signed_push];
        // A push angle that was printed in degrees may lie a few roundings beyond the end.
        let inside = signed_push.clamp(first.min(last), first.max(last));
        let signed_push = if (inside - signed_push).abs() <= 8.0 * f64::EPSILON * signed_push.abs()
        {
            inside
        } else {
            signed_push
        };
        let node = self.path.level.state_at_push(part, signed_push);
        let node = node.map(|node| CurveNode { signed_push, ..node });
        node.ok_or_else(|| match signed_push == inside {
            true => self.failed(),
            false => outside(ends),
        })
    }

    /// Returns the stable states of a push at the push angles of `nodes`, `[node]`. A node is the state of a contact that slides toward the
    /// tip.
    ///
    /// # Errors
    /// With friction, the course of the contact up to a push angle, or the state there, is not found.
    pub(super) fn pushed(&self, nodes: &[CurveNode]) -> Result<Vec<StateAtPush>, NoState> {
        self.each_pushed(nodes).into_iter().collect()
    }

    /// Returns the stable state of a push at the push angle of each of the `nodes`, as [`Self::pushed`] does: `[node]`. With friction, an entry is the
    /// reason why the course of the contact, or the state, is not found.
    pub(super) fn each_pushed(&self, nodes: &[CurveNode]) -> Vec<Result<StateAtPush, NoState>> {
        let LevelCurve { side, rod, .. } = &self.path.level;
        let (sign, friction) = (side.sign(), rod.friction);
        let unmoved = |node, sliding| StateAtPush::of(node, true, friction, sliding);
        if friction == 0.0 {
            return nodes.iter().map(|node| Ok(unmoved(node, None))).collect();
        }
        let lost = |node: &CurveNode| NoState::NoCourse { push_deg: node.signed_push.to_degrees() };
        let Some(history) = &self.history else {
            return nodes.iter().map(|node| Err(lost(node))).collect();
        };
        let phases = nodes.iter().map(|node| history.phase(sign * node.signed_push));
        let phases: Vec<ContactPhase> = phases.collect();
        // At first touch there is no load, and so no friction.
        let is_moved = |phase: &ContactPhase, node: &CurveNode| {
            phase.sliding() != Sliding::Tip && sign * node.signed_push > 0.0
        };
        let pairs = || nodes.iter().zip(&phases);
        let moved = pairs().filter(|(node, phase)| is_moved(phase, node));
        let queries = moved.map(|(node, phase)| ContactQuery {
            history,
            push: sign * node.signed_push,
            phase: *phase,
        });
        let mut found = states(&queries.collect::<Vec<_>>()).into_iter();
        let pushed = pairs().map(|(node, phase)| {
            if !is_moved(phase, node) {
                return Ok(unmoved(node, Some(phase.sliding())));
            }
            let state: FrictionState = found.next().flatten().ok_or_else(|| lost(node))?;
            Ok(StateAtPush::of(
                &state.node(node.signed_push),
                true,
                state.at.ratio,
                Some(state.sliding),
            ))
        });
        pushed.collect()
    }

    /// Returns the rod of the branch with the force ratio `ratio` as its friction.
    pub(super) fn rod(&self, ratio: f64) -> Cow<'_, Rod> {
        let rod = &self.path.level.rod;
        if ratio == rod.friction {
            return Cow::Borrowed(rod);
        }
        Cow::Owned(rod.with_friction(ratio))
    }
}
