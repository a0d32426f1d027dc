//! Exact segments of a limit, where an error of the slid distance would change the state of a contact that sticks.

use super::limit::SlidingLimit;
use super::segment::{LimitSegment, SlidingKnot};
use super::states::at_limits;
use std::collections::{BTreeMap, BTreeSet};

/// Largest error of the slid distance in the middle of an exact segment, in whisker lengths.
const LIMIT_ERROR: f64 = 1e-10;

/// Change of the push, in radians, that counts as rounding. Next to a fold, it changes the slid distance by more than [`LIMIT_ERROR`].
const PUSH_ROUNDING: f64 = 1e-13;

/// Number of times that a segment may be halved. The error of a smooth cubic falls to 1/16 each time. Where the tip ends a limit just before its
/// fold, segments there are halved up to their distance from the fold.
const HALVINGS: u32 = 48;

/// Limit whose segments are made exact.
struct OpenLimit {
    limit: SlidingLimit,
    /// True for each segment whose error is not yet known to be small, `[segment]`.
    is_open: Vec<bool>,
}

impl OpenLimit {
    /// Returns the push angles in the middle of open segments, in radians.
    fn middles(&self) -> impl Iterator<Item = f64> {
        let segments = self.limit.segments.iter().zip(&self.is_open);
        let open = segments.filter(|(_, is_open)| **is_open);
        open.map(|(segment, _)| segment.inner(MIDDLE).push)
    }

    /// Halves the open segments whose polynomials miss the states in their `middles`, and closes those that do not. A segment without a state
    /// in its middle stays open.
    fn halve(&mut self, mut middles: impl Iterator<Item = Option<SlidingKnot>>) {
        let (mut segments, mut is_open) = (Vec::new(), Vec::new());
        for (segment, was_open) in self.limit.segments.drain(..).zip(&self.is_open) {
            let middle = was_open.then(|| middles.next().flatten()).flatten();
            let is_short = segment.to.push - segment.from.push <= PUSH_ROUNDING;
            let misses = |knot: SlidingKnot| {
                let miss = (knot.slid - segment.slid.at(MIDDLE).0).abs();
                miss > LIMIT_ERROR + PUSH_ROUNDING * knot.slope().abs()
            };
            match middle {
                Some(knot) if misses(knot) => {
                    let knots = [segment.from, knot, segment.to];
                    segments.extend(LimitSegment::between(&knots, segment.folds));
                    is_open.extend([true; 2]);
                }
                _ => {
                    segments.push(segment);
                    is_open.push(*was_open && middle.is_none() && !is_short);
                }
            }
        }
        (self.limit.segments, self.is_open) = (segments, is_open);
    }
}

/// Variable of a segment in its middle.
const MIDDLE: f64 = 0.5;

impl SlidingLimit {
    /// Makes segments of `limits`, given by index, exact: their knots are exact states, and their error is small, `[limit]`. The limit's states at
    /// its ends stay, because they are singular or exact. An entry is `None` where a segment is not exact after all halvings.
    pub fn exact(limits: &[(&Self, Vec<usize>)]) -> Vec<Option<Self>> {
        let inner = |(limit, segments): &(&Self, Vec<usize>)| {
            let ends = segments.iter().flat_map(|index| [*index, index + 1]);
            let inner = ends.filter(|knot| (1..limit.segments.len()).contains(knot));
            inner.collect::<BTreeSet<usize>>()
        };
        let inner: Vec<BTreeSet<usize>> = limits.iter().map(inner).collect();
        let pairs = limits.iter().zip(&inner).flat_map(|((limit, _), inner)| {
            inner.iter().map(move |knot| (*limit, limit.segments[*knot].from.push))
        });
        let mut found = knots_at(&pairs.collect::<Vec<_>>()).into_iter();
        let begun = limits.iter().zip(&inner).map(|((limit, segments), inner)| {
            let found = inner.iter().zip(found.by_ref());
            let found = found.filter_map(|(index, knot)| Some((*index, knot?)));
            let knots: BTreeMap<usize, SlidingKnot> = found.collect();
            let mut limit = (*limit).clone();
            let mut is_open = vec![false; limit.segments.len()];
            for &index in segments {
                let segment = &mut limit.segments[index];
                let from = knots.get(&index).copied().unwrap_or(segment.from);
                let to = knots.get(&(index + 1)).copied().unwrap_or(segment.to);
                *segment = LimitSegment::new(from, to, segment.folds);
                is_open[index] = true;
            }
            OpenLimit { limit, is_open }
        });
        let mut open: Vec<OpenLimit> = begun.collect();
        for _ in 0..HALVINGS {
            let pairs = open.iter().flat_map(|open| open.middles().map(|push| (&open.limit, push)));
            let pairs: Vec<(&Self, f64)> = pairs.collect();
            if pairs.is_empty() {
                break;
            }
            let mut middles = knots_at(&pairs).into_iter();
            for open in &mut open {
                open.halve(middles.by_ref());
            }
        }
        open.into_iter().map(|open| (!open.is_open.contains(&true)).then_some(open.limit)).collect()
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
        let exact: Vec<Vec<(usize, f64)>> = limits
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
            })
            .collect();
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
                        segments.push(LimitSegment::new(segment.from, knot, segment.folds));
                        segments.push(LimitSegment::new(knot, segment.to, segment.folds));
                    }
                    _ => segments.push(segment.clone()),
                }
            }
            Self { segments, ..limit.clone() }
        });
        polished.collect()
    }

    /// Returns the indices of all segments.
    pub fn segments(&self) -> Vec<usize> {
        (0..self.segments.len()).collect()
    }

    /// Returns the indices of the segments with a reversal, and of their neighbours.
    pub fn around_reversals(&self) -> Vec<usize> {
        let reverses = |segment: &LimitSegment| segment.reversals().iter().any(Option::is_some);
        self.around(reverses)
    }

    /// Returns the indices of the segments between two push angles, in radians, and of their neighbours.
    pub fn between(&self, from: f64, to: f64) -> Vec<usize> {
        let is_between =
            |segment: &LimitSegment| segment.to.push >= from && segment.from.push <= to;
        self.around(is_between)
    }

    /// Returns the indices of the segments that are `wanted`, and of their neighbours.
    fn around(&self, wanted: impl Fn(&LimitSegment) -> bool) -> Vec<usize> {
        let wanted: Vec<bool> = self.segments.iter().map(wanted).collect();
        let is_near = |i: &usize| {
            let [from, to] = [i.saturating_sub(1), (i + 2).min(wanted.len())];
            wanted[from..to].contains(&true)
        };
        self.segments().into_iter().filter(is_near).collect()
    }
}

/// Exact knots of limits at push angles, magnitudes in radians, `[pair]`; `None` where the state is not found.
fn knots_at(pairs: &[(&SlidingLimit, f64)]) -> Vec<Option<SlidingKnot>> {
    let states = pairs.iter().zip(at_limits(pairs));
    let knots = states.map(|((limit, push), state)| {
        let (level, state) = (&limit.level, state?);
        let node = state.node(level.side.sign() * push);
        Some(SlidingKnot::new(level, node, &state.variation))
    });
    knots.collect()
}
