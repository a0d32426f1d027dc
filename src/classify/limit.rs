//! Slid distance of a contact that slides all along a push, toward the tip or toward the base, as a piecewise polynomial.

use super::sliding::{rate, slid};
use crate::sheet::{Continuation, LevelCurve, NODE_MISS, continuations};
use crate::shooting::FirstVariation;
use crate::shooting::batch::{Batch, InitialCondition};

/// Slid distance of one row's contact by push, from first touch to the end of its stable states: the arclength of the contact minus
/// the distance rolled around the pole, in whisker lengths.
#[derive(Clone, Debug)]
pub struct SlidingLimit(Vec<SlidingKnot>);

/// State at which a limit is interpolated.
#[derive(Clone, Copy, Debug)]
struct SlidingKnot {
    /// Push angle, a magnitude, in radians.
    push: f64,
    /// Slid distance, in whisker lengths.
    slid: f64,
    /// Derivative of the slid distance by the push; infinite at the fold.
    by_push: f64,
}

impl SlidingLimit {
    /// Limits of `levels`, one each; `None` where the continuation fails. All levels have one method, and their trajectories share
    /// batches.
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        let touches: Vec<_> = levels.iter().map(LevelCurve::touch).collect();
        let starts = levels.iter().zip(&touches);
        let starts = starts.filter_map(|(level, touch)| Some((level, (*touch)?)));
        let mut followed = continuations(starts.collect(), false, NODE_MISS).into_iter();
        let continued: Vec<Option<Continuation>> = touches
            .iter()
            .map(|touch| touch.as_ref().and_then(|_| followed.next()?))
            .collect();
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
                        by_push: if Some(i) == fold {
                            f64::INFINITY
                        } else {
                            level.side.sign() * by_phi
                        },
                    }
                });
                Some(Self(knots.collect()))
            })
            .collect()
    }

    /// Push angles of the knots, then push angles between them at which the limit reverses, in radians.
    pub fn pushes(&self) -> impl Iterator<Item = f64> {
        let reversals = self
            .0
            .windows(2)
            .flat_map(|pair| LimitSegment::new(pair[0], pair[1]).reversals());
        let knots = self.0.iter().map(|knot| knot.push);
        knots.chain(reversals.flatten())
    }

    /// Returns true if the limit moves toward the base anywhere.
    pub fn falls(&self) -> bool {
        let mut pairs = self
            .0
            .windows(2)
            .map(|pair| LimitSegment::new(pair[0], pair[1]));
        self.0.iter().any(|knot| knot.by_push < 0.0)
            || pairs.any(|pair| pair.reversals().iter().any(Option::is_some))
    }

    /// Slid distance at `push`, in whisker lengths; `None` beyond the end.
    pub fn slid(&self, push: f64) -> Option<f64> {
        let after = self.0.partition_point(|knot| knot.push <= push);
        let after = after.clamp(1, self.0.len() - 1);
        let [from, to] = [self.0.get(after - 1)?, self.0.get(after)?];
        (push <= to.push).then(|| LimitSegment::new(*from, *to).at(push))
    }
}

/// Polynomial of the slid distance between two knots. Its variable is the fraction of the interval from the first knot or, if the
/// second knot is a fold, the square root of the fraction from there.
struct LimitSegment {
    from: f64,
    width: f64,
    /// Whether the second knot is a fold.
    to_fold: bool,
    /// Coefficients, of the constant first.
    powers: [f64; 4],
}

impl LimitSegment {
    /// Cubic Hermite polynomial or, next to a fold, the parabola in the square root that has the slope of the first knot.
    fn new(from: SlidingKnot, to: SlidingKnot) -> Self {
        let width = to.push - from.push;
        let secant = to.slid - from.slid;
        let to_fold = to.by_push.is_infinite();
        let powers = if to_fold {
            // At the first knot the derivative by the root is twice the derivative by the fraction.
            let bend = secant - 2.0 * from.by_push * width;
            [to.slid, -secant - bend, bend, 0.0]
        } else {
            let [a, b] = [from, to].map(|knot| knot.by_push * width - secant);
            [from.slid, secant + a, -2.0 * a - b, a + b]
        };
        Self {
            from: from.push,
            width,
            to_fold,
            powers,
        }
    }

    fn at(&self, push: f64) -> f64 {
        let fraction = (push - self.from) / self.width;
        let x = if self.to_fold {
            (1.0 - fraction).max(0.0).sqrt()
        } else {
            fraction
        };
        let [c0, c1, c2, c3] = self.powers;
        x.mul_add(x.mul_add(x.mul_add(c3, c2), c1), c0)
    }

    /// Push angles at which the slid distance reverses, in radians.
    fn reversals(&self) -> [Option<f64>; 2] {
        let [_, c1, c2, c3] = self.powers;
        let root = c2.mul_add(c2, -3.0 * c1 * c3).sqrt();
        // The second root follows by division, so that neither root cancels.
        let q = -(c2 + root.copysign(c2));
        [q / (3.0 * c3), c1 / q].map(|x| {
            let fraction = if self.to_fold { 1.0 - x * x } else { x };
            let is_within = x > 0.0 && x < 1.0;
            is_within.then_some(fraction.mul_add(self.width, self.from))
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
