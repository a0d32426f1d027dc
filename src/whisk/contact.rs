//! Contacts along a course: one after the other, each from its touch to its release or detachment, with friction or without.

use super::states::{BothSides, CourseContact};
use crate::friction::{ContactCourse, ContactPhase, CourseLimits, Sliding};
use whiskmap_mechanics::rod::Side;

/// Change of a contact between its touch and its end.
#[derive(Clone, Copy, Debug)]
pub struct ContactChange {
    /// Push of the change since the touch, in radians, as a magnitude.
    pub push: f64,
    /// Phase of the contact before a snap; `None` where the contact leaves the limits that are known.
    pub before: Option<ContactPhase>,
}

/// Contacts of a course, followed in the order of time. Without friction, they have no limits, and nothing is dissipated.
pub struct CourseContacts<'a> {
    sides: &'a BothSides,
    /// Contact that has begun and not ended, with its side.
    open: Option<(Side, ContactCourse<'a>)>,
    /// Energy dissipated in contacts that have ended, in `E I_base/L_w`.
    ended: f64,
    /// True from a release or detachment on at which the contact sticks, so that its course is not known.
    pub is_lost: bool,
}

impl<'a> CourseContacts<'a> {
    /// Creates the contacts of a course that begins without contact.
    pub const fn new(sides: &'a BothSides) -> Self {
        Self {
            sides,
            open: None,
            ended: 0.0,
            is_lost: false,
        }
    }

    /// Forgets the contact after a gap in the course. The energy dissipated so far is no longer known.
    pub fn forget(&mut self) {
        self.open = None;
        if Side::BOTH.iter().any(|side| self.limits(*side).is_some()) {
            self.ended = f64::NAN;
        }
        self.is_lost = false;
    }

    /// Returns the limits of a contact on `side`; `None` without friction.
    fn limits(&self, side: Side) -> Option<&'a CourseLimits> {
        self.sides.of(side)?.limits(0)
    }

    /// Begins a contact on `side`, moves it from first touch to `push`, a magnitude in radians, and returns it.
    pub fn touch(&mut self, side: Side, push: f64) -> CourseContact {
        let limits = self.limits(side);
        self.open = limits.map(|limits| (side, limits.begin()));
        self.to(side, push).0
    }

    /// Moves the contact on `side` to `push`, a magnitude in radians, at which it ends or turns back. Returns the contact there, and the
    /// changes on the way, `[change]`.
    pub fn to(&mut self, side: Side, push: f64) -> (CourseContact, Vec<ContactChange>) {
        if let Some((_, course)) = &mut self.open {
            course.to(push);
        }
        let phase = self.open.as_ref().map(|(_, course)| course.phase);
        (CourseContact { side, push, phase }, self.changes())
    }

    /// Returns the contact on `side` at `push`, a magnitude in radians, on its way, the energy dissipated so far, and the changes before it,
    /// `[change]`.
    pub fn at(&mut self, side: Side, push: f64) -> (CourseContact, f64, Vec<ContactChange>) {
        let reached = self.open.as_mut().map(|(_, course)| course.at(push));
        let phase = reached.as_ref().map(|course| course.phase);
        let dissipated = self.ended + reached.map_or(0.0, |course| course.dissipated);
        (
            CourseContact { side, push, phase },
            dissipated,
            self.changes(),
        )
    }

    /// Returns the changes of the contact since the last call, `[change]`.
    fn changes(&mut self) -> Vec<ContactChange> {
        let Some((_, course)) = &mut self.open else {
            return Vec::new();
        };
        let snaps = std::mem::take(&mut course.snaps)
            .into_iter()
            .map(|snap| ContactChange {
                push: snap.push,
                before: Some(snap.before),
            });
        let lost = course.lost_at.filter(|_| !self.is_lost);
        self.is_lost |= lost.is_some();
        let lost = lost.map(|push| ContactChange { push, before: None });
        snaps.chain(lost).collect()
    }

    /// Ends the contact after its last move. At a release no unstable states may be left ahead; a detachment needs a contact that slides
    /// toward the tip.
    pub fn leave(&mut self, is_release: bool) {
        let Some((_, course)) = self.open.take() else {
            return;
        };
        self.ended += course.dissipated;
        self.is_lost |= match is_release {
            true => course.is_beyond,
            false => course.phase != ContactPhase::Slides(Sliding::Tip),
        };
    }

    /// Returns the energy that friction has dissipated so far, in `E I_base/L_w`.
    pub fn dissipated(&self) -> f64 {
        let open = self.open.as_ref();
        self.ended + open.map_or(0.0, |(_, course)| course.dissipated)
    }
}
