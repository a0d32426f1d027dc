//! Interpolating polynomials in Newton's form, through nodes at any places. A node may count twice, with a value
//! and a slope (Hermite interpolation): the derivatives that a trajectory carries replace other trajectories.

use crate::numerics::Bracket;

/// A polynomial with `N` terms in Newton's form.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial<const N: usize> {
    /// Interpolation nodes of the polynomial, `[term]`. The term `i` is zero at the nodes before the node `i`.
    pub nodes: [f64; N],
    /// Divided differences of the polynomial, `[term]`: the factors of its terms. They are 0 where there are fewer than `N` nodes.
    pub differences: [f64; N],
}

impl<const N: usize> Polynomial<N> {
    /// Creates the polynomial with these divided differences on the nodes 0, 1, ..., each repeated `each` times.
    #[must_use]
    pub const fn on_even_nodes(each: usize, differences: [f64; N]) -> Self {
        let mut nodes = [0.0; N];
        let mut i = 0;
        while i < N {
            nodes[i] = (i / each) as f64;
            i += 1;
        }
        Self { nodes, differences }
    }

    /// Returns the value and the slope of the polynomial at the argument `t`: `(value, slope)`.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> (f64, f64) {
        let (mut value, mut slope) = (self.differences[N - 1], 0.0);
        for i in (0..N - 1).rev() {
            let x = t - self.nodes[i];
            slope = slope * x + value;
            value = value * x + self.differences[i];
        }
        (value, slope)
    }

    /// Returns the argument at which the polynomial has the target value, by Newton's method, in the unit of the nodes. The last step is at most
    /// `last_step`; the error is about its square.
    #[must_use]
    pub fn solve(&self, problem: &RootProblem, last_step: f64) -> f64 {
        let RootProblem { target, near, bracket } = *problem;
        let start = if bracket.is_inside(near) { near } else { bracket.middle() };
        let iterate = |t| {
            let (value, slope) = self.at(t);
            (value - target, t - (value - target) / slope)
        };
        bracket.newton(start, |_| last_step, iterate).x
    }
}

/// A target value of a polynomial, and where the search for its argument starts.
#[derive(Clone, Copy, Debug, Default)]
pub struct RootProblem {
    /// Target value of the polynomial, in the unit of its values.
    pub target: f64,
    /// Argument at which the search starts, if the bracket contains it, in the unit of the nodes.
    pub near: f64,
    /// Two arguments of the polynomial between whose values the target lies.
    pub bracket: Bracket,
}

/// Returns the polynomials of `F` functions through at most `N` points `(node, values)` with growing nodes. The degree is less than the
/// number of points. Points after the first `N` are ignored.
///
/// ```
/// use whiskmap_mechanics::numerics::newton_form::through_nodes;
///
/// let [square] = through_nodes::<4, 1>([(0.0, [0.0]), (1.0, [1.0]), (3.0, [9.0])]);
/// assert_eq!(square.at(2.0), (4.0, 4.0)); // value and slope
/// ```
#[must_use]
#[inline]
pub fn through_nodes<const N: usize, const F: usize>(
    points: impl IntoIterator<Item = (f64, [f64; F])>,
) -> [Polynomial<N>; F] {
    let (mut nodes, mut values, mut terms) = ([0.0; N], [[0.0; F]; N], [[0.0; F]; N]);
    let mut count = 0;
    let slots = nodes.iter_mut().zip(&mut values);
    for ((node, values), point) in slots.zip(points) {
        (*node, *values) = point;
        count += 1;
    }
    let keep = |level: usize, differences: &[[f64; F]]| terms[level] = differences[0];
    divide(N, &nodes[..count], &mut values[..count], &[], keep);
    std::array::from_fn(|function| Polynomial {
        nodes,
        differences: terms.map(|term| term[function]),
    })
}

/// Returns divided differences `[start][term][function]` of `F` functions with `values[node][function]` at the nodes 0, 1, ...
///
/// The polynomials of `start` go through the nodes from `start` on: through `N` values or, with `slopes`, through `N / 2` values and
/// slopes. With fewer nodes there is one start.
#[must_use]
pub fn through_runs<const F: usize, const N: usize>(
    values: &[[f64; F]],
    slopes: &[[f64; F]],
) -> Vec<[[f64; F]; N]> {
    let each = if slopes.is_empty() { 1 } else { 2 };
    let repeated = || (0..each * values.len()).map(|i| i / each);
    let nodes: Vec<f64> = repeated().map(|i| i as f64).collect();
    let mut differences: Vec<[f64; F]> = repeated().map(|i| values[i]).collect();
    let mut runs = vec![[[0.0; F]; N]; values.len().saturating_sub(N / each) + 1];
    divide(N, &nodes, &mut differences, slopes, |level, differences| {
        for (run, difference) in runs.iter_mut().zip(differences.iter().step_by(each)) {
            run[level] = *difference;
        }
    });
    runs
}

/// Replaces `values` at growing `nodes` by divided differences, `levels` times at most. Calls `take` with each level, the values as level 0.
/// The difference at two equal nodes `2 i` and `2 i + 1` is `slopes[i]`. Without slopes it is not finite.
#[inline]
fn divide<const F: usize>(
    levels: usize,
    nodes: &[f64],
    values: &mut [[f64; F]],
    slopes: &[[f64; F]],
    mut take: impl FnMut(usize, &[[f64; F]]),
) {
    if nodes.is_empty() {
        return;
    }
    take(0, values);
    for level in 1..levels.min(nodes.len()) {
        let count = nodes.len() - level;
        for i in 0..count {
            let apart = nodes[i + level] - nodes[i];
            if apart == 0.0 && !slopes.is_empty() {
                values[i] = slopes[i / 2];
                continue;
            }
            let (part, next) = (1.0 / apart, values[i + 1]);
            for (here, next) in values[i].iter_mut().zip(next) {
                *here = (next - *here) * part;
            }
        }
        take(level, &values[..count]);
    }
}

/// Returns the first of the `around` nodes that surround the interval from `at` to `at + 1`, where there are `count` nodes in all.
#[must_use]
pub fn stencil(at: usize, around: usize, count: usize) -> usize {
    at.saturating_sub(around / 2 - 1).min(count.saturating_sub(around))
}
