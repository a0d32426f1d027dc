//! Phases of a course: on which side of the pole the whisker is, or free, and the angles at which that changes.

use super::{Undecided, WhiskEventKind};
use crate::rod::Side;
use std::f64::consts::TAU;

/// Phase of a course: what the angle of the base alone does not tell. `turn` counts whole turns of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// The whisker is free between its CF touch of this turn and the CB touch of the next.
    Free { turn: i32 },
    /// The pole bends the whisker on this side.
    Contact { side: Side, turn: i32 },
    /// The whisker is somewhere between its two touches of this turn.
    Undecided { turn: i32, reason: Undecided },
}

/// Change of the phase at an angle of the base, in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Angle of the base at which the phase changes, in radians.
    pub angle: f64,
    /// Kind of the event; `None` where a detachment's kind is that of the end of the push.
    pub event: Option<WhiskEventKind>,
    /// Contact that begins or ends.
    pub side: Side,
    /// Push since the touch of this contact, in radians, as a magnitude.
    pub push: f64,
}

/// Angles of one turn at which phases change, in radians.
#[derive(Clone, Copy, Debug)]
pub struct Turns {
    /// Angle of the base at first touch on CF. On CB it is 0.
    pub cf_touch: f64,
    /// Largest push on CB.
    pub cb_end: f64,
    /// Largest push on CF, as a magnitude; `None` if the resting whisker does not reach the pole on CF.
    pub cf_end: Option<f64>,
}

/// Largest error of an angle that was printed in degrees, in radians.
const ROUNDING: f64 = 8.0 * f64::EPSILON * TAU;

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
        is_free.then_some(Phase::Free { turn: turn as i32 })
    }

    /// Returns the push of a contact on `side` at `angle`, in radians, as a magnitude.
    pub fn push(&self, side: Side, turn: i32, angle: f64) -> f64 {
        let from_turn = angle - TAU * f64::from(turn);
        match side {
            Side::Cb => from_turn,
            Side::Cf => self.cf_touch - from_turn,
        }
    }

    /// Moves the base from the angle `from` to `to`, in radians, and calls `event` at each touch, release and detachment.
    pub fn pass(&self, phase: &mut Phase, from: f64, to: f64, mut event: impl FnMut(Passage)) {
        let grows = to > from;
        loop {
            let (angle, next) = self.change(*phase, grows);
            let is_passed = if grows { angle < to } else { angle > to };
            if from == to || !is_passed {
                return;
            }
            let before = std::mem::replace(phase, next);
            for (state, begins) in [(before, false), (next, true)] {
                if let (Phase::Undecided { reason, .. }, true) = (state, begins) {
                    event(Passage {
                        angle,
                        event: Some(WhiskEventKind::Undecided),
                        side: match reason {
                            Undecided::TipEdge => Side::Cf,
                            _ if grows => Side::Cf,
                            _ => Side::Cb,
                        },
                        push: f64::NAN,
                    });
                }
                let Phase::Contact { side, turn } = state else {
                    continue;
                };
                let push = self.push(side, turn, angle).max(0.0);
                let kind = match (begins, grows == (side == Side::Cb)) {
                    (true, _) => Some(WhiskEventKind::Touch),
                    (false, false) => Some(WhiskEventKind::Release),
                    (false, true) => None,
                };
                event(Passage {
                    angle,
                    event: kind,
                    side,
                    push,
                });
            }
        }
    }

    /// Returns the angle at which `phase` ends if the base turns on in one direction, and the next phase.
    fn change(&self, phase: Phase, grows: bool) -> (f64, Phase) {
        let cf_touch = |turn: i32| self.cf_touch + TAU * f64::from(turn);
        let cb_touch = |turn: i32| TAU * f64::from(turn);
        let free = |turn: i32| Phase::Free { turn };
        match (phase, grows) {
            (Phase::Free { turn }, true) => {
                let side = Side::Cb;
                let turn = turn + 1;
                (cb_touch(turn), Phase::Contact { side, turn })
            }
            (Phase::Free { turn }, false) => {
                let reason = Undecided::TipEdge;
                let next = match self.cf_end {
                    Some(_) => Phase::Contact {
                        side: Side::Cf,
                        turn,
                    },
                    None => Phase::Undecided { turn, reason },
                };
                (cf_touch(turn), next)
            }
            (
                Phase::Contact {
                    side: Side::Cb,
                    turn,
                },
                true,
            ) => {
                let angle = cb_touch(turn) + self.cb_end;
                let is_clear = angle >= cf_touch(turn);
                let next = if is_clear {
                    free(turn)
                } else {
                    self.over(Side::Cf, turn, angle)
                };
                (angle, next)
            }
            (
                Phase::Contact {
                    side: Side::Cb,
                    turn,
                },
                false,
            ) => (cb_touch(turn), free(turn - 1)),
            (
                Phase::Contact {
                    side: Side::Cf,
                    turn,
                },
                true,
            ) => (cf_touch(turn), free(turn)),
            (
                Phase::Contact {
                    side: Side::Cf,
                    turn,
                },
                false,
            ) => {
                let angle = cf_touch(turn) - self.cf_end.unwrap_or_default();
                let is_clear = angle <= cb_touch(turn);
                let next = if is_clear {
                    free(turn - 1)
                } else {
                    self.over(Side::Cb, turn, angle)
                };
                (angle, next)
            }
            (Phase::Undecided { turn, .. }, true) => (cf_touch(turn), free(turn)),
            (Phase::Undecided { turn, .. }, false) => (cb_touch(turn), free(turn - 1)),
        }
    }

    /// Returns the phase after a detachment at `angle` where the resting whisker would cross the pole: contact on the other `side` if
    /// that side holds the whisker.
    fn over(&self, side: Side, turn: i32, angle: f64) -> Phase {
        let end = match side {
            Side::Cb => Some(self.cb_end),
            Side::Cf => self.cf_end,
        };
        let push = self.push(side, turn, angle);
        match end.is_some_and(|end| push < end) {
            true => Phase::Contact { side, turn },
            false => Phase::Undecided {
                turn,
                reason: Undecided::OnThePole,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TURNS: Turns = Turns {
        cf_touch: 0.1,
        cb_end: 0.5,
        cf_end: Some(0.7),
    };

    /// Events of a course through these angles: what happens, on which side, and at which angle.
    fn events(turns: &Turns, angles: &[f64]) -> Vec<(Option<WhiskEventKind>, Side, f64)> {
        let mut events = Vec::new();
        let mut phase = turns.begin(angles[0]).unwrap_or(Phase::Free { turn: 99 });
        for pair in angles.windows(2) {
            turns.pass(&mut phase, pair[0], pair[1], |passage| {
                events.push((passage.event, passage.side, passage.angle));
            });
        }
        events
    }

    #[test]
    fn a_whisker_that_slips_off_comes_back_on_the_other_side() {
        use WhiskEventKind::{Release, Touch};
        let found = events(&TURNS, &[-0.2, 1.0, -1.0]);
        let end = 0.1 - 0.7;
        let wanted = [
            (Some(Touch), Side::Cb, 0.0),
            (None, Side::Cb, 0.5),
            (Some(Touch), Side::Cf, 0.1),
            (None, Side::Cf, end),
        ];
        assert_eq!(found, wanted);
        // A push that turns back is released where it began.
        let found = events(&TURNS, &[0.0, 0.4, -0.2, 0.5]);
        let wanted = [
            (Some(Touch), Side::Cb, 0.0),
            (Some(Release), Side::Cb, 0.0),
            (Some(Touch), Side::Cb, 0.0),
        ];
        assert_eq!(found, wanted);
    }

    #[test]
    fn a_whole_turn_touches_from_behind() {
        let found = events(&TURNS, &[0.2, 6.0, 7.0]);
        assert_eq!(found[0], (Some(WhiskEventKind::Touch), Side::Cb, TAU));
        assert_eq!(found[1], (None, Side::Cb, TAU + 0.5));
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn a_course_cannot_begin_in_contact() {
        assert_eq!(TURNS.begin(0.05), None);
        assert_eq!(TURNS.begin(0.0), Some(Phase::Free { turn: -1 }));
        assert_eq!(TURNS.begin(0.1), Some(Phase::Free { turn: 0 }));
        // In front of a point both touches are at the same angle, and a push to CB comes first.
        let point = Turns {
            cf_touch: 0.0,
            ..TURNS
        };
        assert_eq!(point.begin(0.0), Some(Phase::Free { turn: -1 }));
        assert_eq!(point.begin(0.1), Some(Phase::Free { turn: 0 }));
    }

    /// Before a thick pole, a short push ends where the resting whisker would cross the pole.
    #[test]
    fn a_whisker_on_the_pole_is_undecided() {
        let thick = Turns {
            cf_touch: 0.4,
            cb_end: 0.2,
            cf_end: Some(0.1),
        };
        let mut phase = Phase::Free { turn: -1 };
        let mut last = None;
        thick.pass(&mut phase, -0.1, 0.35, |passage| last = passage.event);
        assert_eq!(last, Some(WhiskEventKind::Undecided));
        let reason = Undecided::OnThePole;
        assert_eq!(phase, Phase::Undecided { turn: 0, reason });
        thick.pass(&mut phase, 0.35, 0.45, |_| {});
        assert_eq!(phase, Phase::Free { turn: 0 });
        // A side that holds the whisker takes it over.
        let held = Turns {
            cf_end: Some(0.3),
            ..thick
        };
        let mut phase = Phase::Free { turn: -1 };
        held.pass(&mut phase, -0.1, 0.35, |_| {});
        let side = Side::Cf;
        assert_eq!(phase, Phase::Contact { side, turn: 0 });
        // Without a touch on CF, the tip's edge meets the pole.
        let short = Turns {
            cf_end: None,
            ..thick
        };
        let mut phase = Phase::Free { turn: 0 };
        short.pass(&mut phase, 0.5, 0.3, |_| {});
        let reason = Undecided::TipEdge;
        assert_eq!(phase, Phase::Undecided { turn: 0, reason });
    }
}
