//! Guesses for the cells of a span: each cell solves `push(w)` for `w`.

use super::{AROUND, Guess, RowSpan};
use crate::numerics::newton_form::{Polynomial, RootProblem, stencil};
use crate::numerics::newton_form_simd::{SimdRoots, Terms};
use crate::numerics::{Bracket, WIDTH};

/// Newton step toward the `w` of a cell, in parts of the largest `w`, after which the iteration stops. The remaining error is its square,
/// which is less than the interpolation error.
const LAST_SPAN_STEP: f64 = 1e-5;

impl RowSpan {
    /// Returns one guess for each of the growing push angles (magnitudes, in radians), `[push_angle]`. An entry is `None` outside the
    /// span.
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
    use super::super::{PUSH_MARGIN, SpanNode};
    use super::*;
    use crate::numerics::chebyshev::{CHEBYSHEV_COUNT, LOBATTO_NODES};
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
            (0, CHEBYSHEV_COUNT),
            (1, CHEBYSHEV_COUNT - 1),
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
            let error = if count == CHEBYSHEV_COUNT {
                1e-6
            } else {
                1e-2 / count as f64
            };
            let ends = [
                first.saturating_sub(1),
                (first + count).min(CHEBYSHEV_COUNT - 1),
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
            for first in [0, 1, CHEBYSHEV_COUNT - push.len()] {
                let pushes = (0..=400).map(|i| f64::from(i) / 1000.0);
                for guess in span(first, push).guesses(pushes).into_iter().flatten() {
                    assert!(push.len() > 1 && guess.tau.is_finite() && guess.load.is_finite());
                    assert!(guess.load != 0.0 || guess.tau == 0.5);
                }
            }
        }
    }
}
