//! States of a contact with friction: sliding with the limiting force ratio, or sticking at a slid distance.

use super::history::{ContactHistory, ContactPhase};
use super::limit::SlidingLimit;
use super::newton::{FrictionTarget, solve};
use super::sliding::Sliding;
use super::stuck::{StuckPath, StuckRun};
use crate::rod::Rod;
use crate::sheet::{CurveNode, LevelCurve};
use crate::shooting::FullState;
use glam::DVec2;

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

/// Returns the states at `queries`, `[query]`; `None` where no stable state is found. All rows have one method.
#[must_use]
pub fn states(queries: &[ContactQuery]) -> Vec<Option<FrictionState>> {
    let mut found = held(queries);
    // The limits are interpolated; the force ratio decides whether a contact next to a limit still sticks.
    let slides_again = queries.iter().zip(&found).enumerate();
    let slides_again = slides_again.filter_map(|(i, (query, state))| {
        let ContactPhase::Sticks(_) = query.phase else {
            return None;
        };
        let level = &query.history.limit(Sliding::Tip)?.level;
        let ratio = state.as_ref()?.at.ratio * level.side.sign();
        let limit = if ratio > 0.0 {
            Sliding::Tip
        } else {
            Sliding::Base
        };
        let phase = ContactPhase::Slides(limit);
        (ratio.abs() > level.rod.friction.abs()).then_some((i, ContactQuery { phase, ..*query }))
    });
    let (places, again): (Vec<usize>, Vec<ContactQuery>) = slides_again.unzip();
    for (i, state) in places.into_iter().zip(held(&again)) {
        found[i] = state;
    }
    found
}

/// Returns the states at `queries` in the phases that they give, `[query]`; `None` where no stable state is found. The force ratio of a
/// contact that sticks may be larger than the friction.
pub fn held(queries: &[ContactQuery]) -> Vec<Option<FrictionState>> {
    let runs = StuckRun::of(queries);
    let slides = queries.iter().map(|query| match query.phase {
        ContactPhase::Slides(limit) => query.history.target(limit, query.push),
        ContactPhase::Sticks(_) => None,
    });
    let ends = runs.iter();
    let ends = ends.map(|run| run.history.target(run.end.limit, run.end.push));
    let targets: Vec<Option<FrictionTarget>> = slides.chain(ends).collect();
    let mut found = solve_known(&targets);
    let ends = found.split_off(queries.len());
    for (state, query) in found.iter_mut().zip(queries) {
        if let (Some(state), ContactPhase::Slides(limit)) = (state, query.phase) {
            state.sliding = limit;
        }
    }
    let paths = StuckPath::of(&runs, &ends);
    let mut targets = vec![None; queries.len()];
    for (run, path) in runs.iter().zip(&paths) {
        for i in run.queries.clone() {
            targets[i] = path.as_ref().and_then(|path| path.target(queries[i].push));
        }
    }
    for (own, state) in found.iter_mut().zip(solve_known(&targets)) {
        *own = own.or(state);
    }
    found
}

/// Returns states near those of `limit` at `pushes`, magnitudes in radians, solved, `[push]`; `None` where none is found.
pub(super) fn at_limit(limit: &SlidingLimit, pushes: &[f64]) -> Vec<Option<FrictionPoint>> {
    let targets = pushes
        .iter()
        .map(|push| FrictionTarget::sliding(limit, *push));
    let found = solve_known(&targets.collect::<Vec<_>>()).into_iter();
    found.map(|state| Some(state?.at)).collect()
}

impl ContactHistory {
    /// Target of a contact that slides in a `direction` at `push`, a magnitude in radians; `None` beyond the end of its limit.
    fn target(&self, direction: Sliding, push: f64) -> Option<FrictionTarget<'_>> {
        FrictionTarget::sliding(self.limit(direction)?, push)
    }
}

/// States of those of `targets` that are known, `[target]`.
fn solve_known(targets: &[Option<FrictionTarget>]) -> Vec<Option<FrictionState>> {
    let known: Vec<FrictionTarget> = targets.iter().flatten().copied().collect();
    let mut solved = solve(&known).into_iter();
    let states = targets.iter();
    states
        .map(|target| target.and_then(|_| solved.next().flatten()))
        .collect()
}
