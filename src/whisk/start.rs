//! Start of a course at an angle at which the whisker may be free or in contact.

use super::Undecided;
use super::phase::{Obstacles, Phase};
use super::turns::Turns;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::Side;

/// State in which a course begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CourseStart {
    /// The whisker is free. At an angle beyond first touch, it has passed the pole.
    Free,
    /// The pole bends the whisker, as after a push from first touch to the first angle: on CB if that side holds it, otherwise on CF.
    Contact,
}

/// Start of a course, point of its curvature, gaps that it bridges, and cancellation.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct WhiskOptions {
    /// State in which the course begins. `None` assumes a free whisker.
    pub start: Option<CourseStart>,
    /// Arclength from the base, in mm, at which samples have the curvature; `None` for samples without it.
    pub curvature_at_mm: Option<f64>,
    /// Longest gap, in s, across which the course continues along a straight line: the time between the angles before and after missing
    /// ones. The default 0 bridges none.
    pub bridge_s: f64,
    /// Flag that cancels: if true, the course soon ends with [`WhiskError::Cancelled`](super::WhiskError::Cancelled). `None` if nothing cancels.
    pub cancel: Option<Arc<AtomicBool>>,
}

impl WhiskOptions {
    /// Returns true if the course is cancelled.
    pub(super) fn is_cancelled(&self) -> bool {
        let cancel = self.cancel.as_ref();
        cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }
}

impl Turns {
    /// Returns the contacts that hold the whisker at `angle`, in radians, `[contact]`: at most one a side. CB comes first.
    pub fn held(&self, angle: f64) -> impl Iterator<Item = Phase> {
        let cf_turn = ((angle - self.cf_touch) / TAU).ceil();
        let touches = [(Side::Cb, (angle / TAU).floor()), (Side::Cf, cf_turn)];
        touches.into_iter().filter_map(move |(side, turn)| {
            // Courses have at most a turn to each side.
            let obstacle = turn as i32;
            let end = self.end(side, obstacle)?;
            let is_held = self.push(side, obstacle, angle) < end;
            is_held.then_some(Phase::Contact { side, obstacle })
        })
    }

    /// Returns every phase in which a whisker of unknown history can be at `angle`, in radians, `[phase]`.
    pub fn possible(&self, angle: f64) -> Vec<Phase> {
        let free = self.begin(angle);
        // Between both touches of a thick pole, the whisker may lie on the pole.
        let on_the_pole = free.is_none().then(|| Phase::Undecided {
            obstacle: (angle / TAU).floor() as i32,
            reason: Undecided::OnThePole,
        });
        let known = free.into_iter().chain(on_the_pole);
        known.chain(self.held(angle)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_begins_on_the_side_that_holds_the_whisker() {
        let turns = Turns {
            cf_touch: 0.1,
            cb_end: 0.5,
            cf_end: Some(0.7),
        };
        let contact = |side, obstacle| Some(Phase::Contact { side, obstacle });
        for (angle, wanted) in [
            (0.3, contact(Side::Cb, 0)),
            (0.05, contact(Side::Cb, 0)),
            (0.6, None),
            (-0.3, contact(Side::Cf, 0)),
            (-0.65, None),
            (0.3 - TAU, contact(Side::Cb, -1)),
            (TAU - 0.3, contact(Side::Cf, 1)),
        ] {
            assert_eq!(turns.held(angle).next(), wanted, "{angle}");
        }
        let short = Turns {
            cf_end: None,
            ..turns
        };
        assert_eq!(short.held(-0.3).next(), None);
    }

    /// Without its history, a whisker is free or in a contact that holds it. It is certainly free only beyond the ends of both pushes.
    #[test]
    fn a_whisker_of_unknown_history_has_all_possible_phases() {
        let turns = Turns {
            cf_touch: 0.1,
            cb_end: 0.5,
            cf_end: Some(0.7),
        };
        let (before, past) = (Phase::Free { after: -1 }, Phase::Free { after: 0 });
        let [cb, cf] = [Side::Cb, Side::Cf].map(|side| Phase::Contact { side, obstacle: 0 });
        let reason = Undecided::OnThePole;
        let on_the_pole = Phase::Undecided {
            obstacle: 0,
            reason,
        };
        for (angle, wanted) in [
            (-0.65, vec![before]),
            (-0.3, vec![before, cf]),
            (0.05, vec![on_the_pole, cb, cf]),
            (0.3, vec![past, cb]),
            (0.55, vec![past]),
        ] {
            assert_eq!(turns.possible(angle), wanted, "{angle}");
        }
    }
}
