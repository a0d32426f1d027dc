//! Newton's method for states with friction, in batches.
//!
//! A sliding state has two unknowns, contact and load, and two equations: the pole is at its place. A sticking state has the force ratio
//! as a third unknown, and its slid distance as a third equation, so that the rod of an iterate changes with its force ratio.
//!
//! Trajectories carry the derivatives by contact and load. The derivative by the force ratio is a difference quotient, which slows
//! convergence, and leaves no error. Its second trajectory is one more lane of a block. The exact derivative
//! ([`differentiate`](whiskmap_mechanics::shooting::differentiate)) needs blocks of its own: maps and courses take 1.7 to 2.6 times as long.

use super::limit::SlidingLimit;
use super::sliding::{Sliding, slid};
use super::state::{FrictionPoint, FrictionState};
use crate::refine::TOLERANCE;
use crate::sheet::LevelCurve;
use glam::{DMat3, DVec2, DVec3};
use whiskmap_mechanics::rod::arclength;
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition};
use whiskmap_mechanics::shooting::{FirstVariation, LONGEST_STEP, limited};

/// Relative difference of `tau` from the tip's within which a contact counts as on the whisker.
const TIP_SLACK: f64 = 1e-9;

/// Difference of the force ratio in the difference quotients. Because of their error, a step leaves at least this part of the miss. The slid distance can
/// change by 1e-6 for a ratio of 1, so that a smaller difference would be lost in rounding.
const RATIO_STEP: f64 = 1e-4;

/// Last Newton step of the force ratio of a contact that sticks. Forces change by less than it, relative to their size.
const LAST_RATIO_STEP: f64 = 1e-9;

/// Error of the slid distance of a contact that sticks, in whisker lengths, up to which steps of the force ratio that no longer shrink are due to
/// rounding.
const AT_SLID: f64 = 1e-13;

/// Distance of the pole from its target, in whisker lengths, at which a state is accepted without another step. It is the size of
/// rounding errors, because the force ratio of a contact that sticks there multiplies an error of the slid distance by 1e6 and more.
const AT_POLE: f64 = 1e-16;

/// Largest distance of the pole from its target at which the force ratio changes, in whisker lengths.
const NEAR_POLE: f64 = 1e-9;

/// Smallest determinant of a regular shooting map, relative to the lengths of its columns.
const REGULAR: f64 = 0.3;

/// Maximum number of Newton steps for each state.
const FRICTION_STEPS: u32 = 40;

/// Target of Newton's method for one state.
#[derive(Clone, Copy, Debug)]
pub struct FrictionTarget<'a> {
    /// Level curve of the state's row, at a limit of sliding.
    pub level: &'a LevelCurve,
    /// Push angle with its sign, in radians.
    pub signed_push: f64,
    /// Slid distance of a contact that sticks, in whisker lengths; `None` if it slides.
    pub slid: Option<f64>,
    /// Start of Newton's method.
    pub start: FrictionPoint,
    /// True if a contact that slides is at a stable state.
    pub is_stable: bool,
}

impl<'a> FrictionTarget<'a> {
    /// Returns the target of a contact that slides at `limit`, at `push`, a magnitude in radians; `None` beyond the end of the limit.
    pub fn sliding(limit: &'a SlidingLimit, push: f64) -> Option<Self> {
        Some(Self {
            level: &limit.level,
            signed_push: limit.level.side.sign() * push,
            slid: None,
            start: limit.near(push)?,
            is_stable: limit.is_stable,
        })
    }

    /// Returns this target at another push, a magnitude in radians, with another start.
    pub fn at(&self, push: f64, start: FrictionPoint) -> Self {
        Self { signed_push: self.level.side.sign() * push, start, ..*self }
    }

    /// Returns the level curve of the target with the force ratio `ratio`.
    pub fn level(&self, ratio: f64) -> LevelCurve {
        with_friction(self.level, ratio)
    }
}

/// Returns the level curve of the row of `level` with this friction.
pub fn with_friction(level: &LevelCurve, friction: f64) -> LevelCurve {
    let rod = level.rod.with_friction(friction);
    LevelCurve::new(level.method, &rod, level.side, &level.row)
}

/// Iterate of Newton's method.
#[derive(Clone, Copy)]
struct FrictionIterate {
    at: FrictionPoint,
    /// Residual of the previous iterate, in whisker lengths.
    before: f64,
    /// Size of the step of the force ratio to this iterate.
    ratio_step: f64,
}

/// Result of one Newton step.
enum FrictionStep {
    Next(FrictionIterate),
    Solved(FrictionState),
    Failed,
}

/// Order in which the iterates of a contact that sticks approach their state.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Approach {
    /// The iterates return to the pole at a fixed force ratio, if the shooting map is regular, before the force ratio changes. Near a reversal
    /// of a limit, the pole's distance hardly changes with load and force ratio at a fixed contact, so that Newton's method needs it.
    PoleFirst,
    /// All three equations are solved at once, as the states near the fold of a limit need.
    AtOnce,
}

/// Solves for the states of `targets`, `[target]`, in batches; `None` where Newton's method fails or finds no stable state.
pub fn solve(targets: &[FrictionTarget]) -> Vec<Option<FrictionState>> {
    let mut solved = approach(targets, Approach::PoleFirst);
    let failed = targets.iter().zip(&solved).enumerate();
    let failed = failed.filter(|(_, (target, state))| target.slid.is_some() && state.is_none());
    let (places, again): (Vec<usize>, Vec<FrictionTarget>) =
        failed.map(|(i, (target, _))| (i, *target)).unzip();
    for (i, state) in places.into_iter().zip(approach(&again, Approach::AtOnce)) {
        solved[i] = state;
    }
    solved
}

/// States of `targets`, `[target]`, by one order.
fn approach(targets: &[FrictionTarget], order: Approach) -> Vec<Option<FrictionState>> {
    let mut solved = vec![None; targets.len()];
    let Some(first) = targets.first() else {
        return solved;
    };
    let batch = Batch::new(first.level.method);
    let start = |target: &FrictionTarget| FrictionIterate {
        at: target.start,
        before: f64::INFINITY,
        ratio_step: f64::INFINITY,
    };
    let starts = targets.iter().map(start).enumerate();
    let mut open: Vec<(usize, FrictionIterate)> = starts.collect();
    for steps in 0..=FRICTION_STEPS {
        let levels = open.iter().flat_map(|(i, iterate)| {
            let target = &targets[*i];
            let ratio = iterate.at.ratio;
            let beside = target.slid.map(|_| target.level(ratio + RATIO_STEP));
            [Some(target.level(ratio)), beside].map(|level| Some((level?, iterate.at.point)))
        });
        let levels: Vec<(LevelCurve, DVec2)> = levels.flatten().collect();
        let conditions =
            levels.iter().map(|(level, point)| InitialCondition::new(&level.rod, *point));
        let shot: Vec<FirstVariation> = batch.shoot(&conditions.collect::<Vec<_>>());
        let mut shot = levels.iter().map(|(level, _)| level).zip(&shot);
        open.retain_mut(|(i, iterate)| {
            let target = &targets[*i];
            let Some(here) = shot.next() else {
                return false;
            };
            let beside = target.slid.and_then(|_| shot.next());
            match target.step(iterate, here, beside, order) {
                FrictionStep::Next(next) => {
                    *iterate = next;
                    true
                }
                FrictionStep::Solved(state) => {
                    solved[*i] = Some(FrictionState { steps, ..state });
                    false
                }
                FrictionStep::Failed => false,
            }
        });
        if open.is_empty() {
            break;
        }
    }
    solved
}

impl FrictionTarget<'_> {
    /// Newton step from `iterate`, with the trajectories there and, if the contact sticks, at a force ratio beside it.
    fn step(
        &self,
        iterate: &FrictionIterate,
        (level, here): (&LevelCurve, &FirstVariation),
        beside: Option<(&LevelCurve, &FirstVariation)>,
        order: Approach,
    ) -> FrictionStep {
        let (at, rod) = (&iterate.at, &level.rod);
        let map = &here.full.map;
        let node = |level: &LevelCurve, here: &FirstVariation| {
            level.node(at.point, &here.full, self.signed_push, at.angle)
        };
        let angles = node(level, here);
        let iterate_slid = slid(rod, &angles);
        let place = level.row.pole(self.signed_push);
        let missed = self.slid.map_or(0.0, |slid| slid - iterate_slid);
        let residual = map.pole.distance(place);
        let jacobian = beside.map(|(other, there)| {
            let by = |variation: DVec2, radius: f64, angle: f64| {
                variation.extend(radius - rod.pole * (angle + variation.y))
            };
            let moved = map.residual(there.full.map.pole) / RATIO_STEP;
            let slid = (slid(&other.rod, &node(other, there)) - iterate_slid) / RATIO_STEP;
            DMat3::from_cols(
                by(map.by_tau, rod.radius(at.point.x), here.by_tau.angle),
                by(map.by_load, 0.0, here.by_load.angle),
                moved.extend(slid),
            )
        });
        let miss = map.residual(place);
        let columns = map.by_tau.length() * map.by_load.length();
        let is_at_pole =
            order == Approach::AtOnce || residual <= NEAR_POLE || map.det() < REGULAR * columns;
        let step = match &jacobian {
            Some(jacobian) if is_at_pole => jacobian.inverse() * miss.extend(missed),
            _ => map.solve(miss).extend(0.0),
        };
        let ratio_step = step.z.abs();
        let is_rounding = missed.abs() <= AT_SLID && ratio_step > 0.5 * iterate.ratio_step;
        let is_precise = is_at_pole && (ratio_step <= LAST_RATIO_STEP || is_rounding);
        let is_stuck = residual <= TOLERANCE && residual > 0.5 * iterate.before;
        if (residual <= AT_POLE || is_stuck) && (jacobian.is_none() || is_precise) {
            return self.accept(iterate, (level, here), jacobian, residual);
        }
        let s = arclength(rod, at.point.x);
        let (_, length) = limited(step.truncate(), s, at.point.y);
        let length = length.max(step.z.abs() / self.level.rod.friction.abs());
        let step: DVec3 = step * (LONGEST_STEP / length).min(1.0);
        let next = FrictionPoint {
            point: at.point + step.truncate(),
            ratio: at.ratio + step.z,
            angle: angles.angle,
        };
        match next.point.is_finite() && next.ratio.is_finite() && next.point.x > 0.0 {
            true => FrictionStep::Next(FrictionIterate {
                at: next,
                before: residual,
                ratio_step: match is_at_pole {
                    true => ratio_step,
                    false => iterate.ratio_step,
                },
            }),
            false => FrictionStep::Failed,
        }
    }

    /// State of a converged iterate with the trajectory `here`, if it is as stable as the states of its limit. There the determinants do not
    /// change their signs: a sliding contact meets its fold, and a sticking one buckles.
    fn accept(
        &self,
        iterate: &FrictionIterate,
        (level, here): (&LevelCurve, &FirstVariation),
        jacobian: Option<DMat3>,
        residual: f64,
    ) -> FrictionStep {
        let node = level.node(iterate.at.point, &here.full, self.signed_push, iterate.at.angle);
        let is_sound = match jacobian {
            Some(jacobian) => -level.side.sign() * jacobian.determinant() > 0.0,
            None => (here.full.map.det() > 0.0) == self.is_stable,
        };
        let is_on_whisker = node.point.x <= level.rod.tau_tip() * (1.0 + TIP_SLACK);
        if !is_sound || !is_on_whisker {
            return FrictionStep::Failed;
        }
        FrictionStep::Solved(FrictionState {
            at: FrictionPoint::of(level, &node),
            sliding: Sliding::Sticks,
            variation: *here,
            slid: slid(&level.rod, &node),
            residual,
            steps: 0,
        })
    }
}
