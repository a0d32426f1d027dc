//! Roots of polynomials in Newton's form, side by side in SIMD lanes.

use crate::numerics::newton_form::{Polynomial, RootProblem};
use crate::numerics::{Lanes, SimdTask, Unit, WIDTH};

/// Numbers of all SIMD lanes: `[lane]`.
pub type LaneNumbers = [f64; WIDTH];

/// Iterations of Newton's method. The last step of each lane shows if they suffice.
const ITERATIONS: usize = 3;

/// Divided differences of polynomials in Newton's form in all lanes.
#[derive(Clone, Copy, Debug)]
pub enum Terms<'a, const N: usize> {
    /// Divided differences of one polynomial for all lanes: `[term]`.
    Same(&'a [f64; N]),
    /// Divided differences of a polynomial for each lane: `[term][lane]`.
    Each(&'a [LaneNumbers; N]),
}

impl<const N: usize> Terms<'_, N> {
    /// The term `i` in the lanes from `from` on.
    #[inline(always)]
    fn term<T: Lanes>(&self, i: usize, from: usize) -> T {
        match self {
            Self::Same(terms) => T::of(terms[i]),
            Self::Each(terms) => pack(&terms[i], from),
        }
    }

    /// The value and the slope at `t`, in the lanes from `from` on.
    #[inline(always)]
    fn at<T: Lanes>(&self, nodes: &[f64; N], from: usize, t: T) -> (T, T) {
        let (mut value, mut slope): (T, T) = (self.term(N - 1, from), T::of(0.0));
        for i in (0..N - 1).rev() {
            let x = t - T::of(nodes[i]);
            slope = slope.mul_add(x, value);
            value = value.mul_add(x, self.term(i, from));
        }
        (value, slope)
    }
}

/// Polynomials on common nodes in SIMD lanes: one to solve, and `M` others to evaluate at its root.
#[derive(Clone, Copy, Debug)]
pub struct SimdRoots<'a, const N: usize, const M: usize> {
    /// Interpolation nodes of all polynomials: `[term]`.
    pub nodes: &'a [f64; N],
    /// Divided differences of the polynomial to solve, in all lanes.
    pub terms: Terms<'a, N>,
    /// Divided differences of the polynomials to evaluate at the root, in all lanes: `[other]`.
    pub others: [Terms<'a, N>; M],
}

impl<const N: usize, const M: usize> SimdRoots<'_, N, M> {
    /// Returns the values `[other][lane]` of the other polynomials at the roots of the `problems`, which belong to the lanes from `first`
    /// on. A root that a few iterations side by side do not find is solved alone.
    #[must_use]
    pub fn solve(
        &self,
        first: usize,
        problems: &[RootProblem],
        last_step: f64,
    ) -> [LaneNumbers; M] {
        let numbers = |number: fn(&RootProblem) -> f64| {
            let mut numbers = [0.0; WIDTH];
            for (slot, problem) in numbers[first..].iter_mut().zip(problems) {
                *slot = number(problem);
            }
            numbers
        };
        let Newton {
            place,
            step,
            mut others,
            ..
        } = Unit::detect().run(Newton {
            roots: self,
            targets: numbers(|problem| problem.target),
            place: numbers(|problem| problem.near),
            step: [0.0; WIDTH],
            others: [[0.0; WIDTH]; M],
        });
        for (lane, problem) in (first..).zip(problems) {
            if step[lane].abs() < last_step && problem.bracket.contains(place[lane]) {
                continue;
            }
            for (numbers, other) in others
                .iter_mut()
                .zip(self.solve_alone(lane, problem, last_step))
            {
                numbers[lane] = other;
            }
        }
        others
    }

    /// Returns the values `[other]` of the other polynomials at the root of one lane.
    #[must_use]
    pub fn solve_alone(&self, lane: usize, problem: &RootProblem, last_step: f64) -> [f64; M] {
        let polynomial = |terms: &Terms<N>| Polynomial {
            nodes: *self.nodes,
            differences: match terms {
                Terms::Same(terms) => **terms,
                Terms::Each(terms) => terms.map(|term| term[lane]),
            },
        };
        let place = polynomial(&self.terms).solve(problem, last_step);
        std::array::from_fn(|i| polynomial(&self.others[i]).at(place).0)
    }
}

/// Task and result of Newton's method side by side.
struct Newton<'a, const N: usize, const M: usize> {
    roots: &'a SimdRoots<'a, N, M>,
    targets: LaneNumbers,
    place: LaneNumbers,
    /// The last step in each lane.
    step: LaneNumbers,
    others: [LaneNumbers; M],
}

impl<const N: usize, const M: usize> SimdTask for Newton<'_, N, M> {
    type Output = Self;

    #[inline(always)]
    fn run<T: Lanes>(mut self) -> Self {
        let SimdRoots {
            nodes,
            terms,
            others,
        } = self.roots;
        for from in (0..WIDTH).step_by(T::LANES) {
            let target: T = pack(&self.targets, from);
            let (mut place, mut step): (T, T) = (pack(&self.place, from), T::of(0.0));
            for _ in 0..ITERATIONS {
                let (value, slope) = terms.at(nodes, from, place);
                step = (target - value) / slope;
                place = place + step;
            }
            keep(&mut self.place, from, place);
            keep(&mut self.step, from, step);
            for (numbers, other) in self.others.iter_mut().zip(others) {
                keep(numbers, from, other.at(nodes, from, place).0);
            }
        }
        self
    }
}

/// Returns lanes with the numbers of an array from the index `from` on.
#[inline(always)]
pub fn pack<T: Lanes>(numbers: &LaneNumbers, from: usize) -> T {
    let mut lanes = [0.0; WIDTH];
    // A constant length makes one load of the copy.
    lanes[..T::LANES].copy_from_slice(&numbers[from..from + T::LANES]);
    T::pack(lanes)
}

/// Stores lanes in an array of numbers, from index `from` on.
#[inline(always)]
pub fn keep<T: Lanes>(numbers: &mut LaneNumbers, from: usize, lanes: T) {
    numbers[from..from + T::LANES].copy_from_slice(&lanes.unpack()[..T::LANES]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Bracket;
    use crate::numerics::newton_form::through_nodes;

    const N: usize = 12;

    /// The polynomial through 0 at 0 to 3 at the last node, there level but for some.
    fn rising(lane: usize) -> Polynomial<N> {
        let power = 1.0 + (0.618 * lane as f64).fract() * 2.0;
        let value = |node: usize| 3.0 * (1.0 - (1.0 - node as f64 / (N - 1) as f64).powf(power));
        let [rising] = through_nodes((0..N).map(|node| (node as f64, [value(node)])));
        rising
    }

    /// With a polynomial for every lane and with one for all, on every unit; and from a place so far that most are solved alone.
    #[test]
    fn what_is_found_together_is_found_alone() {
        let each = [0, 1].map(|shift| {
            let lanes: [_; WIDTH] = std::array::from_fn(|lane| rising(lane + shift).differences);
            std::array::from_fn(|i| lanes.map(|terms| terms[i]))
        });
        let [same, other] = [1, WIDTH + 1].map(rising);
        for is_same in [false, true] {
            let terms = [Terms::Each(&each[0]), Terms::Same(&same.differences)];
            let roots = SimdRoots {
                nodes: &same.nodes,
                terms: terms[usize::from(is_same)],
                others: [Terms::Each(&each[1]), Terms::Same(&other.differences)],
            };
            let far: [RootProblem; WIDTH] = std::array::from_fn(|lane| RootProblem {
                target: 0.1 + 0.15 * lane as f64,
                near: 10.9,
                bracket: Bracket::new([0.0, (N - 1) as f64], [0.0, 3.0]),
            });
            let places: LaneNumbers = std::array::from_fn(|lane| {
                let polynomial = if is_same { same } else { rising(lane) };
                polynomial.solve(&far[lane], 1e-4)
            });
            for unit in Unit::all() {
                let newton = unit.run(Newton {
                    roots: &roots,
                    targets: far.map(|problem| problem.target),
                    place: places.map(|place| place + 0.1),
                    step: [1.0; WIDTH],
                    others: [[0.0; WIDTH]; 2],
                });
                for (lane, place) in places.into_iter().enumerate() {
                    assert!(newton.step[lane].abs() < 1e-4, "{unit} {lane}");
                    assert!((newton.place[lane] - place).abs() < 1e-6, "{unit} {lane}");
                }
                check(newton.others, &places);
            }
            check(roots.solve(0, &far, 1e-4), &places);
            let [_, last] = roots.solve(WIDTH - 1, &far[WIDTH - 1..], 1e-4);
            assert!((last[WIDTH - 1] - other.at(places[WIDTH - 1]).0).abs() < 1e-6);
        }
    }

    /// The other polynomials at `places`.
    fn check(others: [LaneNumbers; 2], places: &LaneNumbers) {
        for (lane, place) in places.iter().enumerate() {
            let wanted = [lane + 1, WIDTH + 1].map(|other| rising(other).at(*place).0);
            for (numbers, wanted) in others.iter().zip(wanted) {
                assert!((numbers[lane] - wanted).abs() < 1e-6, "{lane}");
            }
        }
    }
}
