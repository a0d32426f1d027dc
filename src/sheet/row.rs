//! A row of a map: a distance at first touch, where the pole stands for it, and where the row leaves the stable sheet.

use crate::rod::{Rest, Rod};
use crate::shooting::ShootingMap;
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
    /// Arclength at the tip: 1, but for a perfect cone.
    pub end: f64,
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
            end: rest.end(),
        }
    }

    /// Whether the resting whisker is long enough to touch the pole: a question of its shape at rest, the same at every
    /// resolution.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        self.contact <= self.end + REACH_SLACK
    }

    /// Whether the very tip of the resting whisker touches the pole.
    #[must_use]
    pub fn is_at_reach(&self) -> bool {
        (self.contact - self.end).abs() <= REACH_SLACK
    }

    /// `(tau, load)` of `rod` at first touch: the load is 0.
    #[must_use]
    pub fn first_touch(&self, rod: &Rod) -> DVec2 {
        DVec2::new(rod.tau(self.contact).min(rod.tau_tip()), 0.0)
    }

    /// Centre of the pole in the frame of the base after a rotation of the base by `push` since first touch.
    #[must_use]
    pub fn pole(&self, push: f64) -> DVec2 {
        self.pole_distance * DVec2::from_angle(self.touch + push)
    }
}

/// An edge over which a row leaves the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The saddle-node: the whisker slips off.
    Fold,
    /// The contact reaches the tip: the whisker is pulled off.
    Tip,
}

impl Edge {
    /// How fast the push angle changes with `ln D` along the edge, in radians, at a point of it where the pole is as `map` says. At the
    /// fold both change in proportion, in whatever direction.
    #[must_use]
    pub fn slope(self, map: &ShootingMap) -> f64 {
        let change = match self {
            Self::Fold => map.by_tau,
            Self::Tip => map.by_load,
        };
        change.y / change.x
    }
}

/// A row's crossing of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Which edge.
    pub edge: Edge,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// Push angle since first touch, in radians, as a magnitude on the row's side.
    pub push: f64,
    /// Remaining error, relative: the distance in `ln D`, and the square of how far the point still is (the push angle is flat
    /// at a fold).
    pub residual: f64,
    /// See [`Edge::slope`].
    pub slope: f64,
}

/// Where the push angle changes this fast with `ln D`, an error of 1e-11 in that makes more than 1e-8 degrees: such ends take twice the
/// steps.
pub const STEEP: f64 = 20.0;

/// The largest error, relative to the distance of the pole, of a crossing that is taken for one.
const SOUND: f64 = 1e-10;

impl Crossing {
    /// Whether it was found: a crossing that was not is only near the level curve.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.residual <= SOUND
    }

    /// Whether the push angle changes so fast along the edge that it takes more steps to know it.
    #[must_use]
    pub fn is_steep(&self) -> bool {
        self.slope.abs() > STEEP
    }

    /// Of a row that meets the tip edge at first touch: without a load, whatever the resolution.
    #[must_use]
    pub fn at_touch(rod: &Rod) -> Self {
        Self {
            edge: Edge::Tip,
            tau: rod.tau_tip(),
            load: 0.0,
            push: 0.0,
            residual: 0.0,
            slope: 0.0,
        }
    }

    /// Whether it is one of those.
    #[must_use]
    pub fn is_at_touch(&self) -> bool {
        self.load == 0.0
    }

    /// In place of the crossings of a row that could not be found, after those that were.
    #[must_use]
    pub fn unknown() -> Self {
        Self {
            edge: Edge::Tip,
            tau: f64::NAN,
            load: f64::NAN,
            push: f64::NAN,
            residual: f64::INFINITY,
            slope: f64::NAN,
        }
    }

    /// Whether it stands for those.
    #[must_use]
    pub fn is_unknown(&self) -> bool {
        self.tau.is_nan()
    }
}
