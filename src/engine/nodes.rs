//! Nodes: the trajectories of the nets of several whisker sides, as a request to an engine.

use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::batch::{InitialCondition, Method};

/// Trajectories of the nets of several whisker sides.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// Integration method of the trajectories.
    pub method: Method,
    /// Rods of the trajectories: `[rod]`.
    pub rods: Vec<Rod>,
    /// Contact and signed load of each trajectory, `(tau, load)`: `[rod][trajectory]`.
    pub points: Vec<Vec<(f64, f64)>>,
}

impl Nodes {
    /// Returns the number of trajectories.
    #[must_use]
    pub fn count(&self) -> usize {
        self.points.iter().map(Vec::len).sum()
    }

    /// Returns the initial conditions of all trajectories, rod by rod.
    #[must_use]
    pub fn conditions(&self) -> Vec<InitialCondition<'_>> {
        let rods = self.rods.iter().zip(&self.points);
        let all = rods.flat_map(|(rod, points)| {
            let points = points.iter();
            points.map(move |point| InitialCondition::new(rod, *point))
        });
        all.collect()
    }
}
