//! The corrector: brings points onto their level curves by Newton's method along the gradient, a trajectory at a time.

use crate::newton::{BatchNewton, NewtonOutcome, NewtonStep, Problem};
use crate::rod::Rod;
use crate::sheet::continuation::NODE_MISS;
use crate::sheet::continuation::level_curve::LevelCurve;
use crate::shooting::{FirstVariation, FullState};
use glam::DVec2;

/// Most trajectories of a point.
pub const CORRECTOR_TRAJECTORIES: u32 = 12;

/// A step, in parts of the scale and in `ln D`, after which a point that may miss the curve by [`NODE_MISS`] needs no trajectory of its
/// own. The rest is the square of the longer of the two. On a soft rod that is the change of `ln D`.
const LAST_CORRECTOR_STEP: f64 = 2e-5;

/// A point that approaches its level curve.
pub struct Corrector<'a> {
    level: &'a LevelCurve,
    /// What `ln D` may miss.
    tolerance: f64,
    /// What `ln D` missed at the point before.
    missed: f64,
}

impl<'a> Corrector<'a> {
    /// Corrects a point until it misses the curve by at most `tolerance` in `ln D`, or by rounding.
    pub const fn new(level: &'a LevelCurve, tolerance: f64) -> Self {
        Self {
            level,
            tolerance,
            missed: f64::INFINITY,
        }
    }
}

impl<'a> Problem<'a> for Corrector<'a> {
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

/// Brings every point of a level curve onto it, to its tolerance; returns the point and its state, `None` where that fails. All curves
/// have the method of the first. No result depends on the other points.
pub fn correct(points: &[(&LevelCurve, DVec2, f64)]) -> Vec<Option<(DVec2, FullState)>> {
    let Some((first, ..)) = points.first() else {
        return Vec::new();
    };
    let correctors = points.iter();
    let correctors = correctors.map(|(level, _, tolerance)| Corrector::new(level, *tolerance));
    let mut correctors: Vec<Corrector> = correctors.collect();
    let newton = BatchNewton::new(first.method, CORRECTOR_TRAJECTORIES);
    let iterates = newton.solve(&mut correctors, points.iter().map(|(_, point, _)| *point));
    let corrected = iterates.into_iter().map(|iterate| {
        let has_converged = iterate.outcome == NewtonOutcome::Converged;
        has_converged.then_some((iterate.point, iterate.state))
    });
    corrected.collect()
}
