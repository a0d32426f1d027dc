//! Row spans: stable pieces of a row as polynomials of the row parameter `w = |load| tau^2`.
//!
//! Along a stable row, `w` grows from first touch to the end of the row. Push angle and contact are analytic in `w`, even at the fold,
//! where the push angle is flat. So a few states along the row represent the span. To find a cell, solve `push(w)` for `w`; its contact
//! is `tau(w)`, and its load `w/tau^2`.

mod cells;

use crate::numerics::newton_form::{Polynomial, stencil, through_nodes};

/// Guess for one cell: the start of Newton's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// Contact coordinate `tau` of the guess, dimensionless.
    pub tau: f64,
    /// Signed load `f/rho^2` of the guess, dimensionless.
    pub load: f64,
}

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

/// End of an interval of push angles between two nodes.
#[derive(Clone, Copy, Debug)]
struct IntervalEnd {
    w: f64,
    push: f64,
    /// Square root of the difference between the largest push angle of the span and `push`. At the fold, `w` is linear in this root.
    below: f64,
}

/// Row span: a stable piece of a row between two ends, as polynomials of the row parameter.
#[derive(Clone, Debug)]
pub struct RowSpan {
    /// Sign of the loads: 1 or -1.
    sign: f64,
    /// States by growing push angle; `w` grows or falls throughout.
    nodes: Vec<SpanNode>,
    /// Ends of the intervals between the nodes.
    ends: Vec<IntervalEnd>,
    /// Largest push angle at `ends`, in radians.
    largest_push: f64,
    /// Distance beyond the ends, in radians, within which push angles still have a guess.
    margin: f64,
}

/// Number of nodes of a polynomial through unevenly spaced nodes.
const AROUND: usize = 7;

/// Distance beyond the detachment angle of a lattice, in radians, up to which cells get guesses. On most whiskers it is many times the
/// interpolation error; a row with a missed cell is followed by continuation.
pub const PUSH_MARGIN: f64 = 1e-4;

impl RowSpan {
    /// Creates the row span through the states of a continuation, by growing push angle. Returns `None` if `w` turns back.
    pub fn through(sign: f64, nodes: Vec<SpanNode>) -> Option<Self> {
        let is_ordered = |pair: &[SpanNode]| pair[0].push < pair[1].push;
        let grows = |pair: &[SpanNode]| pair[0].w < pair[1].w;
        let is_monotone = nodes.windows(2).all(|pair| is_ordered(pair) && grows(pair))
            || nodes
                .windows(2)
                .all(|pair| is_ordered(pair) && !grows(pair));
        (is_monotone && nodes.len() > 1).then(|| Self::new(sign, nodes, 0.0))
    }

    /// Creates the row span through states of a lattice.
    ///
    /// A row leaves the lattice between two loads. Where the states end before first touch or before the fold, the span is extended to
    /// the row parameters of the next load, `beyond`. It is not extended if the push angle turns in between.
    pub fn on_lattice(sign: f64, nodes: Vec<SpanNode>, beyond: [Option<f64>; 2]) -> Self {
        let mut span = Self::new(sign, nodes, PUSH_MARGIN);
        let count = span.ends.len();
        if count < 2 {
            return span;
        }
        for (w, i) in beyond.into_iter().zip([0, count - 1]) {
            let Some(w) = w else { continue };
            let push = span.around(i)[0].at(w).0;
            let is_farther = if i == 0 {
                push < span.nodes[i].push
            } else {
                push > span.nodes[i].push
            };
            if is_farther {
                (span.ends[i].w, span.ends[i].push) = (w, push);
            }
        }
        span.measure_below();
        span
    }

    fn new(sign: f64, nodes: Vec<SpanNode>, margin: f64) -> Self {
        let end = |node: &SpanNode| IntervalEnd {
            w: node.w,
            push: node.push,
            below: 0.0,
        };
        let mut span = Self {
            sign,
            ends: nodes.iter().map(end).collect(),
            nodes,
            largest_push: 0.0,
            margin,
        };
        span.measure_below();
        span
    }

    fn measure_below(&mut self) {
        let pushes = self.ends.iter().map(|end| end.push);
        let largest = pushes.fold(f64::NEG_INFINITY, f64::max);
        for end in &mut self.ends {
            end.below = (largest - end.push).max(0.0).sqrt();
        }
        self.largest_push = largest;
    }

    /// Returns the push angle and `tau` as polynomials of `w` through `N` nodes, from the node `from` on.
    fn polynomials<const N: usize>(&self, from: usize) -> [Polynomial<N>; 2] {
        let nodes = self.nodes[from..].iter();
        through_nodes(nodes.map(|node| (node.w, [node.push, node.tau])))
    }

    /// Returns the polynomials around the interval after the node `i`.
    fn around(&self, i: usize) -> [Polynomial<AROUND>; 2] {
        self.polynomials(stencil(i, AROUND, self.nodes.len()))
    }

    /// Returns the largest push angle that has a guess, in radians.
    pub fn last_push(&self) -> f64 {
        let ends = self.ends.first().into_iter().chain(self.ends.last());
        ends.map(|end| end.push).fold(f64::NEG_INFINITY, f64::max) + self.margin
    }
}
