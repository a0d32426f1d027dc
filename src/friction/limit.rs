//! Slid distance of a contact that slides all along a push, toward the tip or toward the base, as a piecewise polynomial.
//!
//! A row whose parameter `w` turns back has no [`RowSpan`](crate::sheet::RowSpan), so the variable is the push angle, which grows along
//! every stable row.

use super::sliding::{rate, slid};
use super::states::FrictionPoint;
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
    segments: Vec<LimitSegment>,
}

/// State at which a limit is interpolated.
#[derive(Clone, Copy, Debug)]
struct SlidingKnot {
    /// Push angle, a magnitude, in radians.
    push: f64,
    /// Slid distance, in whisker lengths.
    slid: f64,
    /// Contact and load of the state, with the friction of the limit.
    state: FrictionPoint,
    /// Derivative of the slid distance by the push; infinite at the fold.
    by_push: f64,
}

impl SlidingLimit {
    /// Computes the sliding limits of `levels`, `[level]`; `None` where the continuation fails. All levels have one method, and their
    /// trajectories share batches.
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        let starts = levels.iter().map(|level| Some((level, level.touch()?)));
        let continued = continuations(&starts.collect::<Vec<_>>(), false, NODE_MISS);
        let nodes = continued.into_iter().map(|continued| {
            let Continuation { nodes, fold, .. } = continued?;
            Some((nodes, fold.is_some()))
        });
        Self::through(levels.iter().zip(nodes).collect())
    }

    /// Computes the sliding limit of `level`, and the limit of its unstable states up to the fold if there is one; `None` if the
    /// continuation fails.
    pub fn with_unstable(level: &LevelCurve) -> Option<(Self, Option<Self>)> {
        let start = Some((level, level.touch()?));
        let Continuation {
            nodes: mut stable,
            fold,
            ..
        } = continuations(&[start], true, NODE_MISS).pop()??;
        let mut unstable = fold.map(|fold| stable[fold..].to_vec());
        if let (Some(unstable), Some(fold)) = (&mut unstable, fold) {
            unstable.reverse();
            stable.truncate(fold + 1);
        }
        let has_fold = fold.is_some();
        let parts = [Some(stable), unstable].map(|nodes| (level, nodes.map(|own| (own, has_fold))));
        let [stable, unstable]: [Option<Self>; 2] = Self::through(parts.into()).try_into().ok()?;
        Some((stable?, unstable))
    }

    /// Makes limits through nodes of their level curves, whose push angles grow; the last node may be a fold.
    fn through(limits: Vec<(&LevelCurve, Option<(Vec<CurveNode>, bool)>)>) -> Vec<Option<Self>> {
        let conditions = limits.iter().flat_map(|(level, nodes)| {
            let nodes = nodes.iter().flat_map(|(nodes, _)| nodes);
            nodes.map(|node| InitialCondition {
                rod: &level.rod,
                tau: node.point.x,
                load: node.point.y,
            })
        });
        let conditions: Vec<InitialCondition> = conditions.collect();
        let shot = limits.first().map(|(level, _)| {
            let batch = Batch::new(level.method);
            batch.shoot::<FirstVariation>(&conditions)
        });
        let mut shot = shot.into_iter().flatten();
        let limits = limits.iter().map(|(level, nodes)| {
            let (nodes, has_fold) = nodes.as_ref()?;
            let fold = has_fold.then(|| nodes.len() - 1);
            let knots = nodes.iter().zip(&mut shot).enumerate();
            let sign = level.side.sign();
            let knots = knots.map(|(i, (node, variation))| SlidingKnot {
                push: sign * node.push,
                slid: slid(&level.rod, node),
                state: FrictionPoint::of(level, node),
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
            Some(Self {
                level: (*level).clone(),
                segments: segments.collect(),
            })
        });
        limits.collect()
    }

    /// Returns the push angles, in radians, of the limit's knots, then those between them at which the limit reverses.
    pub fn pushes(&self) -> impl Iterator<Item = f64> {
        let knots = self.segments.first().map(|first| first.from.push);
        let ends = self.segments.iter().map(|segment| segment.to.push);
        let knots = knots.into_iter().chain(ends);
        let reversals = self.segments.iter().flat_map(LimitSegment::reversals);
        knots.chain(reversals.flatten())
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
        Some(from.state.lerp(&to.state, x))
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

    fn knot(push: f64, slid: f64, by_push: f64) -> SlidingKnot {
        SlidingKnot {
            push,
            slid,
            state: FrictionPoint::default(),
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
