//! Continuation along a level curve `D = const`: the states in front of one pole, from first touch through the fold to the branch's end.

mod corrector;
pub mod level_curve;
mod meeting;
mod path;
pub mod pieces;
mod states;
mod stepper;

pub use path::Path;

use crate::newton::BatchNewton;
use crate::sheet::continuation::level_curve::{CurveNode, LevelCurve, ON_CURVE, Stretch};
use crate::sheet::continuation::meeting::{Meeting, meet};
use crate::sheet::continuation::stepper::Stepper;
use glam::DVec2;

/// Largest miss in `ln D` of a node between the ends of a continuation. Such nodes only guide it and approximate states.
pub const NODE_MISS: f64 = 1e-8;

impl LevelCurve {
    /// Follows a `stretch` of the level curve from `start`, for at most nine turns of the base, and unstable states
    /// alone for one turn toward the other side. Returns `None` if the continuation fails.
    #[must_use]
    pub fn continuation(&self, start: CurveNode, stretch: Stretch) -> Option<Path> {
        within_turns(&[Some((self, start))], stretch, ON_CURVE).pop()?
    }
}

/// Level curve and the node from which it is followed. The whole is `None` for a curve that is left out.
pub type CurveStart<'a> = Option<(&'a LevelCurve, CurveNode)>;

/// Follows several level curves to an edge, each as [`LevelCurve::continuation`] does; their trajectories share batches. Returns `[curve]`, `None` where
/// the continuation fails or reaches no edge, or the start is `None`.
///
/// Nodes between the ends may miss their curve by `miss` in `ln D`. Results do not depend on the other curves. Where an end is steep, the
/// curve is followed again with twice the steps.
#[must_use]
pub fn continuations(starts: &[CurveStart], stretch: Stretch, miss: f64) -> Vec<Option<Path>> {
    let followed = within_turns(starts, stretch, miss).into_iter();
    let ended = followed.map(|found| found.filter(|found| found.end.is_some()));
    ended.collect()
}

/// Follows level curves as [`continuations`] does, also curves that reach no edge within these turns.
fn within_turns(starts: &[CurveStart], stretch: Stretch, miss: f64) -> Vec<Option<Path>> {
    let mut ended = follow_with_retry(starts, stretch, miss);
    let pairs = starts.iter().zip(&ended);
    let finer = pairs.map(|(start, found)| {
        let is_steep = found.as_ref()?.is_steep();
        is_steep.then(|| start.map(|(level, _)| level.finer()))?
    });
    let finer: Vec<Option<LevelCurve>> = finer.collect();
    let pairs = finer.iter().zip(starts);
    let finer_starts = pairs.map(|(level, start)| Some((level.as_ref()?, (*start)?.1)));
    let finer_starts: Vec<CurveStart> = finer_starts.collect();
    let again = follow_with_retry(&finer_starts, stretch, miss);
    for ((ended, again), start) in ended.iter_mut().zip(again).zip(starts) {
        // States between nodes take the steps of all other states.
        let again =
            again.zip(*start).map(|(path, (level, _))| Path { level: level.clone(), ..path });
        *ended = again.or(ended.take());
    }
    ended
}

/// Follows all curves. Curves that reach no edge are followed once more with nodes to rounding: where curves meet, nodes with an error of `miss`
/// can lead to another curve. Unstable states alone may be left at the largest push angle.
fn follow_with_retry(starts: &[CurveStart], stretch: Stretch, miss: f64) -> Vec<Option<Path>> {
    let mut ended = follow(starts, stretch, miss);
    if miss > ON_CURVE {
        let pairs = starts.iter().zip(&ended);
        let may_be_open = stretch == Stretch::Unstable;
        let has_end = |found: &Option<Path>| {
            found.as_ref().is_some_and(|path| path.end.is_some() || may_be_open)
        };
        let failed = pairs.map(|(start, found)| start.filter(|_| !has_end(found)));
        let again = follow(&failed.collect::<Vec<_>>(), stretch, ON_CURVE);
        for (ended, again) in ended.iter_mut().zip(again) {
            *ended = again.or(ended.take());
        }
    }
    ended
}

/// Returns true if `node` is a first touch from which the contact cannot slide: friction and curvature are so strong that the pole would
/// have to go back for it.
fn jams(node: &CurveNode) -> bool {
    node.is_first_touch() && node.full.map.det() < 0.0
}

fn follow(starts: &[CurveStart], stretch: Stretch, miss: f64) -> Vec<Option<Path>> {
    let mut ended = vec![None; starts.len()];
    let Some((first, _)) = starts.iter().flatten().next() else {
        return ended;
    };
    let newton = BatchNewton::new(first.method, u32::MAX);
    let steppers = starts.iter().enumerate().filter_map(|(index, start)| {
        let (level, node) = start.filter(|(_, node)| !jams(node))?;
        Some(Stepper::new(index, level, node, stretch, miss))
    });
    let mut open: Vec<Stepper> = steppers.collect();
    while !open.is_empty() {
        // Each stepper runs until the chord to its next node may meet an edge, or until it fails. So edge Newtons share batches, too.
        let predicted: Vec<DVec2> = open.iter().map(|stepper| stepper.predicted).collect();
        newton.solve(&mut open, predicted);
        for stepper in &mut open {
            if stepper.candidate.is_none() && stepper.is_beyond_turns() {
                ended[stepper.index] = Some(stepper.path(None));
            }
        }
        let at_edges = std::mem::take(&mut open).into_iter();
        let at_edges =
            at_edges.filter_map(|mut stepper| Some((stepper.candidate.take()?, stepper)));
        let at_edges: Vec<(CurveNode, Stepper)> = at_edges.collect();
        let chords = at_edges.iter().map(|(next, stepper)| stepper.chord(*next));
        let meetings = meet(&chords.collect::<Vec<_>>());
        for ((next, mut stepper), meeting) in at_edges.into_iter().zip(meetings) {
            let may_go_on = match meeting {
                Meeting::None => stepper.add(next),
                Meeting::Unclear => stepper.shorten(),
                Meeting::Edge(edge, node)
                    if stepper.end_at(edge, node) && stretch == Stretch::PastFold =>
                {
                    stepper.advance()
                }
                Meeting::Edge(edge, _) => {
                    ended[stepper.index] = Some(stepper.path(Some(edge)));
                    false
                }
            };
            if may_go_on {
                open.push(stepper);
            } else if stepper.is_beyond_turns() {
                ended[stepper.index] = Some(stepper.path(None));
            }
        }
    }
    ended
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a branch that is not there fails the test")]
mod tests {
    use super::*;
    use crate::sheet::row::Row;
    use std::f64::consts::TAU;
    use whiskmap_mechanics::rod::{Rest, Rod, Side};
    use whiskmap_mechanics::shooting::batch::Method;

    /// In a soft follicle, a coil of several turns unwinds toward the other side: unstable states are left after one turn there.
    #[test]
    fn unstable_states_are_followed_back_for_one_turn() {
        let rod = Rod { taper: 0.5, pole: 0.0188, mount: 1.74, ..Rod::default() };
        let row = Row::new(&Rest::new(&rod), 0.193);
        let level = LevelCurve::new(Method::fine(), &rod, Side::Cb, &row);
        let branch = level.continuation(level.touch(), Stretch::PastFold).unwrap();
        let fold = branch.nodes[branch.fold.unwrap()];
        let last = |nodes: &[CurveNode]| nodes[nodes.len() - 1].signed_push / TAU;
        assert!(
            fold.signed_push > 2.0 * TAU && last(&branch.nodes) < -1.5,
            "{}",
            last(&branch.nodes)
        );
        let unstable = level.continuation(fold, Stretch::Unstable).unwrap();
        assert!((-1.1..-1.0).contains(&last(&unstable.nodes)) && unstable.end.is_none());
    }

    /// Stable and unstable states of branches, up to their folds, where the push angle is flat.
    #[test]
    fn a_state_at_a_push_takes_few_iterations() {
        for side in Side::BOTH {
            let rod = Rod { taper: 0.95, bend: 0.4, pole: 0.0125 * side.sign(), ..Rod::default() };
            let row = Row::new(&Rest::new(&rod), 0.75);
            let level = LevelCurve::new(Method::fine(), &rod, side, &row);
            let branch = level.continuation(level.touch(), Stretch::PastFold).unwrap();
            let fold = branch.fold.unwrap();
            for part in [&branch.nodes[..=fold], &branch.nodes[fold..]] {
                let [from, to] = [part[0].signed_push, part[part.len() - 1].signed_push];
                for i in 0..=200 {
                    let push = from + (to - from) * f64::from(i) / 200.0;
                    // Rounding may lead beyond the end.
                    let push = push.clamp(from.min(to), from.max(to));
                    let (node, root) = level.bracketed_push(part, push).unwrap();
                    let left = (node.signed_push - push).abs();
                    // The tolerance of the search: at the nodes around the state, not at the state itself.
                    let miss = |node: &CurveNode| node.signed_push - push;
                    let is_around = |pair: &&[CurveNode]| miss(&pair[0]) * miss(&pair[1]) <= 0.0;
                    let around = part.windows(2).find(is_around).unwrap().iter();
                    let allowed = around.map(|node| level.rounding(node)).fold(0.0, f64::max);
                    let allowed = allowed * push.abs().max(1.0);
                    assert!(left <= allowed, "{left:e} > {allowed:e} at {push} {root:?}");
                    // Measured: 12, next to a fold.
                    assert!(root.iterations <= 12, "{push} {root:?}");
                }
            }
        }
    }
}
