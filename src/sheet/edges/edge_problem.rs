//! Edge problems: the equations for one point of an edge, and their Newton steps.

use crate::rod::{Rod, arclength};
use crate::sheet::edges::predictor::SecondDerivatives;
use crate::sheet::row::Edge;
use crate::shooting::{SecondVariation, limited};
use glam::DVec2;

/// Newton problem for one point of an edge.
#[derive(Clone, Copy, Debug)]
pub struct EdgeProblem<'a> {
    /// Whisker and pole.
    pub rod: &'a Rod,
    /// Edge on which the point lies.
    pub edge: Edge,
    /// Distance `D` of the pole's centre from the base, in whisker lengths.
    pub pole_distance: f64,
    /// Start of Newton's method, `(tau, load)`.
    pub start: DVec2,
    /// Second derivatives at `start`, if the start is a good prediction.
    pub second: Option<SecondDerivatives>,
}

impl EdgeProblem<'_> {
    /// Returns the miss in `ln D` at the state `here`.
    pub fn miss(&self, here: &SecondVariation) -> f64 {
        libm::log(self.pole_distance / here.map.pole.length())
    }

    /// Returns the next step in `(tau, load)` from `at`, where the state is `here`, and its length.
    pub fn step(&self, at: DVec2, here: &SecondVariation) -> (DVec2, f64) {
        let miss = self.miss(here);
        let step = match self.edge {
            Edge::Fold => fold_step(here, miss),
            Edge::Tip => DVec2::new(0.0, load_step(here, miss)),
        };
        limited(step, arclength(self.rod, at.x), at.y)
    }
}

/// Returns the step in load toward the point at the same contact whose `ln D` is larger by `miss`, to second order. Where the distance
/// has its maximum, as for a straight whisker at first touch, a first-order step would go half as far.
fn load_step(here: &SecondVariation, miss: f64) -> f64 {
    let (slope, second) = (here.map.by_load.x, here.by_load_load.x);
    let slope_there = (slope * slope + 2.0 * second * miss).max(0.0).sqrt();
    2.0 * miss / (slope + slope_there.copysign(slope))
}

/// Returns the step in `(tau, load)` toward the point of the fold whose `ln D` is larger by `miss`.
fn fold_step(here: &SecondVariation, miss: f64) -> DVec2 {
    let by_distance = DVec2::new(here.map.by_tau.x, here.map.by_load.x);
    let by_det = here.det_gradient();
    let det = here.map.det();
    DVec2::new(
        miss * by_det.y + det * by_distance.y,
        -miss * by_det.x - det * by_distance.x,
    ) / by_distance.perp_dot(by_det)
}
