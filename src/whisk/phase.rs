//! Phases of a course: which obstacle holds the whisker on which side, or free, and the angles at which that changes.

use super::{AngleCourse, Undecided, WhiskEventKind};
use std::f64::consts::TAU;
use whiskmap_mechanics::rod::Side;

/// Phase of a course: what the angle of the base alone does not determine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// The whisker is free between the CF touch of the obstacle `after` and the CB touch of the next one.
    Free { after: i32 },
    /// An obstacle bends the whisker on this side.
    Contact { side: Side, obstacle: i32 },
    /// The whisker is somewhere between its CB touch and its CF touch of this obstacle, for this reason.
    Undecided { obstacle: i32, reason: Undecided },
}

/// Largest error of an angle that was printed in degrees, in radians.
pub const ROUNDING: f64 = 8.0 * f64::EPSILON * TAU;

/// Change of the phase at an angle of the base, in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Angle of the base at which the phase changes, in radians.
    pub angle: f64,
    /// Kind of the event.
    pub event: WhiskEventKind,
    /// Side of the contact that begins or ends.
    pub side: Side,
    /// Number of the obstacle whose contact begins or ends.
    pub obstacle: i32,
    /// Push since the touch of this contact, in radians, as a magnitude; NaN where the phase is undecided.
    pub push: f64,
}

/// End of a push against an obstacle, where the whisker detaches.
#[derive(Clone, Copy, Debug)]
pub struct ContactEnd {
    /// Push since the touch, in radians, as a magnitude.
    pub push: f64,
    /// Kind of the detachment.
    pub kind: WhiskEventKind,
}

/// Obstacles past which the base turns the whisker. They are numbered in the direction of growing angles, on CB. The resting whisker fits
/// between neighbours: the CF touch of an obstacle has a smaller angle than the CB touch of the next one.
pub trait Obstacles {
    /// Returns the angle of the base, in radians, at which the resting whisker touches an obstacle on `side`. Beyond the last obstacle
    /// it is infinite, beyond the first one minus infinity.
    fn touch(&self, side: Side, obstacle: i32) -> f64;

    /// Returns the end of a push against an obstacle on `side`. It is `None` if the resting whisker does not reach the obstacle on that
    /// side.
    fn end(&self, side: Side, obstacle: i32) -> Option<ContactEnd>;

    /// Returns the push against an obstacle on `side` at `angle`, in radians, as a magnitude. It is negative before the touch.
    fn push(&self, side: Side, obstacle: i32, angle: f64) -> f64 {
        side.sign() * (angle - self.touch(side, obstacle))
    }

    /// Returns the phase at each sample of `course`, `[sample]`, which begins in the phase `first`, and the changes between samples with their
    /// times in s, `[change]`.
    fn follow(&self, first: Phase, course: &AngleCourse) -> (Vec<Phase>, Vec<(f64, Passage)>) {
        let mut phase = first;
        let mut phases = vec![first];
        let mut passages = Vec::new();
        let times = course.times_s.windows(2);
        for (angles, times) in course.angles_deg.windows(2).zip(times) {
            let [from, to] = [angles[0], angles[1]].map(f64::to_radians);
            self.pass(&mut phase, from, to, |passage| {
                let part = (passage.angle - from) / (to - from);
                let time_s = (times[1] - times[0]).mul_add(part, times[0]);
                passages.push((time_s, passage));
            });
            phases.push(phase);
        }
        (phases, passages)
    }

    /// Moves the base from the angle `from` to `to`, in radians, and calls `event` at each touch, release and detachment.
    fn pass(&self, phase: &mut Phase, from: f64, to: f64, mut event: impl FnMut(Passage)) {
        let grows = to > from;
        loop {
            let (angle, next) = self.change(*phase, grows);
            let is_passed = if grows { angle < to } else { angle > to };
            if from == to || !is_passed {
                return;
            }
            let before = std::mem::replace(phase, next);
            for (state, begins) in [(before, false), (next, true)] {
                if let Some(passage) = self.passage(state, angle, grows, begins) {
                    event(passage);
                }
            }
        }
    }

    /// Returns the event at which the phase `state` begins or ends at `angle`, in radians; `None` for a free whisker.
    fn passage(&self, state: Phase, angle: f64, grows: bool, begins: bool) -> Option<Passage> {
        match state {
            Phase::Undecided { obstacle, reason } if begins => Some(Passage {
                angle,
                event: WhiskEventKind::Undecided,
                side: match reason {
                    Undecided::TipEdge => ahead(grows),
                    _ => ahead(!grows),
                },
                obstacle,
                push: f64::NAN,
            }),
            Phase::Contact { side, obstacle } => {
                let push = self.push(side, obstacle, angle).max(0.0);
                let (event, push) = match self.end(side, obstacle) {
                    _ if begins => (WhiskEventKind::Touch, push),
                    // The end itself, without the rounding of angles: just before it, the state is nearly singular.
                    Some(end) if side == ahead(grows) => (end.kind, end.push),
                    _ => (WhiskEventKind::Release, push),
                };
                Some(Passage { angle, event, side, obstacle, push })
            }
            _ => None,
        }
    }

    /// Returns the angle, in radians, at which `phase` ends if the base turns on in one direction, and the next phase.
    fn change(&self, phase: Phase, grows: bool) -> (f64, Phase) {
        let side = ahead(grows);
        match phase {
            Phase::Free { after } => {
                let obstacle = after + i32::from(grows);
                let next = match self.end(side, obstacle) {
                    Some(_) => Phase::Contact { side, obstacle },
                    None => Phase::Undecided { obstacle, reason: Undecided::TipEdge },
                };
                (self.touch(side, obstacle), next)
            }
            Phase::Contact { side: held, obstacle } if held == side => {
                let end = self.end(side, obstacle).map_or(0.0, |end| end.push);
                let angle = self.touch(side, obstacle) + side.sign() * end;
                (angle, self.after_detachment(obstacle, angle, grows))
            }
            Phase::Contact { obstacle, .. } | Phase::Undecided { obstacle, .. } => {
                // The whisker is free again on the side to which the base turns.
                let touch = self.touch(ahead(!grows), obstacle);
                (touch, rest(obstacle, grows))
            }
        }
    }

    /// Returns the phase after a detachment from an obstacle at `angle`: contact with the first obstacle ahead that holds the whisker, or
    /// rest before the next one. Where the resting whisker would cross an obstacle that it has passed, the other side of that obstacle
    /// may hold it.
    fn after_detachment(&self, obstacle: i32, angle: f64, grows: bool) -> Phase {
        let (side, step) = (ahead(grows), if grows { 1 } else { -1 });
        let holds = |side, obstacle| {
            let push = self.push(side, obstacle, angle);
            push >= 0.0 && self.end(side, obstacle).is_some_and(|end| push < end.push)
        };
        let mut passed = obstacle;
        while self.push(side, passed + step, angle) >= 0.0 {
            let obstacle = passed + step;
            if holds(side, obstacle) {
                return Phase::Contact { side, obstacle };
            }
            passed = obstacle;
        }
        let side = ahead(!grows);
        if self.push(side, passed, angle) <= 0.0 {
            return rest(passed, grows);
        }
        match holds(side, passed) {
            true => Phase::Contact { side, obstacle: passed },
            false => Phase::Undecided { obstacle: passed, reason: Undecided::OnThePole },
        }
    }
}

/// Returns the side of the whisker on which obstacles are ahead if the angle grows, or falls.
const fn ahead(grows: bool) -> Side {
    if grows { Side::Cb } else { Side::Cf }
}

/// Returns the phase at rest beyond `obstacle` if the angle grows, or before it.
fn rest(obstacle: i32, grows: bool) -> Phase {
    let after = obstacle - i32::from(!grows);
    Phase::Free { after }
}
