//! State of a branch at a push angle.

use super::{Branch, BranchPoint, NoState};
use crate::friction::Sliding;
use crate::sheet::{Continuation, CurveNode};
use whiskmap_mechanics::shooting::{FullState, Reader, Reading};

/// State of a branch at a push angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateAtPush {
    /// Contact coordinate `tau` of the state, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` of the state, dimensionless.
    pub load: f64,
    /// Push angle of the state as requested, signed, in radians.
    pub push: f64,
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
            tau: node.point.x,
            load: node.point.y,
            push: node.push,
            angle: node.angle,
            stable,
            ratio,
            sliding,
            full: node.full,
        }
    }
}

impl Branch {
    /// Returns the values of `state` in mm, deg, uN and nN m.
    #[must_use]
    pub fn read(&self, state: &StateAtPush) -> Reading {
        let reader = Reader::new(self.units, &self.rod(state.ratio));
        reader.read(state.tau, &state.full, self.level.row.touch, state.push)
    }

    /// Returns `state` as a point of the branch without a mark.
    #[must_use]
    pub fn point_of(&self, state: &StateAtPush) -> BranchPoint {
        self.point(state, self.peaks(std::slice::from_ref(state))[0])
    }

    /// Returns the state at the signed `push`, in radians, on the stable or the unstable part of the branch.
    ///
    /// # Errors
    /// No such state exists. The error names how the whisker leaves the pole, and at which push angle.
    pub fn state(&self, push: f64, stable: bool) -> Result<StateAtPush, NoState> {
        let Continuation { nodes, fold, end } = &self.continuation;
        let part = match (fold, stable) {
            (Some(fold), true) => &nodes[..=*fold],
            (Some(fold), false) => &nodes[*fold..],
            (None, true) => &nodes[..],
            (None, false) => {
                return Err(NoState::NoFold {
                    at_deg: nodes[nodes.len() - 1].push.to_degrees(),
                });
            }
        };
        let (first, last) = (&part[0], &part[part.len() - 1]);
        // A push angle that was printed in degrees may lie a few roundings beyond the end.
        let ends = [first.push.min(last.push), first.push.max(last.push)];
        let inside = push.clamp(ends[0], ends[1]);
        let push = if (inside - push).abs() <= 8.0 * f64::EPSILON * push.abs() {
            inside
        } else {
            push
        };
        let Some(node) = self.level.state_at_push(part, push) else {
            let at_deg = last.push.to_degrees();
            let within = (first.push - push) * (last.push - push) <= 0.0;
            let sign = self.level.side.sign();
            return Err(match (stable, fold, end) {
                _ if within => self.failed(),
                (true, ..) if sign * push < 0.0 => NoState::LostTouch {
                    stays_deg: ends.map(f64::to_degrees),
                },
                (false, ..) => NoState::NotUnstable {
                    ends_deg: [first.push.to_degrees(), at_deg],
                },
                (true, Some(_), _) => NoState::SlippedOff { at_deg },
                (true, None, _) => NoState::PulledOff { at_deg },
            });
        };
        let node = CurveNode { push, ..node };
        Ok(match stable {
            true => self.pushed(&[node])?[0],
            false => self.beyond_fold(&[node])[0],
        })
    }
}
