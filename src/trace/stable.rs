//! Stable part of a branch, where nothing is needed of the unstable states.

use super::{Branch, NoState, StateAtPush, WhiskerShape};
use crate::scene::{Pole, Whisker};
use crate::sheet::Stretch;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Reading;

/// Stable part of a [`Branch`]: the states from first touch to the fold or the tip. The continuation ends there, which saves most of the
/// time.
#[derive(Clone, Debug)]
pub struct StableBranch(pub(super) Branch);

impl StableBranch {
    /// Computes the stable states of `whisker` at `pole`, whose first touch is at `distance_mm` from the base.
    ///
    /// # Errors
    /// The whisker at rest does not reach the pole, the states do not end within nine turns of the base, or the continuation fails.
    pub fn new(
        whisker: &Whisker,
        pole: &Pole,
        side: Side,
        distance_mm: f64,
    ) -> Result<Self, NoState> {
        Branch::followed((whisker, pole, side), distance_mm, Stretch::Stable).map(Self)
    }

    /// Returns the stable state at the signed `push`, in radians.
    ///
    /// # Errors
    /// No such state exists. The error names how the whisker leaves the pole, and at which push angle.
    pub fn state(&self, push: f64) -> Result<StateAtPush, NoState> {
        self.0.state(push, true)
    }

    /// Returns the shape in the state `found`, at `count` points evenly spaced along the whisker and at the contact.
    #[must_use]
    pub fn shape(&self, found: &StateAtPush, count: usize) -> WhiskerShape {
        WhiskerShape::new(&self.0, found, count)
    }

    /// Returns the values of `state` in mm, deg, uN and nN m.
    #[must_use]
    pub fn read(&self, state: &StateAtPush) -> Reading {
        self.0.read(state)
    }

    /// Returns the signed push angle at which the stable states end, at the fold or at the tip, in degrees.
    #[must_use]
    pub fn end_deg(&self) -> f64 {
        self.0.stable_end_deg()
    }
}
