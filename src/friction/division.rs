//! Division of the segments of a limit at exact states, where an error of the slid distance would change the state of a contact that sticks.

use super::limit::{LimitPart, SlidingLimit, through};
use super::segment::{LimitSegment, SlidingKnot};
use super::state::FrictionState;
use super::states::at_limits;
use crate::sheet::CurveNode;

impl SlidingLimit {
    /// Divides segments of `limits`, given by index, at exact states, `[limit]`. A segment without such states, as at a corner of fold and
    /// tip, stays whole.
    pub fn divided(limits: &[(&Self, Vec<usize>)]) -> Vec<Self> {
        let pushes = limits.iter().map(|(limit, segments)| {
            let parts = (0..=DIVISIONS).map(|i| f64::from(i) / f64::from(DIVISIONS));
            let parts: Vec<f64> = parts.collect();
            let of = |segment: &usize| {
                let segment = &limit.segments[*segment];
                let places = parts.iter().map(|part| segment.inner(*part).push);
                places.collect::<Vec<f64>>()
            };
            (*limit, segments.iter().flat_map(of).collect::<Vec<f64>>())
        });
        let pushes: Vec<(&Self, Vec<f64>)> = pushes.collect();
        let wanted = pushes
            .iter()
            .flat_map(|(limit, pushes)| pushes.iter().map(|push| (*limit, *push)));
        let mut found = at_limits(&wanted.collect::<Vec<_>>()).into_iter();
        let parts = limits
            .iter()
            .zip(&pushes)
            .map(|((limit, segments), (_, pushes))| {
                let states: Vec<Option<FrictionState>> =
                    found.by_ref().take(pushes.len()).collect();
                let mut states = states.into_iter();
                let each = DIVISIONS as usize + 1;
                let runs = segments.iter().map(|segment| {
                    let states: Vec<Option<FrictionState>> = states.by_ref().take(each).collect();
                    limit.run(*segment, &states)
                });
                runs.collect::<Vec<Option<LimitPart>>>()
            });
        let parts: Vec<Vec<Option<LimitPart>>> = parts.collect();
        let mut divided = through(&parts.concat()).into_iter();
        let limits = limits.iter().map(|(limit, segments)| {
            let runs: Vec<Option<Self>> = divided.by_ref().take(segments.len()).collect();
            let mut runs = segments.iter().zip(runs).peekable();
            let mut joined = Vec::new();
            for (index, segment) in limit.segments.iter().enumerate() {
                match runs.next_if(|(at, _)| **at == index) {
                    Some((_, Some(run))) => joined.extend(run.segments),
                    _ => joined.push(segment.clone()),
                }
            }
            Self {
                segments: joined,
                ..(*limit).clone()
            }
        });
        limits.collect()
    }

    /// Divides the segments of `limits` in which the limit reverses at the reversal, `[limit]`. A segment without the state there stays whole.
    /// The reversal is exact to the square of its error before.
    pub fn polished(limits: &[Self]) -> Vec<Self> {
        let reversals = limits.iter().map(|limit| {
            let of = |(index, segment): (usize, &LimitSegment)| {
                let turns = segment.reversals().into_iter().flatten().next();
                turns.map(|push| (index, push))
            };
            limit.segments.iter().enumerate().filter_map(of).collect()
        });
        let reversals: Vec<Vec<(usize, f64)>> = reversals.collect();
        let at = |reversals: &[Vec<(usize, f64)>]| {
            let pairs = limits.iter().zip(reversals);
            let pairs = pairs.flat_map(|(limit, limit_reversals)| {
                limit_reversals.iter().map(move |(_, push)| (limit, *push))
            });
            knots_at(&pairs.collect::<Vec<_>>())
        };
        let mut near = at(&reversals).into_iter();
        let exact = limits
            .iter()
            .zip(&reversals)
            .map(|(limit, limit_reversals)| {
                let exact = limit_reversals.iter().map(|(index, push)| {
                    let LimitSegment { from, to, .. } = &limit.segments[*index];
                    let bend = (to.slope() - from.slope()) / (to.push - from.push);
                    let found = near.next().flatten();
                    let step = found.map_or(0.0, |knot: SlidingKnot| knot.slope() / bend);
                    let exact = push - step;
                    let is_inside = from.push < exact && exact < to.push;
                    (*index, if is_inside { exact } else { *push })
                });
                exact.collect()
            });
        let exact: Vec<Vec<(usize, f64)>> = exact.collect();
        let mut knots = at(&exact).into_iter();
        let polished = limits.iter().zip(&exact).map(|(limit, limit_reversals)| {
            let found: Vec<Option<SlidingKnot>> =
                knots.by_ref().take(limit_reversals.len()).collect();
            let mut segments = Vec::with_capacity(limit.segments.len() + limit_reversals.len());
            let mut turns = limit_reversals.iter().zip(found).peekable();
            for (index, segment) in limit.segments.iter().enumerate() {
                match turns.next_if(|((at, _), _)| *at == index) {
                    Some((_, Some(knot))) => {
                        let knot = knot.at_reversal();
                        segments.push(LimitSegment::new(segment.from, knot));
                        segments.push(LimitSegment::new(knot, segment.to));
                    }
                    _ => segments.push(segment.clone()),
                }
            }
            Self {
                segments,
                ..limit.clone()
            }
        });
        polished.collect()
    }

    /// Nodes of a divided segment. The segment keeps its states at touch and fold, which are singular or exact.
    fn run(&self, segment: usize, states: &[Option<FrictionState>]) -> Option<LimitPart<'_>> {
        let LimitSegment { from, to, .. } = &self.segments[segment];
        let last = states.len() - 1;
        let is_end =
            |i: usize| i == 0 && segment == 0 || i == last && (segment + 1 == self.segments.len());
        let nodes = states.iter().enumerate().map(|(i, state)| {
            let knot = if i == 0 { from } else { to };
            let sign = self.level.side.sign();
            match state {
                _ if is_end(i) => Some(knot.node),
                Some(state) => Some(CurveNode {
                    point: state.at.point,
                    full: state.full,
                    push: sign * self.segments[segment].inner(i as f64 / last as f64).push,
                    angle: state.at.angle,
                }),
                None => None,
            }
        });
        Some(LimitPart {
            level: &self.level,
            nodes: nodes.collect::<Option<_>>()?,
            has_fold: to.by_push.is_none(),
            is_stable: self.is_stable,
        })
    }

    /// Returns the indices of all segments.
    pub fn segments(&self) -> Vec<usize> {
        (0..self.segments.len()).collect()
    }

    /// Returns the indices of the segments with a reversal, and of their neighbours.
    pub fn around_reversals(&self) -> Vec<usize> {
        let reverses = |segment: &LimitSegment| segment.reversals().iter().any(Option::is_some);
        let reversing: Vec<bool> = self.segments.iter().map(reverses).collect();
        let is_near = |i: &usize| {
            let [from, to] = [i.saturating_sub(1), (i + 2).min(reversing.len())];
            reversing[from..to].contains(&true)
        };
        self.segments().into_iter().filter(is_near).collect()
    }

    /// Returns the indices of the segments between two push angles, in radians, and of their neighbours.
    pub fn between(&self, from: f64, to: f64) -> Vec<usize> {
        let is_between =
            |segment: &LimitSegment| segment.to.push >= from && segment.from.push <= to;
        let inside: Vec<bool> = self.segments.iter().map(is_between).collect();
        let is_near = |i: &usize| {
            let [from, to] = [i.saturating_sub(1), (i + 2).min(inside.len())];
            inside[from..to].contains(&true)
        };
        self.segments().into_iter().filter(is_near).collect()
    }
}

/// Number of parts of a divided segment. The error of the cubic falls to 1/4096: from 1e-7, the largest seen, to 3e-11.
const DIVISIONS: u32 = 8;

/// Exact knots of limits at push angles, magnitudes in radians, `[pair]`; `None` where the state is not found.
fn knots_at(pairs: &[(&SlidingLimit, f64)]) -> Vec<Option<SlidingKnot>> {
    let parts = pairs
        .iter()
        .zip(at_limits(pairs))
        .map(|((limit, push), state)| {
            let state = state?;
            let node = CurveNode {
                point: state.at.point,
                full: state.full,
                push: limit.level.side.sign() * push,
                angle: state.at.angle,
            };
            // A segment needs two nodes.
            Some(LimitPart {
                level: &limit.level,
                nodes: vec![node; 2],
                has_fold: false,
                is_stable: limit.is_stable,
            })
        });
    let limits = through(&parts.collect::<Vec<_>>());
    let first = |limit: SlidingLimit| limit.segments.first().map(|segment| segment.from);
    limits.into_iter().map(|limit| first(limit?)).collect()
}
