//! Contact of a course.

use crate::friction::ContactPhase;
use whiskmap_mechanics::rod::Side;

/// Contact of the whisker at one time: side, push and, with friction, the phase of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CourseContact {
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Push since the touch, in radians, as a magnitude.
    pub push: f64,
    /// Phase of the contact; `None` without friction.
    pub phase: Option<ContactPhase>,
}
