//! Friction of the contact along a push: limits of sliding, their history, and the states that follow from it.
//!
//! The force ratio is the tangential over the normal force at the contact, with the sign of the side. A contact that slides toward the tip
//! has the force ratio `mu`, one that slides toward the base `-mu` (Coulomb). A contact that sticks has a force ratio between them, which
//! follows from its slid distance. [`ContactHistory`] says which of the three holds at a push angle, [`FrictionCourse`] along
//! pushes that go to and fro. [`states()`] solves for the states.

mod at_end;
mod course;
mod dissipation;
mod division;
mod history;
mod limit;
mod newton;
mod segment;
mod sliding;
mod state;
mod states;
mod stuck;

pub use at_end::surely_slides_to_end;
pub use course::{CourseLimits, FrictionCourse, Snap};
pub use history::{ContactHistory, ContactPhase, ContactQuery, SlidingEnd};
pub use sliding::Sliding;
pub use state::{FrictionPoint, FrictionState};
pub use states::{held, states};
