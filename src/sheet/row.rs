//! The rows of a map: distances at first touch, and where the pole stands for each.

use crate::rod::Rest;
use glam::DVec2;

/// First touch this far beyond the tip, in whisker lengths, still counts as at it: the rounding of a distance in
/// millimetres, of its division by the length and of the rest shape stay a hundred times below.
pub const REACH_SLACK: f64 = 1e-12;

/// One distance of a map for one whisker and side; lengths in whisker lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Distance `D` of the pole's centre from the base.
    pub pole_distance: f64,
    /// Arclength of the contact at first touch; beyond 1 the rest shape is continued.
    pub contact: f64,
    /// Direction of the pole at first touch, an angle from the base's tangent.
    pub touch: f64,
}

impl Row {
    /// The row of first touch at `distance` from the base; continued beyond the tip along the rest shape.
    #[must_use]
    pub fn new(rest: &Rest, distance: f64) -> Self {
        let (contact, pole) = rest.touch_at_distance(distance);
        Self {
            pole_distance: pole.length(),
            contact,
            touch: pole.to_angle(),
        }
    }

    /// Whether the resting whisker is long enough to touch the pole: a question of its shape at rest, the same at every
    /// resolution.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        self.contact <= 1.0 + REACH_SLACK
    }

    /// Whether the very tip of the resting whisker touches the pole.
    #[must_use]
    pub fn is_at_reach(&self) -> bool {
        (self.contact - 1.0).abs() <= REACH_SLACK
    }

    /// Centre of the pole in the frame of the base after a rotation of the base by `push` since first touch.
    #[must_use]
    pub fn pole(&self, push: f64) -> DVec2 {
        self.pole_distance * DVec2::from_angle(self.touch + push)
    }
}
