//! The corrector: brings points onto their level curves by Newton's method along the gradient, a trajectory at a time.

use crate::sheet::continuation::NODE_MISS;
use crate::sheet::continuation::level_curve::LevelCurve;
use crate::shooting::batch::{Batch, InitialCondition};
use crate::shooting::{FirstVariation, FullState};
use glam::DVec2;

/// Most trajectories of a point.
const MOST: usize = 12;

/// A step, in parts of the scale and in `ln D`, after which a point that may miss the curve by [`NODE_MISS`] needs no trajectory of its
/// own: what is left goes with the square of the longer of the two. On a soft rod that is the change of `ln D`.
const LAST_STEP: f64 = 2e-5;

/// A point on its way to its level curve.
pub struct Corrector<'a> {
    level: &'a LevelCurve,
    point: DVec2,
    tolerance: f64,
    /// What `ln D` missed at the point before.
    missed: f64,
    trajectories: usize,
}

/// What comes of a trajectory.
pub enum Correction {
    /// The point is on the curve, with this state.
    Done(DVec2, FullState),
    /// It takes another one.
    Open,
    /// It gets lost.
    Lost,
}

impl<'a> Corrector<'a> {
    /// Of a `point`, which may in the end miss the curve by so much in `ln D`.
    pub const fn new(level: &'a LevelCurve, point: DVec2, tolerance: f64) -> Self {
        Self {
            level,
            point,
            tolerance,
            missed: f64::INFINITY,
            trajectories: 0,
        }
    }

    /// Goes on with the trajectory of the point.
    pub fn advance(&mut self, here: &FirstVariation) -> Correction {
        let (level, map) = (self.level, &here.full.map);
        let miss = libm::log(level.row.pole_distance / map.pole.length());
        let is_stuck =
            miss.abs() < (1e3 * self.tolerance).min(NODE_MISS) && miss.abs() > 0.5 * self.missed;
        if miss.abs() <= self.tolerance || is_stuck {
            return Correction::Done(self.point, here.full);
        }
        self.missed = miss.abs();
        self.trajectories += 1;
        let scale = level.scale(self.point);
        let gradient = scale * DVec2::new(map.by_tau.x, map.by_load.x);
        let part = gradient * (miss / gradient.length_squared());
        let step = scale * part;
        self.point += step;
        let is_short = part.length().max(miss.abs()) < LAST_STEP;
        if self.tolerance >= NODE_MISS && is_short {
            return Correction::Done(self.point, here.extrapolated(step));
        }
        let goes_on = self.point.is_finite() && self.point.x > 0.0 && self.trajectories < MOST;
        if goes_on {
            Correction::Open
        } else {
            Correction::Lost
        }
    }
}

/// The trajectories of the points of `correctors`, whose curves all have the method of the first.
pub fn shoot<'a, 'b: 'a>(
    correctors: impl IntoIterator<Item = &'a Corrector<'b>>,
) -> Vec<FirstVariation> {
    let mut correctors = correctors.into_iter().peekable();
    let Some(first) = correctors.peek() else {
        return Vec::new();
    };
    let batch = Batch::new(first.level.method);
    let conditions: Vec<InitialCondition> = correctors
        .map(|Corrector { level, point, .. }| InitialCondition {
            rod: &level.rod,
            tau: point.x,
            load: point.y,
        })
        .collect();
    batch.shoot(&conditions)
}

/// Each point on its curve, with its state; `None` where it gets lost. No answer depends on the others.
pub fn correct(mut correctors: Vec<Corrector>) -> Vec<Option<(DVec2, FullState)>> {
    let mut corrected = vec![None; correctors.len()];
    let mut open: Vec<usize> = (0..correctors.len()).collect();
    while !open.is_empty() {
        let mut shots = shoot(open.iter().map(|i| &correctors[*i])).into_iter();
        open.retain(|&i| {
            let shot = shots.next().unwrap_or_default();
            match correctors[i].advance(&shot) {
                Correction::Open => return true,
                Correction::Done(point, full) => corrected[i] = Some((point, full)),
                Correction::Lost => {}
            }
            false
        });
    }
    corrected
}
