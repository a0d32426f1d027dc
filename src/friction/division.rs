//! Division of the segments of a limit at exact states, where an error of the slid distance would change the state of a contact that sticks.

use super::limit::SlidingLimit;
use super::segment::{LimitSegment, SlidingKnot};
use super::states::at_limits;

impl SlidingLimit {
    /// Divides segments of `limits`, given by index, at exact states, `[limit]`. A segment without such states, as at a corner of fold and
    /// tip, stays whole.
    pub fn divided(limits: &[(&Self, Vec<usize>)]) -> Vec<Self> {
        let of_limit = |(limit, segments): &(&Self, Vec<usize>)| {
            let pushes = segments.iter().map(|segment| limit.divisions(*segment));
            pushes.collect()
        };
        let pushes: Vec<Vec<Vec<f64>>> = limits.iter().map(of_limit).collect();
        let pairs = limits
            .iter()
            .zip(&pushes)
            .flat_map(|((limit, _), of_limit)| {
                let pushes = of_limit.iter().flatten();
                pushes.map(move |push| (*limit, *push))
            });
        let mut found = knots_at(&pairs.collect::<Vec<_>>()).into_iter();
        let divided = limits
            .iter()
            .zip(&pushes)
            .map(|((limit, segments), of_limit)| {
                let knots = segments.iter().zip(of_limit).map(|(segment, pushes)| {
                    let inner: Vec<Option<SlidingKnot>> =
                        found.by_ref().take(pushes.len()).collect();
                    (*segment, limit.with_ends(*segment, inner))
                });
                let knots: Vec<(usize, Option<Vec<SlidingKnot>>)> = knots.collect();
                let mut knots = knots.into_iter().peekable();
                let mut joined = Vec::new();
                for (index, segment) in limit.segments.iter().enumerate() {
                    match knots.next_if(|(at, _)| *at == index) {
                        Some((_, Some(knots))) => joined.extend(LimitSegment::between(&knots)),
                        _ => joined.push(segment.clone()),
                    }
                }
                Self {
                    segments: joined,
                    ..(*limit).clone()
                }
            });
        divided.collect()
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

    /// Returns the push angles at which a segment is divided, in radians, with its ends. The limit's states at touch and fold are left out,
    /// because they are singular or exact.
    fn divisions(&self, index: usize) -> Vec<f64> {
        let first = u32::from(index == 0);
        let last = DIVISIONS - u32::from(index + 1 == self.segments.len());
        let parts = (first..=last).map(|i| f64::from(i) / f64::from(DIVISIONS));
        let segment = &self.segments[index];
        parts.map(|part| segment.inner(part).push).collect()
    }

    /// Returns the knots of a divided segment: those at its divisions, and the limit's at touch and fold. `None` if one is not found.
    fn with_ends(
        &self,
        index: usize,
        divisions: Vec<Option<SlidingKnot>>,
    ) -> Option<Vec<SlidingKnot>> {
        let LimitSegment { from, to, .. } = &self.segments[index];
        let touch = (index == 0).then_some(Some(*from));
        let end = (index + 1 == self.segments.len()).then_some(Some(*to));
        let knots = touch.into_iter().chain(divisions).chain(end);
        knots.collect()
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

/// Number of parts of a divided segment. The error of the cubic falls to 1/4096: from 1e-7, the largest seen, to 3e-11.
const DIVISIONS: u32 = 8;

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
