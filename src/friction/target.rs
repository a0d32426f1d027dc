//! Targets of Newton's method for states with friction.

use super::limit::SlidingLimit;
use super::state::FrictionPoint;
use crate::sheet::LevelCurve;
use whiskmap_mechanics::rod::Rod;

/// Target of Newton's method for one state.
#[derive(Clone, Copy, Debug)]
pub struct FrictionTarget<'a> {
    /// Level curve of the state's row, at a limit of sliding.
    pub level: &'a LevelCurve,
    /// Signed push angle, in radians.
    pub push: f64,
    /// Slid distance of a contact that sticks, in whisker lengths; `None` if it slides.
    pub slid: Option<f64>,
    /// Start of Newton's method.
    pub start: FrictionPoint,
    /// True if a contact that slides is at a stable state.
    pub is_stable: bool,
}

impl<'a> FrictionTarget<'a> {
    /// Returns the target of a contact that slides at `limit`, at `push`, a magnitude in radians; `None` beyond the end of the limit.
    pub fn sliding(limit: &'a SlidingLimit, push: f64) -> Option<Self> {
        Some(Self {
            level: &limit.level,
            push: limit.level.side.sign() * push,
            slid: None,
            start: limit.near(push)?,
            is_stable: limit.is_stable,
        })
    }

    /// Returns this target at another push, a magnitude in radians, with another start.
    pub fn at(&self, push: f64, start: FrictionPoint) -> Self {
        Self {
            push: self.level.side.sign() * push,
            start,
            ..*self
        }
    }

    /// Returns the level curve of the target with the force ratio `ratio`.
    pub fn level(&self, ratio: f64) -> LevelCurve {
        with_friction(self.level, ratio)
    }
}

/// Returns the level curve of the row of `level` with this friction.
pub fn with_friction(level: &LevelCurve, friction: f64) -> LevelCurve {
    let rod = Rod {
        friction,
        ..level.rod.clone()
    };
    LevelCurve::new(level.method, &rod, level.side, &level.row)
}
