//! Extrema of the distance along the tip edge; between them the distance grows or falls throughout.

use crate::numerics::Bracket;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{SecondVariation, ShootingMap};
use glam::DVec2;

/// Newton step toward an extremum, relative to the width of its bracket, after which the iteration stops. The remaining error is its
/// square.
const LAST_STEP_TO_EXTREMUM: f64 = 1e-7;

/// DistanceExtremum of the distance along the tip edge, as its samples predict it.
#[derive(Clone, Copy, Debug)]
pub struct DistanceExtremum {
    /// Index of the sample before the extremum.
    pub after: usize,
    /// Predicted signed load `f/rho^2`.
    pub load: f64,
    /// Loads that bracket the root of `dlnD/dload`.
    pub loads: Bracket,
    /// Second derivatives of `(ln D, phi)` by the load.
    pub by_load_load: DVec2,
}

impl DistanceExtremum {
    /// Returns the load of the extremum and the map there. The polynomials usually determine the second derivatives so well that one
    /// trajectory suffices; otherwise Newton's method computes its own.
    pub fn polished(&self, method: Method, at_tip: InitialCondition) -> (f64, ShootingMap) {
        let (load, by_load_load) = (self.load, self.by_load_load);
        let condition = |load| [InitialCondition { load, ..at_tip }];
        let last_step = LAST_STEP_TO_EXTREMUM * (self.loads.above - self.loads.below).abs();
        let map = Batch::new(method).shoot::<ShootingMap>(&condition(load))[0];
        let step = -map.by_load.x / by_load_load.x;
        if step.abs() <= last_step {
            let here = SecondVariation {
                map,
                by_load_load,
                ..SecondVariation::default()
            };
            return (load + step, here.extrapolated(DVec2::new(0.0, step)).map);
        }
        let newton = |load| {
            let here = Batch::new(method).shoot::<SecondVariation>(&condition(load))[0];
            let slope = here.map.by_load.x;
            (slope, load - slope / here.by_load_load.x)
        };
        let load = self.loads.newton(load, |_| last_step, newton).x;
        (
            load,
            Batch::new(method).shoot::<ShootingMap>(&condition(load))[0],
        )
    }
}
