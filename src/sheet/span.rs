//! Row spans: stable pieces of a row as polynomials of the row parameter `w = |load| tau^2`.
//!
//! Along a stable row, `w` grows from first touch to the end of the row. Push angle and contact are analytic in `w`, even at the fold,
//! where the push angle is flat. So a few states along the row represent the span. To find a cell, solve `push(w)` for `w`; its contact
//! is `tau(w)`, and its load `w/tau^2`.

use crate::numerics::divided_differences::through_nodes;
use crate::numerics::newton_form::{Polynomial, RootProblem, stencil};
use crate::numerics::newton_form_simd::{SimdRoots, Terms};
use crate::numerics::{Bracket, WIDTH};

/// Start of Newton's method for one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// Contact coordinate `tau`.
    pub tau: f64,
    /// Signed load `f/rho^2`.
    pub load: f64,
}

/// State of a span: an interpolation node.
#[derive(Clone, Copy, Debug)]
pub struct SpanNode {
    /// Row parameter `|load| tau^2`.
    pub w: f64,
    /// Push angle since first touch, in radians: a magnitude on the row's side.
    pub push: f64,
    /// Contact coordinate `tau`.
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

/// Stable piece of a row, between two ends.
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

/// Newton step toward the `w` of a cell, in parts of the largest `w`, after which the iteration stops. The remaining error is its square,
/// which is less than the interpolation error.
const LAST_SPAN_STEP: f64 = 1e-5;

impl RowSpan {
    /// Creates the span through the states of a continuation, by growing push angle. Returns `None` if `w` turns back.
    pub fn through(sign: f64, nodes: Vec<SpanNode>) -> Option<Self> {
        let is_ordered = |pair: &[SpanNode]| pair[0].push < pair[1].push;
        let grows = |pair: &[SpanNode]| pair[0].w < pair[1].w;
        let is_monotone = nodes.windows(2).all(|pair| is_ordered(pair) && grows(pair))
            || nodes
                .windows(2)
                .all(|pair| is_ordered(pair) && !grows(pair));
        (is_monotone && nodes.len() > 1).then(|| Self::new(sign, nodes, 0.0))
    }

    /// Creates the span through states of a lattice.
    ///
    /// A row leaves the lattice between two loads. Where the states end before first touch or before the fold, the span is extended to
    /// the row parameters of the next load, `beyond`, unless the push angle turns in between.
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
        let nodes = &self.nodes[from..self.nodes.len().min(from + N)];
        let numbers = |number: fn(&SpanNode) -> f64| {
            let mut numbers = [0.0; WIDTH];
            for (slot, node) in numbers.iter_mut().zip(nodes) {
                *slot = number(node);
            }
            numbers
        };
        let [w, push, tau] = [
            numbers(|node| node.w),
            numbers(|node| node.push),
            numbers(|node| node.tau),
        ];
        let count = nodes.len();
        through_nodes(&w[..count], [&push[..count], &tau[..count]])
    }

    /// Returns the polynomials around the interval after the node `i`.
    fn around(&self, i: usize) -> [Polynomial<AROUND>; 2] {
        self.polynomials(stencil(i, AROUND, self.nodes.len()))
    }

    /// Returns true if the span begins at first touch, where the load is 0.
    pub fn begins_at_touch(&self) -> bool {
        self.nodes.first().is_some_and(|node| node.w == 0.0)
    }

    /// Returns `[push angle in radians, tau]` at the row parameter `w`.
    pub fn at(&self, w: f64) -> [f64; 2] {
        let is_before = |node: &SpanNode| node.w <= w;
        let after = match self.nodes.first().zip(self.nodes.last()) {
            Some((first, last)) if first.w > last.w => {
                self.nodes.partition_point(|n| !is_before(n))
            }
            _ => self.nodes.partition_point(is_before),
        };
        let before = after.saturating_sub(1);
        if self.nodes.len() == WIDTH {
            self.polynomials::<WIDTH>(0)
                .map(|polynomial| polynomial.at(w).0)
        } else {
            self.around(before).map(|polynomial| polynomial.at(w).0)
        }
    }

    /// Returns one guess for each of the growing push angles (magnitudes, in radians). An entry is `None` outside the span.
    pub fn guesses(&self, pushes: impl Iterator<Item = f64>) -> Vec<Option<Guess>> {
        let mut guesses = Vec::with_capacity(pushes.size_hint().0);
        if self.ends.len() < 2 {
            guesses.extend(pushes.map(|_| None));
            return guesses;
        }
        let mut cells = SpanCells::new(self);
        let mut i = 0;
        for push in pushes {
            while i + 2 < self.ends.len() && push > self.ends[i + 1].push {
                i += 1;
            }
            let index = guesses.len();
            guesses.push(None);
            if let Some(problem) = self.problem(i, push) {
                cells.add(index, i, problem, &mut guesses);
            }
        }
        cells.solve(&mut guesses);
        guesses
    }

    /// Returns the root-finding problem for `push` between the end `i` and the next one, or `None` if `push` is not near them.
    fn problem(&self, i: usize, push: f64) -> Option<RootProblem> {
        let [low, high] = [self.ends[i], self.ends[i + 1]];
        if push < low.push - self.margin || push > high.push + self.margin {
            return None;
        }
        let target = push.max(low.push).min(high.push);
        let below = (self.largest_push - target).max(0.0).sqrt();
        let between = if high.below < low.below {
            (low.below - below) / (low.below - high.below)
        } else {
            1.0
        };
        Some(RootProblem {
            target,
            near: low.w + between * (high.w - low.w),
            bracket: Bracket::new([low.w, high.w], [low.push, high.push]),
        })
    }

    fn guess(&self, [tau, w]: [f64; 2]) -> Guess {
        Guess {
            tau,
            load: self.sign * w / (tau * tau),
        }
    }
}

/// Cells of a span whose row parameters are solved for side by side.
struct SpanCells<'a> {
    span: &'a RowSpan,
    last_step: f64,
    /// Polynomials through all nodes, if these are spaced like those of a lattice: one polynomial is then as accurate at its ends as in
    /// its middle.
    whole: Option<[Polynomial<WIDTH>; 2]>,
    /// Indices of the queued cells; `problems` are their root-finding problems.
    indices: Vec<usize>,
    problems: Vec<RootProblem>,
    /// The polynomials used last, and their first node.
    around: Option<([Polynomial<AROUND>; 2], usize)>,
}

impl<'a> SpanCells<'a> {
    fn new(span: &'a RowSpan) -> Self {
        let is_whole = span.nodes.len() == WIDTH;
        let largest = span.ends.iter().map(|end| end.w).fold(0.0, f64::max);
        Self {
            span,
            last_step: LAST_SPAN_STEP * largest,
            whole: is_whole.then(|| span.polynomials(0)),
            indices: Vec::with_capacity(WIDTH),
            problems: Vec::with_capacity(WIDTH),
            around: None,
        }
    }

    /// Adds the cell `index`, whose push angle is after the node `i`.
    fn add(&mut self, index: usize, i: usize, problem: RootProblem, guesses: &mut [Option<Guess>]) {
        if self.whole.is_some() {
            self.indices.push(index);
            self.problems.push(problem);
            if self.indices.len() == WIDTH {
                self.solve(guesses);
            }
            return;
        }
        let from = stencil(i, AROUND, self.span.nodes.len());
        let (polynomials, _) = match &self.around {
            Some(around) if around.1 == from => around,
            _ => self.around.insert((self.span.polynomials(from), from)),
        };
        let [push, tau] = polynomials;
        let w = push.solve(&problem, self.last_step);
        guesses[index] = Some(self.span.guess([tau.at(w).0, w]));
    }

    /// Solves for the queued cells.
    fn solve(&mut self, guesses: &mut [Option<Guess>]) {
        let Some([push, tau]) = &self.whole else {
            return;
        };
        // The function `w` in Newton's form.
        let mut identity = [0.0; WIDTH];
        (identity[0], identity[1]) = (push.nodes[0], 1.0);
        let roots = SimdRoots {
            nodes: &push.nodes,
            terms: Terms::Same(&push.differences),
            others: [&tau.differences, &identity].map(Terms::Same),
        };
        let [tau, w] = roots.solve(0, &self.problems, self.last_step);
        for (index, (tau, w)) in self.indices.iter().zip(tau.into_iter().zip(w)) {
            guesses[*index] = Some(self.span.guess([tau, w]));
        }
        self.indices.clear();
        self.problems.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::lobatto::{LOBATTO_COUNT, LOBATTO_NODES};
    use std::f64::consts::FRAC_PI_2;

    /// Returns a span through loads of a lattice from `first` on, where `w` is the load and `tau` a line.
    fn span(first: usize, pushes: &[f64]) -> RowSpan {
        let node = |(m, push): (usize, &f64)| SpanNode {
            w: LOBATTO_NODES[m],
            push: *push,
            tau: 0.5 + 0.1 * LOBATTO_NODES[m],
        };
        let nodes = (first..).zip(pushes).map(node).collect();
        let next = |m: Option<usize>| LOBATTO_NODES.get(m?).copied();
        let beyond = [next(first.checked_sub(1)), next(Some(first + pushes.len()))];
        RowSpan::on_lattice(1.0, nodes, beyond)
    }

    /// Returns `[w, tau]` of the guess at `push`.
    fn guess(span: &RowSpan, push: f64) -> Option<[f64; 2]> {
        let guess = span.guesses([push].into_iter())[0]?;
        Some([guess.load * guess.tau * guess.tau, guess.tau])
    }

    #[test]
    fn guesses_are_on_the_curve_up_to_its_summit() {
        // The push angle grows to 1 at the fold, where it is flat.
        let push = |load: f64| (FRAC_PI_2 * load).sin();
        let load = |push: f64| push.asin() / FRAC_PI_2;
        for (first, count) in [
            (0, LOBATTO_COUNT),
            (1, LOBATTO_COUNT - 1),
            (4, 12),
            (0, 9),
            (5, 4),
            (3, 2),
        ] {
            let pushes: Vec<f64> = LOBATTO_NODES[first..first + count]
                .iter()
                .map(|part| push(*part))
                .collect();
            let span = span(first, &pushes);
            // The span of a row that leaves the lattice extends one load beyond its nodes, with less accuracy.
            let error = if count == LOBATTO_COUNT {
                1e-6
            } else {
                1e-2 / count as f64
            };
            let ends = [
                first.saturating_sub(1),
                (first + count).min(LOBATTO_COUNT - 1),
            ];
            let [least, most] = ends.map(|m| push(LOBATTO_NODES[m]));
            for i in 0..=1000 {
                let push = 1e-3 * f64::from(i);
                let found = guess(&span, push);
                let slack = 0.02;
                if push > least + slack && push < most - slack || push == 1.0 && most == 1.0 {
                    assert!(found.is_some(), "{first} {count} {push}");
                } else if push < least - slack || push > most + slack {
                    assert_eq!(found, None, "{first} {count} {push}");
                }
                if let Some([found, tau]) = found {
                    let away = (found - load(push)).abs();
                    let flat = (1.0 - push).sqrt().max(0.03);
                    assert!(away * flat < error, "{first} {count} {push}: {found}");
                    assert!((tau - 0.5 - 0.1 * found).abs() < 1e-9, "{push}: {tau}");
                }
            }
        }
        let whole: Vec<f64> = LOBATTO_NODES.iter().map(|part| push(*part)).collect();
        let whole = span(0, &whole);
        let at_summit = guess(&whole, 1.0 + 0.5 * PUSH_MARGIN);
        assert!(at_summit.is_some_and(|[w, _]| (w - 1.0).abs() < 1e-4));
        assert_eq!(guess(&whole, 1.0 + 2.0 * PUSH_MARGIN), None);
        let all = whole.guesses((0..200).map(|i| f64::from(i) / 180.0));
        assert_eq!(all.iter().flatten().count(), 181);
    }

    #[test]
    fn few_nodes_and_falling_pushes_make_no_number_of_none() {
        let falling = [0.3, 0.29, 0.27, 0.24];
        let turning = [0.0, 0.1, 0.2, 0.15, 0.1, 0.3, 0.2, 0.1, 0.0, -0.1];
        let (constant, one, none) = ([0.1; 3], [0.1], []);
        let few: [&[f64]; 3] = [&falling[..2], &turning[..3], &one];
        for push in [&falling[..], &turning, &constant, &none]
            .into_iter()
            .chain(few)
        {
            for first in [0, 1, LOBATTO_COUNT - push.len()] {
                let pushes = (0..=400).map(|i| f64::from(i) / 1000.0);
                for guess in span(first, push).guesses(pushes).into_iter().flatten() {
                    assert!(push.len() > 1 && guess.tau.is_finite() && guess.load.is_finite());
                    assert!(guess.load != 0.0 || guess.tau == 0.5);
                }
            }
        }
    }
}
