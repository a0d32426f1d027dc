//! The state of a branch at a push angle.

use super::{Branch, NoState};
use crate::sheet::Continuation;
use crate::shooting::{FullState, Reading};

/// A state found on a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Push angle, signed, in radians: the one asked for but for the residual.
    pub push: f64,
    /// Whether it is on the stable part.
    pub stable: bool,
    /// Everything else.
    pub full: FullState,
}

impl Branch {
    /// A state of the branch in the units of people.
    #[must_use]
    pub fn read(&self, state: &Found) -> Reading {
        self.reading(state.tau, &state.full, state.push)
    }

    /// The state after the signed push angle `push`, in radians, on the stable or the unstable part.
    ///
    /// # Errors
    /// When there is no such state: the message tells how the whisker has left the pole, and at which push angle.
    pub fn state(&self, push: f64, stable: bool) -> Result<Found, NoState> {
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
        // A push angle that was printed in degrees may come back some roundings beyond the end.
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
                _ if within => self.lost(),
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
        Ok(Found {
            tau: node.point.x,
            load: node.point.y,
            push,
            stable,
            full: node.full,
        })
    }
}
