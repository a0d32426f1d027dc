//! Paths of sticking contacts: states from the end of sliding to the farthest push at which the contact still sticks. They are the starts
//! of Newton's method, and keep it on the states that a push reaches.

use super::history::ContactQuery;
use super::history::{ContactHistory, ContactPhase, SlidingEnd};
use super::newton::{FrictionTarget, solve};
use super::state::{FrictionPoint, FrictionState};
use std::ops::Range;

/// Number of steps of a path to each side of the push at which sliding ended.
const PATH_STEPS: u32 = 8;

/// Number of nodes of a path through which a start is interpolated.
const AROUND: usize = 4;

/// Queries, one after the other, of a contact that sticks at one place.
pub struct StuckRun<'a> {
    /// History of the contact.
    pub history: &'a ContactHistory,
    /// State in which the contact slid last.
    pub end: SlidingEnd,
    /// Indices of the queries.
    pub queries: Range<usize>,
    /// Smallest and largest push of the queries, in radians.
    extremes: [f64; 2],
}

impl<'a> StuckRun<'a> {
    /// Returns the runs of sticking contacts among `queries`.
    pub fn of(queries: &[ContactQuery<'a>]) -> Vec<Self> {
        let mut runs: Vec<Self> = Vec::new();
        for (i, query) in queries.iter().enumerate() {
            let ContactPhase::Sticks(end) = query.phase else {
                continue;
            };
            match runs.last_mut() {
                Some(last)
                    if last.end == end
                        && last.queries.end == i
                        && std::ptr::eq(last.history, query.history) =>
                {
                    let [least, most] = last.extremes;
                    last.extremes = [least.min(query.push), most.max(query.push)];
                    last.queries.end = i + 1;
                }
                _ => runs.push(Self {
                    history: query.history,
                    end,
                    queries: i..i + 1,
                    extremes: [query.push.min(end.push), query.push.max(end.push)],
                }),
            }
        }
        runs
    }
}

/// States of a contact that sticks at one place, at growing pushes.
pub struct StuckPath<'a> {
    /// State at the end of sliding, as the target of Newton's method.
    end: FrictionTarget<'a>,
    /// Pushes, magnitudes in radians, with the states there.
    nodes: Vec<(f64, FrictionPoint)>,
}

/// Part of a path that is still followed, to one side of its start.
struct OpenPath {
    run: usize,
    /// Pushes of the first and the last node, in radians.
    pushes: [f64; 2],
    nodes: Vec<(f64, FrictionPoint)>,
}

impl<'a> StuckPath<'a> {
    /// Follows the paths of `runs` from the states `ends`, in batches, `[run]`; `None` without the state at the end of sliding. A path ends
    /// where a state is not found.
    pub fn of(runs: &[StuckRun<'a>], ends: &[Option<FrictionState>]) -> Vec<Option<Self>> {
        let starts = runs.iter().zip(ends).map(|(run, end)| {
            let (end, level) = (end.as_ref()?, &run.history.limit(run.end.limit)?.level);
            Some(FrictionTarget {
                level,
                signed_push: level.side.sign() * run.end.push,
                slid: Some(end.slid),
                start: end.at,
                is_stable: true,
            })
        });
        let starts: Vec<Option<FrictionTarget>> = starts.collect();
        let mut open: Vec<OpenPath> = Vec::new();
        for (index, (run, start)) in runs.iter().zip(&starts).enumerate() {
            let Some(start) = start else { continue };
            for extreme in run.extremes {
                let from = run.end.push;
                open.push(OpenPath {
                    run: index,
                    pushes: [from, extreme],
                    nodes: vec![(from, start.start)],
                });
            }
        }
        open.retain(|path| path.pushes[0] != path.pushes[1]);
        let mut ended = Vec::new();
        for step in 1..=PATH_STEPS {
            let targets = open.iter().filter_map(|path| {
                let push = path.push(step);
                let start = starts[path.run].as_ref()?;
                Some(start.at(push, path.ahead()))
            });
            let found = solve(&targets.collect::<Vec<_>>());
            for (mut path, state) in std::mem::take(&mut open).into_iter().zip(found) {
                match state {
                    Some(state) => {
                        path.nodes.push((path.push(step), state.at));
                        open.push(path);
                    }
                    None => ended.push(path),
                }
            }
        }
        ended.extend(open);
        let mut paths: Vec<Option<Self>> = starts
            .into_iter()
            .zip(runs)
            .map(|(end, run)| {
                let end = end?;
                let nodes = vec![(run.end.push, end.start)];
                Some(Self { end, nodes })
            })
            .collect();
        for part in ended {
            if let Some(path) = &mut paths[part.run] {
                path.nodes.extend(&part.nodes[1..]);
            }
        }
        for path in paths.iter_mut().flatten() {
            path.nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
            path.nodes.dedup_by_key(|(push, _)| *push);
        }
        paths
    }

    /// Returns the target at `push`, a magnitude in radians, with a start on the polynomial through the nodes around it; `None` beyond the
    /// ends of the path.
    pub fn target(&self, push: f64) -> Option<FrictionTarget<'a>> {
        let [first, last] = [self.nodes.first()?.0, self.nodes.last()?.0];
        if push < first || push > last {
            return None;
        }
        // On each side of the end of sliding the nodes are evenly spaced.
        let end = self.nodes.partition_point(|(at, _)| *at < self.end.signed_push.abs());
        let side = match push < self.end.signed_push.abs() {
            true => &self.nodes[..=end],
            false => &self.nodes[end..],
        };
        let after = side.partition_point(|(at, _)| *at < push);
        let fewer = side.len().saturating_sub(AROUND);
        let near = &side[after.saturating_sub(AROUND / 2).min(fewer)..];
        let near = &near[..near.len().min(AROUND)];
        // Neville's algorithm.
        let mut points: Vec<FrictionPoint> = near.iter().map(|(_, point)| *point).collect();
        for apart in 1..near.len() {
            for (i, ends) in near.windows(apart + 1).enumerate() {
                let part = (push - ends[0].0) / (ends[apart].0 - ends[0].0);
                points[i] = points[i].lerp(&points[i + 1], part);
            }
        }
        Some(self.end.at(push, points[0]))
    }
}

impl OpenPath {
    /// Returns the push of the node after `step` steps, in radians. The last one is exact, because a query lies there.
    fn push(&self, step: u32) -> f64 {
        let [from, to] = self.pushes;
        match step {
            PATH_STEPS => to,
            _ => ((to - from) / f64::from(PATH_STEPS)).mul_add(f64::from(step), from),
        }
    }

    /// Start of Newton's method for the next node: the last two nodes, extrapolated.
    fn ahead(&self) -> FrictionPoint {
        match self.nodes[..] {
            [.., (_, before), (_, last)] => before.lerp(&last, 2.0),
            [(_, last)] => last,
            [] => FrictionPoint::default(),
        }
    }
}
