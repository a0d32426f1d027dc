//! States of a contact with friction: sliding with the limiting force ratio, or sticking at a slid distance.
//!
//! A sliding state has two unknowns, contact and load, and two equations: the pole is at its place. A sticking state has the force ratio
//! as a third unknown, and its slid distance as a third equation. Newton's method solves both, with the derivatives by contact and load
//! that trajectories carry, and a difference quotient by the force ratio.

use super::history::{ContactHistory, ContactPhase, SlidingEnd};
use super::limit::SlidingLimit;
use super::sliding::{Sliding, slid};
use crate::refine::{GOAL, TOLERANCE};
use crate::rod::{Rod, arclength};
use crate::sheet::{CurveNode, LevelCurve};
use crate::shooting::batch::{Batch, InitialCondition};
use crate::shooting::{FirstVariation, FullState, limited};
use glam::{DMat3, DVec2, DVec3};

/// Contact, load and force ratio of a state with friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionPoint {
    /// Contact coordinate and signed load of the state, `(tau, load)`, dimensionless.
    pub point: DVec2,
    /// Force ratio of the state: tangential over normal force, with the sign of the side; positive on CB if it pulls the whisker toward
    /// its tip.
    pub ratio: f64,
    /// Tangent angle at the contact, in radians from the base's tangent, continuous along the push.
    pub angle: f64,
}

impl FrictionPoint {
    /// Returns the point of a node of `level`, which has the force ratio of its rod.
    pub(super) fn of(level: &LevelCurve, node: &CurveNode) -> Self {
        Self {
            point: node.point,
            ratio: level.rod.friction,
            angle: node.angle,
        }
    }

    /// Returns the point between `self` (`part` 0) and `to` (`part` 1).
    pub(super) fn lerp(&self, to: &Self, part: f64) -> Self {
        let between = |from: f64, to: f64| (to - from).mul_add(part, from);
        Self {
            point: self.point.lerp(to.point, part),
            ratio: between(self.ratio, to.ratio),
            angle: between(self.angle, to.angle),
        }
    }
}

/// State of the whisker at a contact with friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionState {
    /// Contact, load and force ratio of the state.
    pub at: FrictionPoint,
    /// Sliding direction of the contact.
    pub sliding: Sliding,
    /// Pole of the state with first derivatives, pose of the base, force and energy, in axes of the state's own force ratio.
    pub full: FullState,
    /// Slid distance of the contact, in whisker lengths.
    pub slid: f64,
    /// Distance of the pole from its target, in whisker lengths; at least the miss of the slid distance.
    pub residual: f64,
    /// Number of Newton steps that led to the state.
    pub steps: u32,
}

impl FrictionState {
    /// Returns `rod` with the force ratio of this state as its friction.
    #[must_use]
    pub fn rod(&self, rod: &Rod) -> Rod {
        Rod {
            friction: self.at.ratio,
            ..rod.clone()
        }
    }
}

/// Push angle in the history of a contact at which the state is wanted.
#[derive(Clone, Copy, Debug)]
pub struct ContactQuery<'a> {
    /// History of the contact.
    pub history: &'a ContactHistory,
    /// Push angle, a magnitude, in radians.
    pub push: f64,
    /// Phase of the contact at the push angle.
    pub phase: ContactPhase,
}

/// Target of Newton's method for one state.
#[derive(Clone, Copy, Debug)]
struct FrictionTarget<'a> {
    level: &'a LevelCurve,
    /// Signed push angle, in radians.
    push: f64,
    /// Slid distance of a contact that sticks, in whisker lengths; `None` if it slides.
    slid: Option<f64>,
    start: FrictionPoint,
}

impl<'a> FrictionTarget<'a> {
    /// Target of a contact that slides at `limit`, at `push`, a magnitude in radians; `None` beyond the end of the limit.
    fn sliding(limit: &'a SlidingLimit, push: f64) -> Option<Self> {
        Some(Self {
            level: &limit.level,
            push: limit.level.side.sign() * push,
            slid: None,
            start: limit.near(push)?,
        })
    }

    /// Level curve of the target with the force ratio `ratio`.
    fn level(&self, ratio: f64) -> LevelCurve {
        let rod = Rod {
            friction: ratio,
            ..self.level.rod.clone()
        };
        LevelCurve::new(self.level.method, &rod, self.level.side, &self.level.row)
    }
}

/// Difference of the force ratio in the difference quotients. Its square root of rounding leaves the quotients 1e-8 of themselves.
const RATIO_STEP: f64 = 1e-7;

/// Maximum number of Newton steps for each state.
const FRICTION_STEPS: u32 = 20;

/// Number of steps from the end of sliding to a sticking state that Newton's method does not reach at once.
const PATH_STEPS: u32 = 16;

/// Returns the states at `queries`, `[query]`; `None` where no stable state is found. All rows have one method.
#[must_use]
pub fn states(queries: &[ContactQuery]) -> Vec<Option<FrictionState>> {
    let ends = queries.iter().map(|query| match query.phase {
        ContactPhase::Slides(limit) => SlidingEnd {
            limit,
            push: query.push,
        },
        ContactPhase::Sticks(end) => end,
    });
    let mut found = slide(queries, ends);
    let sticking = found.iter().zip(queries).map(|(end, query)| {
        let end = (*end)?;
        let ContactPhase::Sticks(from) = query.phase else {
            return None;
        };
        stick(query, from, &end)
    });
    let sticking: Vec<Option<FrictionTarget>> = sticking.collect();
    let targets: Vec<FrictionTarget> = sticking.iter().flatten().copied().collect();
    let mut stuck = solve(&targets).into_iter();
    let mut sliding_again = Vec::new();
    for (i, target) in sticking.iter().enumerate() {
        let query = &queries[i];
        let (Some(target), ContactPhase::Sticks(from)) = (target, query.phase) else {
            continue;
        };
        let end = found[i];
        let state = stuck.next().flatten();
        found[i] = state.or_else(|| follow(target, end.as_ref()?, from.push));
        // The limits are interpolated; the force ratio decides.
        let side = target.level.side.sign();
        let ratio = found[i].map_or(0.0, |state| side * state.at.ratio);
        let largest = target.level.rod.friction.abs();
        if ratio.abs() > largest {
            let limit = if ratio > 0.0 {
                Sliding::Tip
            } else {
                Sliding::Base
            };
            sliding_again.push((i, limit));
        }
    }
    let again: Vec<ContactQuery> = sliding_again.iter().map(|(i, _)| queries[*i]).collect();
    let limits = sliding_again.iter().map(|(i, limit)| SlidingEnd {
        limit: *limit,
        push: queries[*i].push,
    });
    let slid_again = slide(&again, limits);
    for ((i, _), state) in sliding_again.into_iter().zip(slid_again) {
        found[i] = state;
    }
    found
}

/// States at the `ends` of the histories of `queries`, `[query]`.
fn slide(
    queries: &[ContactQuery],
    ends: impl Iterator<Item = SlidingEnd>,
) -> Vec<Option<FrictionState>> {
    let ends: Vec<SlidingEnd> = ends.collect();
    let targets = queries.iter().zip(&ends);
    let targets = targets
        .map(|(query, end)| FrictionTarget::sliding(query.history.limit(end.limit)?, end.push));
    let targets: Vec<Option<FrictionTarget>> = targets.collect();
    let known: Vec<FrictionTarget> = targets.iter().flatten().copied().collect();
    let mut solved = solve(&known).into_iter();
    let found = targets.iter().zip(ends).map(|(target, end)| {
        target.as_ref()?;
        let state = solved.next().flatten()?;
        Some(FrictionState {
            sliding: end.limit,
            ..state
        })
    });
    found.collect()
}

/// Target of a contact that sticks where it slid `from`, with the state `end` there.
fn stick<'a>(
    query: &ContactQuery<'a>,
    from: SlidingEnd,
    end: &FrictionState,
) -> Option<FrictionTarget<'a>> {
    let level = &query.history.limit(from.limit)?.level;
    let next = query.history.next_sliding(query.push);
    let next = next.and_then(|next| {
        let near = query.history.limit(next.limit)?.near(next.push)?;
        let part = (query.push - from.push) / (next.push - from.push);
        Some(end.at.lerp(&near, part))
    });
    Some(FrictionTarget {
        level,
        push: level.side.sign() * query.push,
        slid: Some(end.slid),
        start: next.unwrap_or(end.at),
    })
}

/// State of a sticking `target`, followed in steps from the state `end` at the push `from`, in radians.
fn follow(target: &FrictionTarget, end: &FrictionState, from: f64) -> Option<FrictionState> {
    let from = target.level.side.sign() * from;
    let mut state = *end;
    for step in 1..=PATH_STEPS {
        let part = f64::from(step) / f64::from(PATH_STEPS);
        let next = FrictionTarget {
            push: (target.push - from).mul_add(part, from),
            start: state.at,
            ..*target
        };
        state = solve(&[next]).pop()??;
    }
    Some(state)
}

/// Iterate of Newton's method.
#[derive(Clone, Copy)]
struct FrictionIterate {
    at: FrictionPoint,
    /// Residual of the previous iterate, in whisker lengths.
    before: f64,
}

/// Result of one Newton step.
enum FrictionStep {
    Next(FrictionIterate),
    Solved(FrictionState),
    Failed,
}

/// Solves for the states of `targets`, `[target]`, in batches; `None` where Newton's method fails or finds no stable state.
fn solve(targets: &[FrictionTarget]) -> Vec<Option<FrictionState>> {
    let mut solved = vec![None; targets.len()];
    let Some(first) = targets.first() else {
        return solved;
    };
    let batch = Batch::new(first.level.method);
    let start = |target: &FrictionTarget| FrictionIterate {
        at: target.start,
        before: f64::INFINITY,
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
        let conditions = levels.iter().map(|(level, point)| InitialCondition {
            rod: &level.rod,
            tau: point.x,
            load: point.y,
        });
        let shot: Vec<FirstVariation> = batch.shoot(&conditions.collect::<Vec<_>>());
        let mut shot = levels.iter().map(|(level, _)| level).zip(&shot);
        open.retain_mut(|(i, iterate)| {
            let target = &targets[*i];
            let Some(here) = shot.next() else {
                return false;
            };
            let beside = target.slid.and_then(|_| shot.next());
            match target.step(iterate, here, beside) {
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
    ) -> FrictionStep {
        let (at, rod) = (&iterate.at, &level.rod);
        let map = &here.full.map;
        let node = |level: &LevelCurve, here: &FirstVariation| {
            level.node(at.point, &here.full, self.push, at.angle)
        };
        let angles = node(level, here);
        let own_slid = slid(rod, &angles);
        let place = level.row.pole(self.push);
        let missed = self.slid.map_or(0.0, |slid| slid - own_slid);
        let residual = map.pole.distance(place).max(missed.abs());
        let jacobian = beside.map(|(other, there)| {
            let by = |variation: DVec2, radius: f64, angle: f64| {
                variation.extend(radius - rod.pole * (angle + variation.y))
            };
            let moved = map.residual(there.full.map.pole) / RATIO_STEP;
            let slid = (slid(&other.rod, &node(other, there)) - own_slid) / RATIO_STEP;
            DMat3::from_cols(
                by(map.by_tau, rod.radius(at.point.x), here.by_tau.angle),
                by(map.by_load, 0.0, here.by_load.angle),
                moved.extend(slid),
            )
        });
        let is_stuck = residual <= TOLERANCE && residual > 0.5 * iterate.before;
        if residual <= GOAL || is_stuck {
            // On stable states the determinants do not change their signs: a sliding contact meets its fold there, a sticking one buckles.
            let stability = match &jacobian {
                Some(jacobian) => -level.side.sign() * jacobian.determinant(),
                None => map.det(),
            };
            return match stability > 0.0 {
                true => FrictionStep::Solved(FrictionState {
                    at: FrictionPoint {
                        angle: angles.angle,
                        ..*at
                    },
                    sliding: Sliding::Sticks,
                    full: here.full,
                    slid: own_slid,
                    residual,
                    steps: 0,
                }),
                false => FrictionStep::Failed,
            };
        }
        let miss = map.residual(place);
        let step = match jacobian {
            Some(jacobian) => jacobian.inverse() * miss.extend(missed),
            None => map.solve(miss).extend(0.0),
        };
        let s = arclength(rod, at.point.x);
        let (_, length) = limited(step.truncate(), s, at.point.y);
        let length = length.max(step.z.abs() / self.level.rod.friction.abs());
        let step: DVec3 = step * (crate::shooting::LONGEST_STEP / length).min(1.0);
        let next = FrictionPoint {
            point: at.point + step.truncate(),
            ratio: at.ratio + step.z,
            angle: angles.angle,
        };
        match next.point.is_finite() && next.ratio.is_finite() && next.point.x > 0.0 {
            true => FrictionStep::Next(FrictionIterate {
                at: next,
                before: residual,
            }),
            false => FrictionStep::Failed,
        }
    }
}
