//! Contacts along a course: one after the other, each from its touch to its release or detachment, with friction or without.

use super::states::{BothSides, PushedContact};
use crate::friction::{ContactPhase, CourseLimits, FrictionCourse, Sliding};
use whiskmap_mechanics::rod::Side;

/// Contacts of a course with a single pole, followed in the order of time. Without friction, they have no limits, and nothing is dissipated.
pub struct ContactTracker<'a> {
    sides: &'a BothSides,
    /// Contact that has begun and not ended, with its side.
    open: Option<(Side, FrictionCourse<'a>)>,
    /// Energy dissipated in contacts that have ended, in `E I_base/L_w`.
    ended: f64,
    /// True from a release or detachment on at which the contact sticks, so that its course is not known.
    pub is_lost: bool,
}

impl<'a> ContactTracker<'a> {
    /// Creates the contacts of a course that begins without contact.
    pub const fn new(sides: &'a BothSides) -> Self {
        Self { sides, open: None, ended: 0.0, is_lost: false }
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
    pub fn touch(&mut self, side: Side, push: f64) -> PushedContact {
        let limits = self.limits(side);
        self.open = limits.map(|limits| (side, limits.begin()));
        self.to(side, push).0
    }

    /// Moves the contact on `side` to `push`, a magnitude in radians, at which it ends or turns back. Returns the contact there, and the
    /// changes on the way, `[change]`.
    pub fn to(&mut self, side: Side, push: f64) -> (PushedContact, Vec<PushedContact>) {
        if let Some((_, course)) = &mut self.open {
            course.to(push);
        }
        let phase = self.open.as_ref().map(|(_, course)| course.phase);
        (pushed(side, push, phase), self.changes())
    }

    /// Returns the contact on `side` at `push`, a magnitude in radians, on its way, the energy dissipated so far, and the changes before it,
    /// `[change]`.
    pub fn at(&mut self, side: Side, push: f64) -> (PushedContact, f64, Vec<PushedContact>) {
        let reached = self.open.as_mut().map(|(_, course)| course.at(push));
        let phase = reached.as_ref().map(|course| course.phase);
        let dissipated = self.ended + reached.map_or(0.0, |course| course.dissipated);
        (pushed(side, push, phase), dissipated, self.changes())
    }

    /// Returns the changes of the contact since the last call, `[change]`: its phase before a snap, and no phase where it leaves the limits that are
    /// known.
    fn changes(&mut self) -> Vec<PushedContact> {
        let Some((side, course)) = &mut self.open else {
            return Vec::new();
        };
        let snaps = std::mem::take(&mut course.snaps).into_iter();
        let snaps = snaps.map(|snap| (snap.push, Some(snap.before)));
        let lost = course.lost_at.filter(|_| !self.is_lost);
        self.is_lost |= lost.is_some();
        let changes = snaps.chain(lost.map(|push| (push, None)));
        changes.map(|(push, phase)| pushed(*side, push, phase)).collect()
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

/// Returns the contact with the single pole of a course after a `push`, a magnitude in radians.
pub const fn pushed(side: Side, push: f64, phase: Option<ContactPhase>) -> PushedContact {
    PushedContact { side, row: 0, push, phase }
}
