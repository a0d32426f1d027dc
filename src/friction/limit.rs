//! Slid distance of a contact that slides all along a push, toward the tip or toward the base, as a piecewise polynomial.
//!
//! A row whose parameter `w` turns back has no [`RowSpan`](crate::sheet::RowSpan), so the variable is the push angle, which grows along
//! every stable row.

use super::sliding::{rate, slid};
use super::states::FrictionPoint;
use crate::numerics::newton_form::{Polynomial, through_runs};
use crate::sheet::{Continuation, LevelCurve, NODE_MISS, continuations};
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
        let pairs = levels.iter().zip(&continued);
        let nodes = pairs.flat_map(|(level, continued)| {
            let nodes = continued.iter().flat_map(|curve| &curve.nodes);
            nodes.map(move |node| InitialCondition {
                rod: &level.rod,
                tau: node.point.x,
                load: node.point.y,
            })
        });
        let nodes: Vec<InitialCondition> = nodes.collect();
        let shot = levels
            .first()
            .map(|level| Batch::new(level.method).shoot::<FirstVariation>(&nodes));
        let mut shot = shot.into_iter().flatten();
        levels
            .iter()
            .zip(continued)
            .map(|(level, continued)| {
                let Continuation { nodes, fold, .. } = continued?;
                let knots = nodes.iter().zip(&mut shot).enumerate();
                let knots = knots.map(|(i, (node, variation))| {
                    let by_phi =
                        rate(&variation, &level.rod, node.point.x) / variation.full.map.det();
                    SlidingKnot {
                        push: node.push.abs(),
                        slid: slid(&level.rod, node),
                        state: FrictionPoint::of(level, node),
                        by_push: if Some(i) == fold {
                            f64::INFINITY
                        } else {
                            level.side.sign() * by_phi
                        },
                    }
                });
                let knots: Vec<SlidingKnot> = knots.collect();
                let segments = knots.windows(2);
                let segments = segments.map(|pair| LimitSegment::new(pair[0], pair[1]));
                Some(Self {
                    level: level.clone(),
                    segments: segments.collect(),
                })
            })
            .collect()
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

    /// Returns the slid distance at the push angle `push` (radians), in whisker lengths; `None` beyond the end.
    pub fn slid(&self, push: f64) -> Option<f64> {
        Some(self.segment(push)?.at(push))
    }

    /// Returns a state near that of the limit at the push angle `push` (radians); `None` beyond the end.
    pub fn near(&self, push: f64) -> Option<FrictionPoint> {
        let LimitSegment { from, to, .. } = self.segment(push)?;
        let part = self.segment(push)?.part(push);
        Some(from.state.lerp(&to.state, part))
    }

    fn segment(&self, push: f64) -> Option<&LimitSegment> {
        let at = self
            .segments
            .partition_point(|segment| segment.to.push <= push);
        let segment = self.segments.get(at).or(self.segments.last())?;
        (push <= segment.to.push).then_some(segment)
    }
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

    fn at(&self, push: f64) -> f64 {
        self.cubic.at(self.part(push)).0
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
            let fraction = if self.is_to_fold { x * (2.0 - x) } else { x };
            let is_within = x > 0.0 && x < 1.0;
            is_within.then_some(fraction.mul_add(self.to.push - self.from.push, self.from.push))
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
        assert!((segment(-2.0, 2.0).at(0.3) - slid(0.3)).abs() < 1e-14);
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
            assert!((segment(1.0).at(push) - slid(push)).abs() < 1e-14, "{push}");
        }
        assert!(near(
            &sorted_reversals(&segment(1.0)),
            &[2.0 - 0.625 * 0.625]
        ));
        assert!(near(&sorted_reversals(&segment(1.8)), &[]));
    }
}
