//! Sides by name.

use clap::ValueEnum;
use whiskmap::rod::Side;

/// The side of the whisker that the pole is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OneSide {
    /// Concave backward: the pole is on the convex side
    Cb,
    /// Concave forward: the pole is on the concave side
    Cf,
}

impl From<OneSide> for Side {
    fn from(side: OneSide) -> Self {
        match side {
            OneSide::Cb => Self::Cb,
            OneSide::Cf => Self::Cf,
        }
    }
}
