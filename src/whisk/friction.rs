//! Contacts with friction along a course: one contact after the other, each from its touch to its release or detachment.

use super::contact::CourseContact;
use super::states::SideStates;
use crate::friction::{ContactCourse, ContactPhase, CourseLimits, Sliding, Snap};
use crate::rod::Side;

/// Contacts of a course with friction, followed in the order of time.
pub struct FrictionCourse<'a> {
    limits: [Option<&'a CourseLimits>; 2],
    /// Contact that has begun and not ended, with its side.
    open: Option<(Side, ContactCourse<'a>)>,
    /// Energy dissipated in contacts that have ended, in `E I_base/L_w`.
    ended: f64,
    /// True from a release or detachment on at which the contact sticks, so that its course is not known.
    pub is_lost: bool,
}

impl<'a> FrictionCourse<'a> {
    /// Creates the contacts of a course that begins without contact. `sides` are the states on `[CB, CF]`.
    pub fn new(sides: [Option<&'a SideStates>; 2]) -> Self {
        Self {
            limits: sides.map(|states| states?.limits(0)),
            open: None,
            ended: 0.0,
            is_lost: false,
        }
    }

    /// Begins a contact on `side`, moves it from first touch to `push`, a magnitude in radians, and returns it.
    pub fn touch(&mut self, side: Side, push: f64) -> CourseContact {
        let limits = self.limits[usize::from(side == Side::Cf)];
        self.open = limits.map(|limits| (side, limits.begin()));
        self.to(side, push).0
    }

    /// Moves the contact on `side` to `push`, a magnitude in radians. Returns the contact there, and the snaps on the way, `[snap]`.
    pub fn to(&mut self, side: Side, push: f64) -> (CourseContact, Vec<Snap>) {
        let mut contact = CourseContact {
            side,
            push,
            phase: None,
        };
        let Some((_, course)) = &mut self.open else {
            return (contact, Vec::new());
        };
        course.to(push);
        self.is_lost |= course.is_lost;
        contact.phase = Some(course.phase);
        (contact, std::mem::take(&mut course.snaps))
    }

    /// Ends the contact after its last move. At a release the contact must be at a limit, where no load is left; a detachment needs a
    /// contact that slides toward the tip.
    pub fn leave(&mut self, is_release: bool) {
        let Some((_, course)) = self.open.take() else {
            return;
        };
        self.ended += course.dissipated;
        self.is_lost |= match course.phase {
            ContactPhase::Slides(Sliding::Tip) => false,
            ContactPhase::Slides(_) => !is_release,
            ContactPhase::Sticks(_) => true,
        };
    }

    /// Returns the energy that friction has dissipated so far, in `E I_base/L_w`.
    pub fn dissipated(&self) -> f64 {
        let open = self.open.as_ref();
        self.ended + open.map_or(0.0, |(_, course)| course.dissipated)
    }
}
