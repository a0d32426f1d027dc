//! Interpolating polynomials in Newton's form. A node may count twice, with a value and a slope (Hermite interpolation): the
//! derivatives that a trajectory carries replace other trajectories.

use crate::numerics::Bracket;

/// A polynomial with `N` terms in Newton's form.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial<const N: usize> {
    /// Interpolation nodes. The term `i` is zero at the nodes before the node `i`.
    pub nodes: [f64; N],
    /// Divided differences: the factors of the terms. They are 0 where there are fewer than `N` nodes.
    pub differences: [f64; N],
}

impl<const N: usize> Polynomial<N> {
    /// The polynomial through `values[0]` at 0, `values[1]` at 1, ... Values after the first `N` are ignored.
    #[must_use]
    pub fn through(values: &[f64]) -> Self {
        let values: Vec<[f64; 1]> = values.iter().map(|value| [*value]).collect();
        Self {
            nodes: even_nodes(1),
            differences: through_values(&values)[0].map(|[difference]| difference),
        }
    }

    /// The value and the slope at `t`.
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

    /// The place where the polynomial has the target value, by Newton's method. The last step is at most `last_step`; the error
    /// is about its square.
    #[must_use]
    pub fn solve(&self, problem: &RootProblem, last_step: f64) -> f64 {
        let RootProblem {
            target,
            near,
            bracket,
        } = *problem;
        let start = if bracket.is_inside(near) {
            near
        } else {
            bracket.middle()
        };
        let iterate = |t| {
            let (value, slope) = self.at(t);
            (value - target, t - (value - target) / slope)
        };
        bracket.newton(start, |_| last_step, iterate).x
    }
}

/// A target value of a polynomial, and where to search for it.
#[derive(Clone, Copy, Debug, Default)]
pub struct RootProblem {
    /// The value to reach.
    pub target: f64,
    /// Place to start from, if the bracket contains it.
    pub near: f64,
    /// Two places between whose values the target lies.
    pub bracket: Bracket,
}

/// The nodes 0, 1, ..., each repeated `each` times.
#[must_use]
pub const fn even_nodes<const N: usize>(each: usize) -> [f64; N] {
    let mut nodes = [0.0; N];
    let mut i = 0;
    while i < N {
        nodes[i] = (i / each) as f64;
        i += 1;
    }
    nodes
}

/// Divided differences `[start][term][function]` of `F` functions with `values[node][function]` at the nodes 0, 1, ... The
/// polynomials of `start` go through the `N` nodes from `start` on. With fewer than `N` nodes there is one start.
#[must_use]
pub fn through_values<const F: usize, const N: usize>(values: &[[f64; F]]) -> Vec<[[f64; F]; N]> {
    divided_differences(1, values, &[])
}

/// Divided differences as from [`through_values`], for polynomials through the `values` and `slopes` at `N / 2` nodes each.
#[must_use]
pub fn through_slopes<const F: usize, const N: usize>(
    values: &[[f64; F]],
    slopes: &[[f64; F]],
) -> Vec<[[f64; F]; N]> {
    divided_differences(2, values, slopes)
}

/// Divided differences with `each` terms for every node: 1 for values, 2 for values and slopes.
fn divided_differences<const F: usize, const N: usize>(
    each: usize,
    values: &[[f64; F]],
    slopes: &[[f64; F]],
) -> Vec<[[f64; F]; N]> {
    let terms = each * values.len();
    let mut runs = vec![[[0.0; F]; N]; values.len().saturating_sub(N / each) + 1];
    let mut differences: Vec<[f64; F]> = (0..terms).map(|i| values[i / each]).collect();
    for level in 0..N.min(terms) {
        if level > 0 {
            for i in 0..terms - level {
                let apart = (i + level) / each - i / each;
                if apart == 0 {
                    differences[i] = slopes[i / each];
                    continue;
                }
                let part = 1.0 / apart as f64;
                let next = differences[i + 1];
                for (here, next) in differences[i].iter_mut().zip(next) {
                    *here = (next - *here) * part;
                }
            }
        }
        for (run, difference) in runs.iter_mut().zip(differences.iter().step_by(each)) {
            run[level] = *difference;
        }
    }
    runs
}

/// The first of the `around` nodes that surround the interval from `at` to `at + 1`, where there are `count` nodes in all.
#[must_use]
pub fn stencil(at: usize, around: usize, count: usize) -> usize {
    at.saturating_sub(around / 2 - 1)
        .min(count.saturating_sub(around))
}
