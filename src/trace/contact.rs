//! States of a branch with friction: states on the course of the contact replace states that slide toward the tip.

use super::{Branch, NoState, StateAtPush};
use crate::friction::{ContactPhase, ContactQuery, FrictionState, Sliding, states};
use crate::sheet::CurveNode;
use std::borrow::Cow;
use whiskmap_mechanics::rod::Rod;

impl Branch {
    /// Returns the stable states of a push at the push angles of `nodes`, `[node]`. A node is the state of a contact that slides toward the
    /// tip.
    ///
    /// # Errors
    /// With friction, the course of the contact up to a push angle, or the state there, is not found.
    pub(super) fn pushed(&self, nodes: &[CurveNode]) -> Result<Vec<StateAtPush>, NoState> {
        self.each_pushed(nodes).into_iter().collect()
    }

    /// Returns the stable state of a push at the push angle of each of the `nodes`, as [`Branch::pushed`] does: `[node]`. With friction, an entry is the
    /// reason why the course of the contact, or the state, is not found.
    pub(super) fn each_pushed(&self, nodes: &[CurveNode]) -> Vec<Result<StateAtPush, NoState>> {
        let sign = self.level.side.sign();
        let friction = self.level.rod.friction;
        let unmoved = |node, sliding| StateAtPush::of(node, true, friction, sliding);
        if friction == 0.0 {
            return nodes.iter().map(|node| Ok(unmoved(node, None))).collect();
        }
        let lost = |node: &CurveNode| NoState::NoCourse {
            push_deg: node.push.to_degrees(),
        };
        let Some(history) = &self.history else {
            return nodes.iter().map(|node| Err(lost(node))).collect();
        };
        let phases = nodes.iter().map(|node| history.phase(sign * node.push));
        let phases: Vec<ContactPhase> = phases.collect();
        // At first touch there is no load, and so no friction.
        let is_moved = |phase: &ContactPhase, node: &CurveNode| {
            phase.sliding() != Sliding::Tip && sign * node.push > 0.0
        };
        let pairs = || nodes.iter().zip(&phases);
        let moved = pairs().filter(|(node, phase)| is_moved(phase, node));
        let queries = moved.map(|(node, phase)| ContactQuery {
            history,
            push: sign * node.push,
            phase: *phase,
        });
        let mut found = states(&queries.collect::<Vec<_>>()).into_iter();
        let pushed = pairs().map(|(node, phase)| {
            if !is_moved(phase, node) {
                return Ok(unmoved(node, Some(phase.sliding())));
            }
            let state: FrictionState = found.next().flatten().ok_or_else(|| lost(node))?;
            Ok(StateAtPush::of(
                &state.node(node.push),
                true,
                state.at.ratio,
                Some(state.sliding),
            ))
        });
        pushed.collect()
    }

    /// Returns the unstable states `nodes`, `[node]`. They have the friction of a contact that slides toward the tip, as the last stable states do.
    pub(super) fn beyond_fold(&self, nodes: &[CurveNode]) -> Vec<StateAtPush> {
        let friction = self.level.rod.friction;
        let sliding = (friction != 0.0).then_some(Sliding::Tip);
        let states = nodes.iter();
        states
            .map(|node| StateAtPush::of(node, false, friction, sliding))
            .collect()
    }

    /// Returns the rod of the branch with the force ratio `ratio` as its friction.
    pub(super) fn rod(&self, ratio: f64) -> Cow<'_, Rod> {
        let rod = &self.level.rod;
        if ratio == rod.friction {
            return Cow::Borrowed(rod);
        }
        Cow::Owned(Rod {
            friction: ratio,
            ..rod.clone()
        })
    }
}
