//! States of a contact with friction: sliding with the limiting force ratio, or sticking at a slid distance.

use super::history::{CLEAR_OF_CONTACT, ContactHistory, ContactPhase, ContactQuery, SlidingEnd};
use super::limit::SlidingLimit;
use super::newton::{FrictionTarget, solve};
use super::sliding::Sliding;
use super::state::FrictionState;
use super::stuck::{StuckPath, StuckRun};

/// Rounding error of slid distances, in whisker lengths.
const SLID_ROUNDING: f64 = 1e-14;

/// Returns the states at `queries`, `[query]`; `None` where no stable state is found. All rows have one method.
#[must_use]
pub fn states(queries: &[ContactQuery]) -> Vec<Option<FrictionState>> {
    let mut found = held(queries);
    // The limits are interpolated; the force ratio decides whether a contact next to a limit still sticks.
    let pairs = queries.iter().zip(&found).enumerate();
    let doubtful: Vec<(usize, SlidingEnd)> = pairs
        .filter_map(|(i, (query, state))| {
            let ContactPhase::Sticks(end) = query.phase else {
                return None;
            };
            let friction = query.history.limit(Sliding::Tip)?.level.rod.friction;
            let holds = state.is_some_and(|state| state.at.ratio.abs() <= friction.abs());
            (!holds).then_some((i, end))
        })
        .collect();
    let again = doubtful.iter().flat_map(|(i, end)| {
        let query = queries[*i];
        let slides = [Sliding::Tip, Sliding::Base]
            .map(|limit| ContactQuery { phase: ContactPhase::Slides(limit), ..query });
        let end = ContactQuery { phase: ContactPhase::Slides(end.limit), push: end.push, ..query };
        [slides[0], slides[1], end]
    });
    let again = held(&again.collect::<Vec<_>>());
    for ((i, _), states) in doubtful.iter().zip(again.chunks_exact(3)) {
        let slid = states[2].map_or(f64::NAN, |end| end.slid);
        // Without a force ratio, only a limit at the contact decides.
        let reach = found[*i].map_or(CLEAR_OF_CONTACT, |_| f64::INFINITY);
        let is_near = |state: &FrictionState| (state.slid - slid).abs() <= reach;
        let [tip, base] = [states[0].filter(is_near), states[1].filter(is_near)];
        let tip = tip.filter(|tip| tip.slid >= slid - SLID_ROUNDING);
        found[*i] = tip.or(base.filter(|base| base.slid <= slid + SLID_ROUNDING));
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
    let ends = runs.iter().map(|run| run.history.target(run.end.limit, run.end.push));
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
    for (found, state) in found.iter_mut().zip(solve_known(&targets)) {
        *found = found.or(state);
    }
    found
}

/// Returns the states of limits at pushes, magnitudes in radians, `[pair]`; `None` where no state is found.
pub(super) fn at_limits(pairs: &[(&SlidingLimit, f64)]) -> Vec<Option<FrictionState>> {
    let targets = pairs.iter().map(|(limit, push)| FrictionTarget::sliding(limit, *push));
    solve_known(&targets.collect::<Vec<_>>())
}

impl ContactHistory {
    /// Target of a contact that slides in a `direction` at `push`, a magnitude in radians; `None` beyond the end of its limit.
    fn target(&self, direction: Sliding, push: f64) -> Option<FrictionTarget<'_>> {
        FrictionTarget::sliding(self.limit(direction)?, push)
    }
}

/// States of the known `targets`, `[target]`; `None` for the others.
fn solve_known(targets: &[Option<FrictionTarget>]) -> Vec<Option<FrictionState>> {
    let known: Vec<FrictionTarget> = targets.iter().flatten().copied().collect();
    let mut solved = solve(&known).into_iter();
    let states = targets.iter();
    states.map(|target| target.and_then(|_| solved.next().flatten())).collect()
}
