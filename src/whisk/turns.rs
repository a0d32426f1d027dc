//! One pole in front of a base that can turn around it: the same obstacle after each turn.

use super::phase::{Obstacles, Phase, ROUNDING};
use crate::rod::Side;
use std::f64::consts::TAU;

/// Angles of one turn at which phases change, in radians. The number of an obstacle counts whole turns of the base.
#[derive(Clone, Copy, Debug)]
pub struct Turns {
    /// Angle of the base at first touch on CF. On CB it is 0.
    pub cf_touch: f64,
    /// Largest push on CB.
    pub cb_end: f64,
    /// Largest push on CF, as a magnitude; `None` if the resting whisker does not reach the pole on CF.
    pub cf_end: Option<f64>,
}

impl Turns {
    /// Returns the phase in which a course begins at `angle`, in radians; `None` in contact.
    pub fn begin(&self, angle: f64) -> Option<Phase> {
        // At a touch on CB the whisker is still on that side, in front of a point as well.
        let cb_touch = (angle / TAU).round();
        let turn = match (angle - TAU * cb_touch).abs() <= ROUNDING {
            true => cb_touch - 1.0,
            false => ((angle + ROUNDING - self.cf_touch) / TAU).floor(),
        };
        let is_free = angle <= TAU * (turn + 1.0) + ROUNDING;
        // Courses have at most a turn to each side.
        let after = turn as i32;
        is_free.then_some(Phase::Free { after })
    }
}

impl Obstacles for Turns {
    fn touch(&self, side: Side, turn: i32) -> f64 {
        let from_turn = match side {
            Side::Cb => 0.0,
            Side::Cf => self.cf_touch,
        };
        from_turn + TAU * f64::from(turn)
    }

    fn end(&self, side: Side, _turn: i32) -> Option<f64> {
        match side {
            Side::Cb => Some(self.cb_end),
            Side::Cf => self.cf_end,
        }
    }
}
