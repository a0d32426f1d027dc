//! Start of a course at an angle at which the whisker may be free or in contact.

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

/// Start and cancellation of a course.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct WhiskOptions {
    /// State in which the course begins. `None` assumes a free whisker.
    pub start: Option<CourseStart>,
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
    /// Returns the contact that holds the whisker at `angle`, in radians; `None` if no side does. CB comes first.
    pub fn held(&self, angle: f64) -> Option<Phase> {
        let cf_turn = ((angle - self.cf_touch) / TAU).ceil();
        let touches = [(Side::Cb, (angle / TAU).floor()), (Side::Cf, cf_turn)];
        touches.into_iter().find_map(|(side, turn)| {
            // Courses have at most a turn to each side.
            let obstacle = turn as i32;
            let end = self.end(side, obstacle)?;
            let is_held = self.push(side, obstacle, angle) < end;
            is_held.then_some(Phase::Contact { side, obstacle })
        })
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
            assert_eq!(turns.held(angle), wanted, "{angle}");
        }
        let short = Turns {
            cf_end: None,
            ..turns
        };
        assert_eq!(short.held(-0.3), None);
    }
}
