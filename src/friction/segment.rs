//! Segment of a limit: the slid distance between two states as a polynomial.

use super::sliding::{ContactRate, slid};
use crate::sheet::{CurveNode, LevelCurve};
use std::array;
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
            push: sign * node.signed_push,
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
        [self.slid, self.node.point.x, self.node.point.y, self.node.angle]
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

/// Folds at which a limit begins and ends, by their push angles, magnitudes in radians; `None` for another end. Next to a fold, the contact is
/// a smooth function of the square root of the push that is left to the fold, not of the push.
#[derive(Clone, Copy, Debug, Default)]
pub struct LimitFolds {
    pub begin: Option<f64>,
    pub end: Option<f64>,
}

impl LimitFolds {
    /// Returns the length from one push to another in the variable in which the contact is smooth up to both ends of the limit.
    fn length(self, [from, to]: [f64; 2]) -> f64 {
        let change = to - from;
        let [[after, before], [after_to, before_to]] = [from, to].map(|push| self.roots(push));
        match (self.begin, self.end) {
            _ if change == 0.0 => 0.0,
            (None, None) => change,
            (None, Some(_)) => change / (before + before_to),
            (Some(_), None) => change / (after + after_to),
            // The variable is the angle whose tangent is the quotient of the roots.
            (Some(_), Some(_)) => libm::asin(change / (after_to * before + after * before_to)),
        }
    }

    /// Returns the push at this `length` after the push `from`, in radians.
    fn push(self, from: f64, length: f64) -> f64 {
        let [after, before] = self.roots(from);
        let change = match (self.begin, self.end) {
            (None, None) => length,
            (None, Some(_)) => length * (2.0 * before - length),
            (Some(_), None) => length * (2.0 * after + length),
            (Some(begin), Some(end)) => {
                let angle = libm::atan2(after, before);
                (end - begin) * libm::sin(2.0 * angle + length) * libm::sin(length)
            }
        };
        from + change
    }

    /// Returns the derivative of the push by the length.
    fn slope(self, push: f64) -> f64 {
        let [after, before] = self.roots(push);
        match (self.begin, self.end) {
            (None, None) => 1.0,
            (None, Some(_)) => 2.0 * before,
            (Some(_), None) => 2.0 * after,
            (Some(_), Some(_)) => 2.0 * after * before,
        }
    }

    /// Returns the square roots of the distances of `push` from the folds; 0 without a fold.
    fn roots(self, push: f64) -> [f64; 2] {
        let distances = [self.begin.map(|begin| push - begin), self.end.map(|end| end - push)];
        distances.map(|distance| distance.unwrap_or_default().max(0.0).sqrt())
    }
}

/// Polynomials of the contact between two knots. Their variable `x` grows from 0 to 1, in proportion to the length of [`LimitFolds`].
#[derive(Clone, Debug)]
pub struct LimitSegment {
    pub from: SlidingKnot,
    pub to: SlidingKnot,
    pub folds: LimitFolds,
    /// Slid distance, with a value and a slope at each knot.
    pub slid: Polynomial<4>,
    /// Contact coordinate, load and tangent angle.
    near: [Polynomial<4>; 3],
}

impl LimitSegment {
    /// Returns the segments between neighbouring `knots` of a limit with these `folds`, `[segment]`.
    pub fn between(knots: &[SlidingKnot], folds: LimitFolds) -> Vec<Self> {
        let pairs = knots.windows(2);
        pairs.map(|pair| Self::new(pair[0], pair[1], folds)).collect()
    }

    /// Cubic Hermite polynomials or, where a knot is a fold, the parabolas that have the slopes of the other knot.
    pub fn new(from: SlidingKnot, to: SlidingKnot, folds: LimitFolds) -> Self {
        let values = [from, to].map(|knot| knot.values());
        let secant: [f64; 4] = array::from_fn(|i| values[1][i] - values[0][i]);
        let length = folds.length([from.push, to.push]);
        let known = [from, to].map(|knot| {
            let by_x = folds.slope(knot.push) * length;
            knot.slopes().map(|slopes| slopes.map(|by| by * by_x))
        });
        // The slopes of a parabola have the secant as their mean. Between two folds, it is a line.
        let other = |known: Option<[f64; 4]>| match known {
            Some(slopes) => array::from_fn(|i| 2.0 * secant[i] - slopes[i]),
            None => secant,
        };
        let slopes = [
            known[0].unwrap_or_else(|| other(known[1])),
            known[1].unwrap_or_else(|| other(known[0])),
        ];
        let differences = through_runs(&values, &slopes)[0];
        let polynomial = |i: usize| Polynomial::on_even_nodes(2, differences.map(|term| term[i]));
        Self { from, to, folds, slid: polynomial(0), near: [1, 2, 3].map(polynomial) }
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
        let length = |push| self.folds.length([self.from.push, push]);
        length(push) / length(self.to.push)
    }

    /// Place at the variable `x`.
    pub fn inner(&self, x: f64) -> LimitPlace {
        let [from, to] = [self.from.push, self.to.push];
        let length = self.folds.length([from, to]);
        // Rounding may lead beyond a short segment.
        let push = self.folds.push(from, x * length).max(from).min(to);
        LimitPlace { push, push_by_x: self.folds.slope(push) * length }
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
                signed_push: push,
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

    /// Whatever its folds, a segment returns from a push to its variable and back, also next to a fold, and its slope is that of the push.
    #[test]
    fn the_variable_of_a_segment_is_that_of_its_folds() {
        for (begin, end) in
            [(None, None), (None, Some(2.0)), (Some(1.0), None), (Some(1.0), Some(2.0))]
        {
            let ends = [1.0, 2.0].map(|push| knot(push, 0.0, 0.0));
            let segment = LimitSegment::new(ends[0], ends[1], LimitFolds { begin, end });
            for push in [1.0 + 1e-9, 1.3, 1.5, 1.8, 2.0 - 1e-9] {
                let x = segment.part(push);
                let place = segment.inner(x);
                assert!((place.push - push).abs() < 1e-15, "{begin:?} {end:?} {push}");
                let step = 1e-4;
                if x.min(1.0 - x) < step {
                    continue;
                }
                let [before, after] = [x - step, x + step].map(|x| segment.inner(x).push);
                let by_x = (after - before) / (2.0 * step);
                let miss = (by_x - place.push_by_x).abs();
                assert!(miss < 1e-7, "{begin:?} {end:?} {push}: {miss:e}");
            }
        }
    }

    /// `(x - 1)^2 (x + 2)` reverses at 1 and -1.
    #[test]
    fn a_cubic_is_reproduced_and_reverses_where_its_slope_is_zero() {
        let slid = |x: f64| (x - 1.0) * (x - 1.0) * (x + 2.0);
        let segment = |from: f64, to: f64| {
            let [from, to] = [from, to].map(|x| knot(x, slid(x), 3.0 * x * x - 3.0));
            LimitSegment::new(from, to, LimitFolds::default())
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
        let folds = LimitFolds { begin: None, end: Some(2.0) };
        let segment =
            |from: f64| LimitSegment::new(knot(from, slid(from), slope(from)), fold, folds);
        for push in [1.1, 1.5, 1.99, 2.0] {
            let found = at(&segment(1.0), push);
            assert!((found - slid(push)).abs() < 1e-14, "{push}");
        }
        assert!(near(&sorted_reversals(&segment(1.0)), &[2.0 - 0.625 * 0.625]));
        assert!(near(&sorted_reversals(&segment(1.8)), &[]));
    }
}
