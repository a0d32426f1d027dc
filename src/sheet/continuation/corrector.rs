//! The corrector: moves points onto their level curves by Newton's method along the gradient.

use crate::newton::{BatchNewton, NewtonOutcome, NewtonProblem, NewtonStep};
use crate::sheet::continuation::NODE_MISS;
use crate::sheet::continuation::level_curve::LevelCurve;
use glam::DVec2;
use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::{FirstVariation, FullState};

/// Maximum number of the corrector's trajectories for each point.
pub const CORRECTOR_TRAJECTORIES: u32 = 12;

/// Step length, in parts of the scale and in `ln D`, whose end is extrapolated if the point may miss the curve by [`NODE_MISS`]. The
/// remaining error is the square of the longer of the two. On a soft rod that is the change of `ln D`.
const LAST_CORRECTOR_STEP: f64 = 2e-5;

/// Newton problem of a point that approaches its level curve.
pub struct Corrector<'a> {
    level: &'a LevelCurve,
    /// Largest accepted miss in `ln D`.
    tolerance: f64,
    /// Miss in `ln D` at the previous iterate.
    missed: f64,
}

impl<'a> Corrector<'a> {
    /// Creates a corrector that stops when a point misses the curve by at most `tolerance` in `ln D`, or by rounding.
    pub const fn new(level: &'a LevelCurve, tolerance: f64) -> Self {
        Self { level, tolerance, missed: f64::INFINITY }
    }
}

impl<'a> NewtonProblem<'a> for Corrector<'a> {
    type Output = FirstVariation;

    fn rod(&self) -> &'a Rod {
        &self.level.rod
    }

    fn step(&mut self, at: DVec2, here: &FirstVariation) -> NewtonStep {
        let (level, map) = (self.level, &here.full.map);
        let miss = libm::log(level.row.pole_distance / map.pole.length());
        let is_stuck =
            miss.abs() < (1e3 * self.tolerance).min(NODE_MISS) && miss.abs() > 0.5 * self.missed;
        if miss.abs() <= self.tolerance || is_stuck {
            return NewtonStep::Accept;
        }
        self.missed = miss.abs();
        let scale = level.scale(at);
        let gradient = scale * DVec2::new(map.by_tau.x, map.by_load.x);
        let part = gradient * (miss / gradient.length_squared());
        let step = scale * part;
        let is_short = part.length().max(miss.abs()) < LAST_CORRECTOR_STEP;
        if self.tolerance >= NODE_MISS && is_short {
            NewtonStep::Extrapolate(step)
        } else {
            NewtonStep::Shoot(at + step)
        }
    }
}

/// Moves each point `(tau, load)` onto its level curve, to its tolerance in `ln D`. Returns `(tau, load)` and the state of each point,
/// `[point]`, or `None` where the corrector fails. The method of the first curve applies to all of them. Results do not depend on the
/// other points.
pub fn correct(points: &[(&LevelCurve, DVec2, f64)]) -> Vec<Option<(DVec2, FullState)>> {
    let Some((first, ..)) = points.first() else {
        return Vec::new();
    };
    let mut correctors: Vec<Corrector> =
        points.iter().map(|(level, _, tolerance)| Corrector::new(level, *tolerance)).collect();
    let newton = BatchNewton::new(first.method, CORRECTOR_TRAJECTORIES);
    let iterates = newton.solve(&mut correctors, points.iter().map(|(_, point, _)| *point));
    let corrected = iterates.into_iter().map(|iterate| {
        let has_converged = iterate.outcome == NewtonOutcome::Converged;
        has_converged.then_some((iterate.point, iterate.state))
    });
    corrected.collect()
}
