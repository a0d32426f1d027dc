//! Guesses of a walked row: contact and load of a cell, interpolated between the nodes of the continuation.

use crate::rod::Side;
use crate::sheet::continuation::level_curve::Node;
use crate::sheet::lattice::guesses::Guess;
use glam::DVec2;

/// A piece of a row, from its least push angle to its greatest.
#[derive(Clone, Debug)]
pub struct WalkedPiece(Vec<Point>);

/// What is kept of a node.
#[derive(Clone, Copy, Debug)]
struct Point {
    /// Push angle since first touch, in radians, as a magnitude on the row's side.
    push: f64,
    /// `(tau, load)`.
    at: DVec2,
    /// Its derivative by the push angle; infinite at a fold.
    by_push: DVec2,
}

/// How far a slope may be from the secant, relative to it, for a cubic: next to a fold, whose slope is infinite, it is farther.
const SMOOTH: f64 = 1.0;

impl WalkedPiece {
    /// Between the `nodes`, along which the push angle grows or falls throughout.
    pub fn new(nodes: &[Node], side: Side) -> Self {
        let point = |node: &Node| Point {
            push: side.sign() * node.push,
            at: node.point,
            by_push: node.full.map.solve(DVec2::new(0.0, side.sign())),
        };
        let mut points: Vec<Point> = nodes.iter().map(point).collect();
        points.sort_by(|a, b| a.push.total_cmp(&b.push));
        Self(points)
    }

    /// The guess at `push`; `None` beyond the ends.
    pub fn guess(&self, push: f64) -> Option<Guess> {
        let after = self.0.partition_point(|point| point.push <= push);
        let last = self.0.last().filter(|last| last.push == push);
        let at = match (after.checked_sub(1).map(|i| self.0[i]), self.0.get(after)) {
            (Some(from), Some(to)) => between([from, *to], push),
            _ => last?.at,
        };
        Some(Guess {
            tau: at.x,
            load: at.y,
        })
    }
}

/// The cubic through two points with their slopes; next to a fold, where the push angle turns back, a parabola in the root of its
/// distance from there; a line where neither end has a slope to go by.
fn between([from, to]: [Point; 2], push: f64) -> DVec2 {
    let width = to.push - from.push;
    let part = (push - from.push) / width;
    let secant = to.at - from.at;
    let off = [from, to].map(|end| end.by_push * width - secant);
    let is_smooth = off.map(|off| off.abs().cmple(SMOOTH * secant.abs()).all());
    let line = from.at + part * secant;
    match is_smooth {
        [true, true] => {
            let left = 1.0 - part;
            line + part * left * (left * off[0] - part * off[1])
        }
        [true, false] => from_fold(&to, &from, 1.0 - part),
        [false, true] => from_fold(&from, &to, part),
        [false, false] => line,
    }
}

/// The parabola in the root of `part`, the way in push angle from a fold to `other` over all of it.
fn from_fold(fold: &Point, other: &Point, part: f64) -> DVec2 {
    let secant = other.at - fold.at;
    let slope = 2.0 * (other.push - fold.push) * other.by_push;
    let (root, bend) = (part.sqrt(), slope - secant);
    fold.at + root * (secant - bend + root * bend)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(push: f64, at: DVec2, by_push: DVec2) -> Point {
        Point { push, at, by_push }
    }

    #[test]
    fn a_cubic_is_found_again() {
        let cubic = |x: f64| DVec2::new(x * x * x, 1.0 - x * x);
        let slope = |x: f64| DVec2::new(3.0 * x * x, -2.0 * x);
        let ends = [1.0, 1.4].map(|push| point(push, cubic(push), slope(push)));
        for push in [1.0, 1.1, 1.3, 1.4] {
            assert!(between(ends, push).distance(cubic(push)) < 1e-15, "{push}");
        }
    }

    #[test]
    fn so_is_a_fold_at_either_end() {
        // By the root of the distance from the fold.
        let state = |root: f64| DVec2::new(1.0 + 0.3 * root - 0.1 * root * root, 2.0 - root);
        let slope = |root: f64| DVec2::new(0.3 - 0.2 * root, -1.0) / (2.0 * root);
        let fold = point(2.0, state(0.0), DVec2::INFINITY);
        for sign in [-1.0, 1.0] {
            let other = point(2.0 + sign * 0.04, state(0.2), sign * slope(0.2));
            let mut ends = [fold, other];
            ends.sort_by(|a, b| a.push.total_cmp(&b.push));
            for root in [0.0_f64, 0.05, 0.1, 0.2] {
                let at = between(ends, 2.0 + sign * root * root);
                assert!(at.distance(state(root)) < 1e-14, "{sign} {root}: {at}");
            }
        }
    }
}
