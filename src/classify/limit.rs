//! How far the contact of a row slides along a push, with friction that points toward the tip or toward the base.

use super::sliding::{rate, slid};
use crate::sheet::{Continuation, LevelCurve, NODE_MISS, continuations};
use crate::shooting::FirstVariation;
use crate::shooting::batch::{Batch, InitialCondition};

/// How far one row's contact has slid, from first touch to where its stable states end: its arclength less what it has rolled around the
/// pole, in whisker lengths.
#[derive(Clone, Debug)]
pub struct Limit(Vec<Knot>);

/// A state on it.
#[derive(Clone, Copy, Debug)]
struct Knot {
    /// A magnitude, in radians.
    push: f64,
    slid: f64,
    /// Infinite at the fold.
    by_push: f64,
}

impl Limit {
    /// The limits of `levels`, all of one method, whose trajectories share batches; `None` where continuation is lost.
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        let touches: Vec<_> = levels.iter().map(LevelCurve::touch).collect();
        let starts = levels.iter().zip(&touches);
        let starts = starts.filter_map(|(level, touch)| Some((level, (*touch)?)));
        let mut found = continuations(starts.collect(), false, NODE_MISS).into_iter();
        let walked: Vec<Option<Continuation>> = touches
            .iter()
            .map(|touch| touch.as_ref().and_then(|_| found.next()?))
            .collect();
        let pairs = levels.iter().zip(&walked);
        let nodes = pairs.flat_map(|(level, walked)| {
            let nodes = walked.iter().flat_map(|walked| &walked.nodes);
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
            .zip(walked)
            .map(|(level, walked)| {
                let Continuation { nodes, fold, .. } = walked?;
                let knots = nodes.iter().zip(&mut shot).enumerate();
                let knots = knots.map(|(i, (node, variation))| {
                    let by_phi =
                        rate(&variation, &level.rod, node.point.x) / variation.full.map.det();
                    Knot {
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

    /// The pushes of the knots, and those between them at which the contact turns back.
    pub fn pushes(&self) -> impl Iterator<Item = f64> {
        let turns = self
            .0
            .windows(2)
            .flat_map(|pair| Between::new(pair[0], pair[1]).turns());
        self.0.iter().map(|knot| knot.push).chain(turns.flatten())
    }

    /// Whether the contact moves toward the base anywhere.
    pub fn falls(&self) -> bool {
        let mut pairs = self.0.windows(2).map(|pair| Between::new(pair[0], pair[1]));
        self.0.iter().any(|knot| knot.by_push < 0.0)
            || pairs.any(|pair| pair.turns().iter().any(Option::is_some))
    }

    /// How far it has slid at `push`; `None` beyond the end.
    pub fn slid(&self, push: f64) -> Option<f64> {
        let after = self.0.partition_point(|knot| knot.push <= push);
        let after = after.clamp(1, self.0.len() - 1);
        let [from, to] = [self.0.get(after - 1)?, self.0.get(after)?];
        (push <= to.push).then(|| Between::new(*from, *to).at(push))
    }
}

/// How far it slides between two knots: powers of the part of the way, or, from a fold back, of its root.
struct Between {
    from: f64,
    width: f64,
    /// Whether the push turns back at the second knot.
    to_fold: bool,
    powers: [f64; 4],
}

impl Between {
    /// The cubic with the slopes of both; next to a fold the parabola in the root of the distance from there.
    fn new(from: Knot, to: Knot) -> Self {
        let width = to.push - from.push;
        let secant = to.slid - from.slid;
        let to_fold = to.by_push.is_infinite();
        let powers = if to_fold {
            // By the root, from the fold back: the slope at the other end is twice that by the part.
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
        let part = (push - self.from) / self.width;
        let x = if self.to_fold {
            (1.0 - part).max(0.0).sqrt()
        } else {
            part
        };
        let [c0, c1, c2, c3] = self.powers;
        x.mul_add(x.mul_add(x.mul_add(c3, c2), c1), c0)
    }

    /// The pushes at which it turns back.
    fn turns(&self) -> [Option<f64>; 2] {
        let [_, c1, c2, c3] = self.powers;
        let root = c2.mul_add(c2, -3.0 * c1 * c3).sqrt();
        // One of the two by division, so that neither cancels.
        let q = -(c2 + root.copysign(c2));
        [q / (3.0 * c3), c1 / q].map(|x| {
            let part = if self.to_fold { 1.0 - x * x } else { x };
            let is_within = x > 0.0 && x < 1.0;
            is_within.then_some(part.mul_add(self.width, self.from))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knot(push: f64, slid: f64, by_push: f64) -> Knot {
        Knot {
            push,
            slid,
            by_push,
        }
    }

    fn sorted_turns(between: &Between) -> Vec<f64> {
        let mut turns: Vec<f64> = between.turns().into_iter().flatten().collect();
        turns.sort_by(f64::total_cmp);
        turns
    }

    fn near(found: &[f64], wanted: &[f64]) -> bool {
        let pairs = found.iter().zip(wanted);
        found.len() == wanted.len() && pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12)
    }

    /// `(x - 1)^2 (x + 2)` turns at 1 and -1.
    #[test]
    fn a_cubic_is_found_again_and_turns_where_its_slope_is_none() {
        let slid = |x: f64| (x - 1.0) * (x - 1.0) * (x + 2.0);
        let between = |from: f64, to: f64| {
            let [from, to] = [from, to].map(|x| knot(x, slid(x), 3.0 * x * x - 3.0));
            Between::new(from, to)
        };
        assert!((between(-2.0, 2.0).at(0.3) - slid(0.3)).abs() < 1e-14);
        assert!(near(&sorted_turns(&between(-2.0, 2.0)), &[-1.0, 1.0]));
        assert!(near(&sorted_turns(&between(0.0, 1.5)), &[1.0]));
        assert!(near(&sorted_turns(&between(-0.5, 0.5)), &[]));
    }

    /// With `r` the root of the distance from the fold at 2, `1 - r + 0.8 r^2` turns at `r = 0.625`.
    #[test]
    fn so_is_a_parabola_in_the_root_of_the_distance_from_a_fold() {
        let slid = |push: f64| {
            let root = (2.0 - push).sqrt();
            1.0 - root + 0.8 * root * root
        };
        // By the push: the root falls by 1/(2 r).
        let slope = |push: f64| {
            let root = (2.0 - push).sqrt();
            (1.0 - 1.6 * root) / (2.0 * root)
        };
        let fold = knot(2.0, 1.0, f64::INFINITY);
        let between = |from: f64| Between::new(knot(from, slid(from), slope(from)), fold);
        for push in [1.1, 1.5, 1.99, 2.0] {
            assert!((between(1.0).at(push) - slid(push)).abs() < 1e-14, "{push}");
        }
        assert!(near(&sorted_turns(&between(1.0)), &[2.0 - 0.625 * 0.625]));
        assert!(near(&sorted_turns(&between(1.8)), &[]));
    }
}
