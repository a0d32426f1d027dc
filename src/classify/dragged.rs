//! Where a push drags the contact, and where it sticks.
//!
//! With friction the contact may be anywhere between two limits: the place where it would slide toward the tip, which states are
//! computed for, and the place where it would slide toward the base, with friction the other way. At first touch the two are one. A
//! push moves the limits, and they drag the contact along: it is where the last of them has left it (Prandtl's play).

use super::{Sliding, SlidingState};
use crate::rod::Rod;
use crate::sheet::{Continuation, LevelCurve, Node, continuations};
use glam::DVec2;

/// Places closer together than this, in whisker lengths, are the same.
const SAME_PLACE: f64 = 1e-11;

/// The limit of one row toward the base, from first touch to where no contact that slides toward the base stays on the pole.
#[derive(Clone, Debug)]
pub struct BaseLimit {
    pole: f64,
    knots: Vec<Knot>,
}

/// A state on the limit.
#[derive(Clone, Copy, Debug)]
struct Knot {
    push: f64,
    place: f64,
    by_push: f64,
    turned: f64,
}

impl BaseLimit {
    /// The limits of rows that begin at first touch, whose trajectories share batches; `None` where continuation is lost.
    #[must_use]
    pub fn of(levels: &[LevelCurve]) -> Vec<Option<Self>> {
        let opposed: Vec<LevelCurve> = levels.iter().map(opposed).collect();
        let touches: Vec<Option<Node>> = opposed.iter().map(LevelCurve::touch).collect();
        let starts = opposed.iter().zip(&touches);
        let starts = starts.filter_map(|(level, touch)| Some((level, (*touch)?)));
        let mut walked = continuations(starts.collect(), false).into_iter();
        opposed
            .iter()
            .zip(&touches)
            .map(|(level, touch)| {
                touch.as_ref()?;
                Some(Self::along(level, &walked.next()??))
            })
            .collect()
    }

    fn along(level: &LevelCurve, Continuation { nodes, fold, .. }: &Continuation) -> Self {
        let points: Vec<(DVec2, f64)> = nodes.iter().map(|node| (node.point, node.push)).collect();
        let pole = level.rod.pole;
        let states = SlidingState::at(level, &points).into_iter().zip(nodes);
        let knots = states.enumerate().map(|(i, (state, node))| {
            let turned = node.angle - node.push;
            Knot {
                push: state.push,
                place: state.place(pole, turned),
                by_push: if Some(i) == *fold {
                    f64::INFINITY
                } else {
                    state.by_push
                },
                turned,
            }
        });
        Self {
            pole,
            knots: knots.collect(),
        }
    }

    /// Where a push from first touch slides at each of its stable `states`, by growing push.
    #[must_use]
    pub fn slidings(&self, states: &[SlidingState]) -> Vec<Sliding> {
        let Some(touch) = self.knots.first() else {
            return Vec::new();
        };
        let (mut push, mut place) = (touch.push, touch.place);
        let sliding = |state: &SlidingState| {
            place = place.min(self.nearest_to_base(push, state.push));
            push = state.push;
            let tip_limit = state.place(self.pole, self.turned(push));
            let sliding = if tip_limit > place - SAME_PLACE && state.toward == Some(Sliding::Tip) {
                Sliding::Tip
            } else if self.place(push) < place + SAME_PLACE {
                Sliding::Base
            } else {
                Sliding::Sticks
            };
            place = place.max(tip_limit);
            sliding
        };
        states.iter().map(sliding).collect()
    }

    /// The knots before and after `push`, if it is not beyond the last one.
    fn around(&self, push: f64) -> Option<[Knot; 2]> {
        let after = self.knots.partition_point(|knot| knot.push <= push);
        let after = after.clamp(1, self.knots.len() - 1);
        let around = [self.knots[after - 1], self.knots[after]];
        (push <= around[1].push).then_some(around)
    }

    /// The place at `push`; infinitely far beyond the end.
    fn place(&self, push: f64) -> f64 {
        let around = self.around(push);
        around.map_or(f64::INFINITY, |around| Cubic::through(around).at(push))
    }

    /// `psi` about there.
    fn turned(&self, push: f64) -> f64 {
        let last = self.knots[self.knots.len() - 1].turned;
        self.around(push).map_or(last, |[before, _]| before.turned)
    }

    /// The place nearest to the base between two pushes.
    fn nearest_to_base(&self, from: f64, to: f64) -> f64 {
        let mut nearest = self.place(from).min(self.place(to));
        for pair in self.knots.windows(2) {
            if pair[1].push < from || pair[0].push > to {
                continue;
            }
            let cubic = Cubic::through([pair[0], pair[1]]);
            let turns = cubic.turns();
            let pushes = turns.into_iter().flatten().chain([pair[0].push]);
            for push in pushes.filter(|push| (from..=to).contains(push)) {
                nearest = nearest.min(cubic.at(push));
            }
        }
        nearest
    }
}

/// The row of `level` with friction that points toward the base.
fn opposed(level: &LevelCurve) -> LevelCurve {
    let rod = Rod {
        friction: -level.rod.friction,
        ..level.rod.clone()
    };
    LevelCurve::new(level.method, &rod, level.side, &level.row)
}

/// A cubic between two knots, by the part of the way.
struct Cubic {
    from: f64,
    width: f64,
    powers: [f64; 4],
}

impl Cubic {
    /// With the slopes of the knots; a line where one of them, at a fold, has none.
    fn through([from, to]: [Knot; 2]) -> Self {
        let width = to.push - from.push;
        let secant = to.place - from.place;
        let [a, b] = [from, to].map(|knot| knot.by_push * width - secant);
        let bent = if (a + b).is_finite() {
            [a, -2.0 * a - b, a + b]
        } else {
            [0.0; 3]
        };
        Self {
            from: from.push,
            width,
            powers: [from.place, secant + bent[0], bent[1], bent[2]],
        }
    }

    fn at(&self, push: f64) -> f64 {
        let part = (push - self.from) / self.width;
        let [c0, c1, c2, c3] = self.powers;
        part.mul_add(part.mul_add(part.mul_add(c3, c2), c1), c0)
    }

    /// The pushes at which it turns, between its knots.
    fn turns(&self) -> [Option<f64>; 2] {
        let [_, c1, c2, c3] = self.powers;
        let root = c2.mul_add(c2, -3.0 * c1 * c3).sqrt();
        // One of the two by division, so that neither cancels.
        let q = -(c2 + root.copysign(c2));
        [q / (3.0 * c3), c1 / q].map(|part| {
            let is_within = (0.0..=1.0).contains(&part);
            is_within.then_some(part.mul_add(self.width, self.from))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_turns_where_its_slope_is_none() {
        // (x - 1)^2 (x + 2) turns at 1 and -1.
        let knot = |push: f64| Knot {
            push,
            place: (push - 1.0) * (push - 1.0) * (push + 2.0),
            by_push: 3.0 * push * push - 3.0,
            turned: 0.0,
        };
        let turns = |from, to| {
            let mut turns: Vec<f64> = Cubic::through([knot(from), knot(to)])
                .turns()
                .into_iter()
                .flatten()
                .collect();
            turns.sort_by(f64::total_cmp);
            turns
        };
        let near = |found: Vec<f64>, wanted: &[f64]| {
            found.len() == wanted.len()
                && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        assert!(near(turns(-2.0, 2.0), &[-1.0, 1.0]));
        assert!(near(turns(0.0, 1.5), &[1.0]));
        assert!(near(turns(-0.5, 0.5), &[]));
    }
}
