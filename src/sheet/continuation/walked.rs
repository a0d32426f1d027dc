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

/// The cubic through two points with their slopes, or the straight line where the slopes are not those of a smooth curve.
fn between([from, to]: [Point; 2], push: f64) -> DVec2 {
    let width = to.push - from.push;
    let part = (push - from.push) / width;
    let secant = to.at - from.at;
    let off = [from, to].map(|end| end.by_push * width - secant);
    let is_smooth = off
        .iter()
        .all(|off| off.abs().cmple(SMOOTH * secant.abs()).all());
    let line = from.at + part * secant;
    if !is_smooth {
        return line;
    }
    let left = 1.0 - part;
    line + part * left * (left * off[0] - part * off[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_found_again_and_a_root_gives_a_line() {
        let cubic = |x: f64| DVec2::new(x * x * x, 1.0 - x * x);
        let slope = |x: f64| DVec2::new(3.0 * x * x, -2.0 * x);
        let point = |push: f64| Point {
            push,
            at: cubic(push),
            by_push: slope(push),
        };
        let at = between([point(1.0), point(1.4)], 1.1);
        assert!(at.distance(cubic(1.1)) < 1e-15, "{at}");
        let fold = Point {
            by_push: DVec2::INFINITY,
            ..point(1.4)
        };
        let line = point(1.0).at.lerp(fold.at, 0.25);
        assert!(between([point(1.0), fold], 1.1).distance(line) < 1e-15);
    }
}
