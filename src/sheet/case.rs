//! The whisker side that a sheet is computed for.

use whiskmap_mechanics::rod::{Rod, Side};
use whiskmap_mechanics::shooting::batch::{Batch, Method, OutputSet};

/// Description of the sheet to sample: method of integration, rod, and side.
#[derive(Clone, Copy, Debug)]
pub struct SheetCase<'a> {
    /// Integration method of the sheet's trajectories.
    pub method: Method,
    /// Whisker and pole of the sheet.
    pub rod: &'a Rod,
    /// Whisker side of the sheet.
    pub side: Side,
}

impl SheetCase<'_> {
    /// Returns this case of a sheet at the coarse resolution.
    pub const fn coarsely(self) -> Self {
        let method = self.method.coarsely();
        Self { method, ..self }
    }

    /// Returns this case of a sheet at the fine resolution, or its own if that is finer.
    pub const fn finely(self) -> Self {
        let resolution = self.method.resolution.at_least_fine();
        let method = Method { resolution, ..self.method };
        Self { method, ..self }
    }

    /// Computes the outputs of trajectories at `points` `(tau, load)`, `[point]`, in padded blocks ([`Batch::padded`]).
    pub fn shoot<O: OutputSet>(
        &self,
        points: impl IntoIterator<Item = impl Into<(f64, f64)>>,
    ) -> Vec<O> {
        Batch::new(self.method).padded().shoot_at(self.rod, points)
    }
}
