//! Row spans: stable pieces of continued rows as polynomials of the row parameter `w = |load| tau^2`.
//!
//! Along a stable piece, `w` grows or falls throughout. Push angle and contact are analytic in `w`, even at the fold, where the push angle
//! is flat. So polynomials through the nodes of the continuation represent the piece. To find a cell, solve `push(w)` for `w`; its
//! contact is `tau(w)`, and its load `w/tau^2`.

use glam::DVec2;
use whiskmap_mechanics::numerics::Bracket;
use whiskmap_mechanics::numerics::newton_form::{Polynomial, RootProblem, stencil, through_nodes};

/// Node of a row span: a state through which its polynomials pass.
#[derive(Clone, Copy, Debug)]
pub struct SpanNode {
    /// Row parameter `|load| tau^2` of the span node, dimensionless.
    pub w: f64,
    /// Push angle of the span node since first touch, in radians: a magnitude on the row's side.
    pub push: f64,
    /// Contact coordinate `tau` of the span node, dimensionless.
    pub tau: f64,
}

/// Row span: a stable piece of a row between two ends, as polynomials of the row parameter.
#[derive(Clone, Debug)]
pub struct RowSpan {
    /// Sign of the loads: 1 or -1.
    sign: f64,
    /// States by growing push angle, at least two; `w` grows or falls throughout.
    nodes: Vec<SpanNode>,
}

/// Number of nodes of a polynomial.
const AROUND: usize = 7;

/// Newton step toward the `w` of a cell, in parts of the largest `w`, after which the iteration stops. The remaining error is its square,
/// which is less than the interpolation error.
const LAST_STEP: f64 = 1e-5;

impl RowSpan {
    /// Creates the row span through the states of a continuation, by growing push angle. Returns `None` if `w` turns back.
    pub fn through(sign: f64, nodes: Vec<SpanNode>) -> Option<Self> {
        let is_ordered = |pair: &[SpanNode]| pair[0].push < pair[1].push;
        let grows = |pair: &[SpanNode]| pair[0].w < pair[1].w;
        let is_monotone = nodes.windows(2).all(|pair| is_ordered(pair) && grows(pair))
            || nodes.windows(2).all(|pair| is_ordered(pair) && !grows(pair));
        (is_monotone && nodes.len() > 1).then_some(Self { sign, nodes })
    }

    /// Writes missing `guesses` `(tau, load)`, `[push_angle]`, for those of the growing `pushes` that are inside the span. Push angles are magnitudes in
    /// radians.
    pub fn write_guesses(&self, pushes: &[f64], guesses: &mut [Option<DVec2>]) {
        let [first, last] = [self.nodes[0].push, self.nodes[self.nodes.len() - 1].push];
        let largest = self.nodes.iter().map(|node| node.w).fold(0.0, f64::max);
        let from = pushes.partition_point(|push| *push < first);
        let inside = pushes.iter().zip(guesses).skip(from);
        let mut i = 0;
        let mut around: Option<([Polynomial<AROUND>; 2], usize)> = None;
        for (push, guess) in inside.take_while(|(push, _)| **push <= last) {
            while i + 2 < self.nodes.len() && *push > self.nodes[i + 1].push {
                i += 1;
            }
            let start = stencil(i, AROUND, self.nodes.len());
            let ([push_at, tau_at], _) = match &around {
                Some(known) if known.1 == start => known,
                _ => around.insert((self.polynomials(start), start)),
            };
            let w = push_at.solve(&self.problem(i, *push), LAST_STEP * largest);
            let (tau, _) = tau_at.at(w);
            guess.get_or_insert(DVec2::new(tau, self.sign * w / (tau * tau)));
        }
    }

    /// Returns the push angle and `tau` as polynomials of `w`, from the node `start` on.
    fn polynomials(&self, start: usize) -> [Polynomial<AROUND>; 2] {
        let nodes = self.nodes[start..].iter();
        through_nodes(nodes.map(|node| (node.w, [node.push, node.tau])))
    }

    /// Returns the root-finding problem for `push` between the node `i` and the next one. At a fold, `w` is linear in the square root of what
    /// is left to the largest push angle.
    fn problem(&self, i: usize, push: f64) -> RootProblem {
        let [low, high] = [self.nodes[i], self.nodes[i + 1]];
        let largest = self.nodes[self.nodes.len() - 1].push;
        let [from, here, to] = [low.push, push, high.push].map(|push| (largest - push).sqrt());
        RootProblem {
            target: push,
            near: low.w + (from - here) / (from - to) * (high.w - low.w),
            bracket: Bracket::new([low.w, high.w], [low.push, high.push]),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// A span over uneven `w`, along which the push angle grows to a flat top of 1 and `tau` is a line.
    fn span(count: u32, to: f64) -> RowSpan {
        let node = |i: u32| {
            let w = to * (f64::from(i) / f64::from(count)).powf(0.8);
            SpanNode { w, push: (FRAC_PI_2 * w).sin(), tau: 0.5 + 0.1 * w }
        };
        RowSpan::through(1.0, (0..=count).map(node).collect()).unwrap()
    }

    #[test]
    fn guesses_are_on_the_curve_up_to_its_top() {
        for (count, to, error) in [(20, 1.0, 1e-6), (8, 0.9, 1e-5), (3, 0.4, 1e-3)] {
            let span = span(count, to);
            let last = (FRAC_PI_2 * to).sin();
            let pushes: Vec<f64> = (0..=1000).map(|i| 1e-3 * f64::from(i)).collect();
            let mut guesses = vec![None; pushes.len()];
            span.write_guesses(&pushes, &mut guesses);
            for (push, guess) in pushes.iter().zip(guesses) {
                let Some(DVec2 { x: tau, y: load }) = guess else {
                    assert!(*push > last, "{push}");
                    continue;
                };
                let w = load * tau * tau;
                let off = (w - push.asin() / FRAC_PI_2).abs();
                let flat = (1.0 - push).sqrt().max(0.03);
                assert!(*push <= last && off * flat < error, "{count} {push}: {w}");
                assert!((tau - 0.5 - 0.1 * w).abs() < 1e-9, "{push}: {tau}");
            }
        }
    }

    #[test]
    fn a_parameter_that_turns_back_has_no_span() {
        let nodes = |turns: [f64; 4]| {
            let node = |(i, w): (usize, f64)| SpanNode { w, push: 0.1 * i as f64, tau: 1.0 };
            turns.into_iter().enumerate().map(node).collect()
        };
        let is_span = |turns: [f64; 4]| RowSpan::through(1.0, nodes(turns)).is_some();
        assert!(is_span([0.0, 0.1, 0.2, 0.3]) && is_span([0.3, 0.2, 0.1, 0.0]));
        assert!(!is_span([0.0, 0.1, 0.2, 0.15]));
    }
}
