//! Extrema of the distance along the tip edge: between them it grows or falls throughout.

use crate::numerics::Bracket;
use crate::shooting::batch::{Batch, InitialCondition, Method};
use crate::shooting::{SecondVariation, ShootingMap};
use glam::DVec2;

/// The last Newton step toward an extremum, relative to the distance of the places around it: its square is left.
const LAST_STEP_TO_EXTREMUM: f64 = 1e-7;

/// An extremum of the distance along the tip edge, as far as its samples tell.
#[derive(Clone, Copy, Debug)]
pub struct Extremum {
    /// The sample before it.
    pub after: usize,
    /// The load.
    pub load: f64,
    /// Loads around it, of `dlnD/dload`.
    pub loads: Bracket,
    /// Second derivatives of `(ln D, phi)` by the load.
    pub by_load_load: DVec2,
}

impl Extremum {
    /// Its load and the map there. Mostly the polynomials know the second derivatives so well that one trajectory tells all; else
    /// Newton's method has its own.
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
