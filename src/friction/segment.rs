//! Segment of a limit: the slid distance between two states as a polynomial.

use super::sliding::{ContactRate, slid};
use crate::sheet::{CurveNode, LevelCurve};
use whiskmap_mechanics::numerics::newton_form::{Polynomial, through_runs};
use whiskmap_mechanics::shooting::FirstVariation;

/// State at which a limit is interpolated.
#[derive(Clone, Copy, Debug)]
pub struct SlidingKnot {
    /// Push angle, a magnitude, in radians.
    pub push: f64,
    /// Slid distance, in whisker lengths.
    pub slid: f64,
    /// State of the knot, with the friction of the limit.
    pub node: CurveNode,
    /// Derivatives of the contact by the push; `None` at the fold, where they are infinite.
    pub by_push: Option<ContactRate>,
}

impl SlidingKnot {
    /// Creates the knot at a `node` of `level`. `variation` has the derivatives of the node's state.
    pub fn new(level: &LevelCurve, node: CurveNode, variation: &FirstVariation) -> Self {
        let sign = level.side.sign();
        let rate = ContactRate::new(variation, &level.rod, node.point.x);
        Self {
            push: sign * node.push,
            slid: slid(&level.rod, &node),
            node,
            by_push: Some(rate.times(sign / variation.full.map.det())),
        }
    }

    /// Returns this knot as one at a fold.
    pub fn at_fold(self) -> Self {
        let by_push = None;
        Self { by_push, ..self }
    }

    /// Returns the derivative of the slid distance by the push; infinite at the fold.
    pub fn slope(&self) -> f64 {
        self.by_push.map_or(f64::INFINITY, |rate| rate.slid)
    }

    /// Returns this knot as one at which the slid distance reverses.
    pub fn at_reversal(self) -> Self {
        let by_push = self.by_push.map(|rate| ContactRate { slid: 0.0, ..rate });
        Self { by_push, ..self }
    }

    /// Returns slid distance, contact coordinate, load and tangent angle.
    fn values(&self) -> [f64; 4] {
        [
            self.slid,
            self.node.point.x,
            self.node.point.y,
            self.node.angle,
        ]
    }

    /// Returns the derivatives of the values by the push; `None` at the fold.
    fn slopes(&self) -> Option<[f64; 4]> {
        let ContactRate { point, angle, slid } = self.by_push?;
        Some([slid, point.x, point.y, angle])
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

/// Polynomials of the contact between two knots. Their variable `x` grows from 0 to 1. It is the fraction of the interval. If the
/// second knot is a fold, it is 1 minus the square root of the fraction that is left.
#[derive(Clone, Debug)]
pub struct LimitSegment {
    pub from: SlidingKnot,
    pub to: SlidingKnot,
    /// True if the second knot is a fold.
    is_to_fold: bool,
    /// Slid distance, with a value and a slope at each knot.
    pub slid: Polynomial<4>,
    /// Contact coordinate, load and tangent angle.
    near: [Polynomial<4>; 3],
}

impl LimitSegment {
    /// Returns the segments between neighbouring `knots`, `[segment]`.
    pub fn between(knots: &[SlidingKnot]) -> Vec<Self> {
        let pairs = knots.windows(2);
        pairs.map(|pair| Self::new(pair[0], pair[1])).collect()
    }

    /// Cubic Hermite polynomials or, next to a fold, the parabolas that have the slopes of the first knot. The first knot is no fold.
    pub fn new(from: SlidingKnot, to: SlidingKnot) -> Self {
        let values = [from, to].map(|knot| knot.values());
        let length = to.push - from.push;
        let slopes =
            [from, to].map(|knot| knot.slopes().map(|slopes| slopes.map(|by| by * length)));
        let is_to_fold = slopes[1].is_none();
        let begin = slopes[0].unwrap_or_default();
        let slopes = match slopes[1] {
            Some(end) => [begin, end],
            // At the first knot, the fraction changes twice as fast as `x`. The slopes of a parabola have the secant as their mean.
            None => [
                begin.map(|begin| 2.0 * begin),
                std::array::from_fn(|i| 2.0 * (values[1][i] - values[0][i] - begin[i])),
            ],
        };
        let differences = through_runs(&values, &slopes)[0];
        let polynomial = |i: usize| Polynomial::on_even_nodes(2, differences.map(|term| term[i]));
        Self {
            from,
            to,
            is_to_fold,
            slid: polynomial(0),
            near: [1, 2, 3].map(polynomial),
        }
    }

    /// Returns approximate contact coordinate, load and tangent angle at the variable `x`. They lie on the polynomials or, where a corner of
    /// fold and tip throws a polynomial far off, on lines.
    pub fn contact(&self, x: f64) -> [f64; 3] {
        let [from, to] = [0.0, 1.0].map(|end| self.near.map(|polynomial| polynomial.at(end).0));
        let cubic = self.near.map(|polynomial| polynomial.at(x).0);
        let line = |i: usize| (to[i] - from[i]).mul_add(x, from[i]);
        let is_near = |i: &usize| (cubic[*i] - line(*i)).abs() <= (to[*i] - from[*i]).abs();
        match [0, 1].iter().all(is_near) {
            true => cubic,
            false => [0, 1, 2].map(line),
        }
    }

    /// Variable `x` at the push angle `push`, in radians.
    pub fn part(&self, push: f64) -> f64 {
        let fraction = (push - self.from.push) / (self.to.push - self.from.push);
        if self.is_to_fold {
            1.0 - (1.0 - fraction).max(0.0).sqrt()
        } else {
            fraction
        }
    }

    /// Place at the variable `x`.
    pub fn inner(&self, x: f64) -> LimitPlace {
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
    pub fn falls(&self) -> bool {
        let slopes = [0.0, 1.0].map(|x| self.slid.at(x).1);
        slopes.iter().any(|slope| *slope < 0.0) || self.reversals().iter().any(Option::is_some)
    }

    /// Push angles at which the slid distance reverses, in radians.
    pub fn reversals(&self) -> [Option<f64>; 2] {
        // The slope is `c1 + 2 c2 x + 3 c3 x^2`.
        let [_, c1, second, c3] = self.slid.differences;
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
    use glam::DVec2;
    use whiskmap_mechanics::shooting::FullState;

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
            by_push: by_push.is_finite().then_some(ContactRate {
                point: DVec2::ZERO,
                angle: 0.0,
                slid: by_push,
            }),
        }
    }

    fn at(segment: &LimitSegment, push: f64) -> f64 {
        segment.slid.at(segment.part(push)).0
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
