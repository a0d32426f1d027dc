//! Slid distance of a contact that slides all along a push, toward the tip or toward the base, as a piecewise polynomial.
//!
//! A row whose parameter `w` turns back has no [`RowSpan`](crate::sheet::RowSpan), so the variable is the push angle, which grows along
//! every stable row.

use super::sliding::{rate, slid};
use super::states::{FrictionPoint, FrictionState, at_limits};
use crate::numerics::newton_form::{Polynomial, through_runs};
use crate::sheet::{Continuation, CurveNode, LevelCurve, NODE_MISS, continuations};
use crate::shooting::FirstVariation;
use crate::shooting::batch::{Batch, InitialCondition};

/// Slid distance of one row's contact by push angle, from first touch to the end of its stable states. It is the arclength of the contact
/// minus the distance rolled around the pole, in whisker lengths.
#[derive(Clone, Debug)]
pub struct SlidingLimit {
    /// Level curve of the limit, with the friction of its direction.
    pub level: LevelCurve,
    /// True if the states of the limit are stable.
    pub is_stable: bool,
    segments: Vec<LimitSegment>,
}

/// State at which a limit is interpolated.
#[derive(Clone, Copy, Debug)]
struct SlidingKnot {
    /// Push angle, a magnitude, in radians.
    push: f64,
    /// Slid distance, in whisker lengths.
    slid: f64,
    /// State of the knot, with the friction of the limit.
    node: CurveNode,
    /// Derivative of the slid distance by the push; infinite at the fold.
    by_push: f64,
}

impl SlidingLimit {
    /// Computes the sliding limits of `levels`, `[level]`; `None` where the continuation fails. All levels have one method, and their
    /// trajectories share batches.
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        let starts = levels.iter().map(|level| Some((level, level.touch()?)));
        let continued = continuations(&starts.collect::<Vec<_>>(), false, NODE_MISS);
        let parts = levels.iter().zip(continued).map(|(level, continued)| {
            let Continuation { nodes, fold, .. } = continued?;
            Some(LimitPart {
                level,
                nodes,
                has_fold: fold.is_some(),
                is_stable: true,
            })
        });
        through(&parts.collect::<Vec<_>>())
    }

    /// Computes the sliding limit of `level`, and the limit of its unstable states up to the fold if there is one; `None` if the
    /// continuation fails.
    pub fn with_unstable(level: &LevelCurve) -> Option<(Self, Option<Self>)> {
        let start = Some((level, level.touch()?));
        let continued = continuations(&[start], true, NODE_MISS).pop()??;
        let Continuation { nodes, fold, .. } = continued;
        let has_fold = fold.is_some();
        let part = |nodes: &[CurveNode], is_stable| LimitPart {
            level,
            nodes: nodes.to_vec(),
            has_fold,
            is_stable,
        };
        let stable = part(&nodes[..fold.map_or(nodes.len(), |fold| fold + 1)], true);
        let unstable = fold.map(|fold| {
            let mut unstable = part(&nodes[fold..], false);
            unstable.nodes.reverse();
            unstable
        });
        let mut limits = through(&[Some(stable), unstable]).into_iter();
        Some((limits.next()??, limits.next()?))
    }

    /// Divides segments of `limits`, given by index, at exact states, `[limit]`; `None` where such a state is not found.
    pub fn divided(limits: &[(&Self, Vec<usize>)]) -> Vec<Option<Self>> {
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
                runs.collect::<Option<Vec<LimitPart>>>()
            });
        let parts: Vec<Option<Vec<LimitPart>>> = parts.collect();
        let flat: Vec<Option<LimitPart>> = parts
            .iter()
            .flatten()
            .flatten()
            .map(|part| Some(part.clone()))
            .collect();
        let mut divided = through(&flat).into_iter();
        let limits = limits.iter().zip(&parts).map(|((limit, segments), parts)| {
            let runs = parts.as_ref()?.iter().map(|_| divided.next()?);
            let runs: Vec<Self> = runs.collect::<Option<_>>()?;
            let mut runs = segments.iter().zip(runs);
            let mut next = runs.next();
            let mut own = Vec::new();
            for (index, segment) in limit.segments.iter().enumerate() {
                match next {
                    Some((at, run)) if *at == index => {
                        own.extend(run.segments);
                        next = runs.next();
                    }
                    other => {
                        own.push(segment.clone());
                        next = other;
                    }
                }
            }
            Some(Self {
                segments: own,
                ..(*limit).clone()
            })
        });
        limits.collect()
    }

    /// Divides the segments of `limits` in which the limit reverses at the reversal, `[limit]`; `None` where the state there is not found.
    /// The reversal is exact to the square of its error before.
    pub fn polished(limits: Vec<Self>) -> Vec<Option<Self>> {
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
            let pairs =
                pairs.flat_map(|(limit, own)| own.iter().map(move |(_, push)| (limit, *push)));
            knots_at(&pairs.collect::<Vec<_>>())
        };
        let mut near = at(&reversals).into_iter();
        let exact = limits.iter().zip(&reversals).map(|(limit, own)| {
            let exact = own.iter().map(|(index, push)| {
                let LimitSegment { from, to, .. } = &limit.segments[*index];
                let bend = (to.by_push - from.by_push) / (to.push - from.push);
                let found = near.next().flatten();
                let step = found.map_or(0.0, |knot: SlidingKnot| knot.by_push / bend);
                let exact = push - step;
                let is_inside = from.push < exact && exact < to.push;
                (*index, if is_inside { exact } else { *push })
            });
            exact.collect()
        });
        let exact: Vec<Vec<(usize, f64)>> = exact.collect();
        let mut knots = at(&exact).into_iter();
        let polished = limits.iter().zip(&exact).map(|(limit, own)| {
            let found: Vec<Option<SlidingKnot>> = knots.by_ref().take(own.len()).collect();
            let mut segments = Vec::with_capacity(limit.segments.len() + own.len());
            let mut turns = own.iter().zip(found).peekable();
            for (index, segment) in limit.segments.iter().enumerate() {
                match turns.next_if(|((at, _), _)| *at == index) {
                    Some((_, knot)) => {
                        let knot = SlidingKnot {
                            by_push: 0.0,
                            ..knot?
                        };
                        segments.push(LimitSegment::new(segment.from, knot));
                        segments.push(LimitSegment::new(knot, segment.to));
                    }
                    None => segments.push(segment.clone()),
                }
            }
            Some(Self {
                segments,
                ..limit.clone()
            })
        });
        polished.collect()
    }

    /// Nodes of a divided segment. The states at touch and fold, which are singular or exact, stay those of the segment.
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
            has_fold: to.by_push.is_infinite(),
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
        let is_between = |own: &LimitSegment| own.to.push >= from && own.from.push <= to;
        let inside: Vec<bool> = self.segments.iter().map(is_between).collect();
        let is_near = |i: &usize| {
            let [from, to] = [i.saturating_sub(1), (i + 2).min(inside.len())];
            inside[from..to].contains(&true)
        };
        self.segments().into_iter().filter(is_near).collect()
    }

    /// Returns the push angles, in radians, of the limit's knots, then those between them at which the limit reverses.
    pub fn pushes(&self) -> impl Iterator<Item = f64> {
        let knots = self.segments.first().map(|first| first.from.push);
        let ends = self.segments.iter().map(|segment| segment.to.push);
        let knots = knots.into_iter().chain(ends);
        let reversals = self.segments.iter().flat_map(LimitSegment::reversals);
        knots.chain(reversals.flatten())
    }

    /// Returns the push angle at which the limit begins, in radians.
    pub fn begin(&self) -> f64 {
        self.segments.first().map_or(0.0, |first| first.from.push)
    }

    /// Returns the push angle at which the stable states of the limit end, in radians.
    pub fn end(&self) -> f64 {
        self.segments.last().map_or(0.0, |last| last.to.push)
    }

    /// Returns true if the sliding limit moves toward the base anywhere.
    pub fn falls(&self) -> bool {
        self.segments.iter().any(LimitSegment::falls)
    }

    /// Returns the slid distance at the push angle `push` (radians), in whisker lengths; `None` beyond the ends.
    pub fn slid(&self, push: f64) -> Option<f64> {
        let (segment, x) = self.place(push)?;
        Some(self.segments[segment].cubic.at(x).0)
    }

    /// Returns a state near that of the limit at the push angle `push` (radians); `None` beyond the ends.
    pub fn near(&self, push: f64) -> Option<FrictionPoint> {
        let (segment, x) = self.place(push)?;
        let LimitSegment { from, to, .. } = &self.segments[segment];
        let [from, to] = [from, to].map(|knot| FrictionPoint::of(&self.level, &knot.node));
        Some(from.lerp(&to, x))
    }

    /// Returns the index of the segment at the push angle `push` (radians), and its variable there; `None` beyond the ends.
    pub fn place(&self, push: f64) -> Option<(usize, f64)> {
        let last = self.segments.len().checked_sub(1)?;
        let after = self.segments.partition_point(|own| own.to.push <= push);
        let at = after.min(last);
        let segment = &self.segments[at];
        let is_inside = segment.from.push <= push && push <= segment.to.push;
        is_inside.then(|| (at, segment.part(push)))
    }

    /// Returns the places of all segments at the variables `parts`, `[segment][part]`, flat.
    pub fn inner(&self, parts: &[f64]) -> Vec<LimitPlace> {
        let segments = self.segments.iter();
        let places = segments.flat_map(|segment| parts.iter().map(|part| segment.inner(*part)));
        places.collect()
    }
}

/// Number of parts of a divided segment. The error of the cubic falls to 1/4096: from 1e-7, the largest seen, to 3e-11.
const DIVISIONS: u32 = 8;

/// States of a limit whose push angles grow.
#[derive(Clone, Debug)]
struct LimitPart<'a> {
    level: &'a LevelCurve,
    nodes: Vec<CurveNode>,
    /// True if the last node is a fold.
    has_fold: bool,
    is_stable: bool,
}

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

/// Makes limits through the nodes of `parts`, `[part]`. Trajectories share batches.
fn through(parts: &[Option<LimitPart>]) -> Vec<Option<SlidingLimit>> {
    let known = parts.iter().flatten();
    let conditions = known.clone().flat_map(|part| {
        part.nodes.iter().map(|node| InitialCondition {
            rod: &part.level.rod,
            tau: node.point.x,
            load: node.point.y,
        })
    });
    let conditions: Vec<InitialCondition> = conditions.collect();
    let method = known.clone().next().map(|part| part.level.method);
    let shot = method.map(|method| Batch::new(method).shoot::<FirstVariation>(&conditions));
    let mut shot = shot.into_iter().flatten();
    let limits = parts.iter().map(|part| {
        let LimitPart { level, nodes, .. } = part.as_ref()?;
        let fold = part.as_ref()?.has_fold.then(|| nodes.len() - 1);
        let knots = nodes.iter().zip(&mut shot).enumerate();
        let sign = level.side.sign();
        let knots = knots.map(|(i, (node, variation))| SlidingKnot {
            push: sign * node.push,
            slid: slid(&level.rod, node),
            node: *node,
            by_push: match Some(i) == fold {
                true => f64::INFINITY,
                false => {
                    let det = variation.full.map.det();
                    sign * rate(&variation, &level.rod, node.point.x) / det
                }
            },
        });
        let knots: Vec<SlidingKnot> = knots.collect();
        let segments = knots.windows(2);
        let segments = segments.map(|pair| LimitSegment::new(pair[0], pair[1]));
        Some(SlidingLimit {
            level: (*level).clone(),
            is_stable: part.as_ref()?.is_stable,
            segments: segments.collect(),
        })
    });
    limits.collect()
}

/// Place on a limit.
#[derive(Clone, Copy, Debug)]
pub struct LimitPlace {
    /// Push angle of the place, a magnitude, in radians.
    pub push: f64,
    /// Derivative of the push angle by the variable of the segment, in radians.
    pub push_by_x: f64,
}

/// Polynomial of the slid distance between two knots. Its variable `x` grows from 0 to 1. It is the fraction of the interval. If the
/// second knot is a fold, it is 1 minus the square root of the fraction that is left.
#[derive(Clone, Debug)]
struct LimitSegment {
    from: SlidingKnot,
    to: SlidingKnot,
    /// True if the second knot is a fold.
    is_to_fold: bool,
    /// Slid distance, with a value and a slope at each knot.
    cubic: Polynomial<4>,
}

impl LimitSegment {
    /// Cubic Hermite polynomial or, next to a fold, the parabola that has the slope of the first knot.
    fn new(from: SlidingKnot, to: SlidingKnot) -> Self {
        let is_to_fold = to.by_push.is_infinite();
        let [begin, end] = [from, to].map(|knot| knot.by_push * (to.push - from.push));
        let slopes = if is_to_fold {
            // At the first knot, the fraction changes twice as fast as `x`. The slopes of a parabola have the secant as their mean.
            [2.0 * begin, 2.0 * (to.slid - from.slid - begin)]
        } else {
            [begin, end]
        };
        let differences = through_runs(&[[from.slid], [to.slid]], &slopes.map(|slope| [slope]))[0];
        Self {
            from,
            to,
            is_to_fold,
            cubic: Polynomial::on_even_nodes(2, differences.map(|[difference]| difference)),
        }
    }

    /// Variable `x` at the push angle `push`, in radians.
    fn part(&self, push: f64) -> f64 {
        let fraction = (push - self.from.push) / (self.to.push - self.from.push);
        if self.is_to_fold {
            1.0 - (1.0 - fraction).max(0.0).sqrt()
        } else {
            fraction
        }
    }

    /// Place at the variable `x`.
    fn inner(&self, x: f64) -> LimitPlace {
        let length = self.to.push - self.from.push;
        let (fraction, by_x) = if self.is_to_fold {
            (x * (2.0 - x), 2.0 - 2.0 * x)
        } else {
            (x, 1.0)
        };
        LimitPlace {
            push: fraction.mul_add(length, self.from.push),
            push_by_x: by_x * length,
        }
    }

    /// Returns true if the slid distance falls anywhere.
    fn falls(&self) -> bool {
        let slopes = [0.0, 1.0].map(|x| self.cubic.at(x).1);
        slopes.iter().any(|slope| *slope < 0.0) || self.reversals().iter().any(Option::is_some)
    }

    /// Push angles at which the slid distance reverses, in radians.
    fn reversals(&self) -> [Option<f64>; 2] {
        // The slope is `c1 + 2 c2 x + 3 c3 x^2`.
        let [_, c1, second, c3] = self.cubic.differences;
        let c2 = second - c3;
        let root = c2.mul_add(c2, -3.0 * c1 * c3).sqrt();
        // The second root follows by division, so that neither root cancels.
        let q = -(c2 + root.copysign(c2));
        [q / (3.0 * c3), c1 / q].map(|x| {
            let is_within = x > 0.0 && x < 1.0;
            is_within.then(|| self.inner(x).push)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shooting::FullState;
    use glam::DVec2;

    fn knot(push: f64, slid: f64, by_push: f64) -> SlidingKnot {
        SlidingKnot {
            push,
            slid,
            node: CurveNode {
                point: DVec2::ZERO,
                full: FullState::default(),
                push,
                angle: 0.0,
            },
            by_push,
        }
    }

    fn at(segment: &LimitSegment, push: f64) -> f64 {
        segment.cubic.at(segment.part(push)).0
    }

    fn sorted_reversals(segment: &LimitSegment) -> Vec<f64> {
        let mut reversals: Vec<f64> = segment.reversals().into_iter().flatten().collect();
        reversals.sort_by(f64::total_cmp);
        reversals
    }

    fn near(found: &[f64], wanted: &[f64]) -> bool {
        let pairs = found.iter().zip(wanted);
        found.len() == wanted.len() && pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12)
    }

    /// `(x - 1)^2 (x + 2)` reverses at 1 and -1.
    #[test]
    fn a_cubic_is_reproduced_and_reverses_where_its_slope_is_zero() {
        let slid = |x: f64| (x - 1.0) * (x - 1.0) * (x + 2.0);
        let segment = |from: f64, to: f64| {
            let [from, to] = [from, to].map(|x| knot(x, slid(x), 3.0 * x * x - 3.0));
            LimitSegment::new(from, to)
        };
        let found = at(&segment(-2.0, 2.0), 0.3);
        assert!((found - slid(0.3)).abs() < 1e-14);
        assert!(near(&sorted_reversals(&segment(-2.0, 2.0)), &[-1.0, 1.0]));
        assert!(near(&sorted_reversals(&segment(0.0, 1.5)), &[1.0]));
        assert!(near(&sorted_reversals(&segment(-0.5, 0.5)), &[]));
    }

    /// With `r` the square root of the distance from the fold at 2, `1 - r + 0.8 r^2` reverses at `r = 0.625`.
    #[test]
    fn a_parabola_in_the_root_of_the_distance_from_a_fold_is_reproduced() {
        let slid = |push: f64| {
            let root = (2.0 - push).sqrt();
            1.0 - root + 0.8 * root * root
        };
        // The derivative of the root by the push is -1/(2 r).
        let slope = |push: f64| {
            let root = (2.0 - push).sqrt();
            (1.0 - 1.6 * root) / (2.0 * root)
        };
        let fold = knot(2.0, 1.0, f64::INFINITY);
        let segment = |from: f64| LimitSegment::new(knot(from, slid(from), slope(from)), fold);
        for push in [1.1, 1.5, 1.99, 2.0] {
            let found = at(&segment(1.0), push);
            assert!((found - slid(push)).abs() < 1e-14, "{push}");
        }
        assert!(near(
            &sorted_reversals(&segment(1.0)),
            &[2.0 - 0.625 * 0.625]
        ));
        assert!(near(&sorted_reversals(&segment(1.8)), &[]));
    }
}
