//! Interpolating polynomials in Newton's form. A node may count twice, with a value and a slope (Hermite interpolation), so that
//! what a trajectory tells about its neighbours is not computed again.

use crate::numerics::Bracket;

/// A polynomial with `N` terms.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial<const N: usize> {
    /// Where it interpolates. The term `i` is zero at the nodes before the node `i`.
    pub nodes: [f64; N],
    /// Divided differences, the factors of the terms; 0 where there are fewer than `N` nodes.
    pub differences: [f64; N],
}

impl<const N: usize> Polynomial<N> {
    /// Through `values[0]` at 0, `values[1]` at 1, ...; at most `N` of them count.
    #[must_use]
    pub fn through(values: &[f64]) -> Self {
        let values: Vec<[f64; 1]> = values.iter().map(|value| [*value]).collect();
        Self {
            nodes: even_nodes(1),
            differences: through_values(&values)[0].map(|[difference]| difference),
        }
    }

    /// Value and slope at `t`.
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

    /// The root by Newton's method. Its last step is at most `last_step`: the square is left.
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

/// Where a function is asked to be `target`.
#[derive(Clone, Copy, Debug, Default)]
pub struct RootProblem {
    /// The value.
    pub target: f64,
    /// Where to start, if it is inside the bracket.
    pub near: f64,
    /// Two places with the target between their values.
    pub bracket: Bracket,
}

/// The nodes 0, 1, ..., of which each counts `each` times.
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

/// Divided differences of `F` functions at once, known by `values` at the nodes 0, 1, ...: the first ones belong to the polynomials
/// through the `N` nodes from 0 on, the next ones to those from 1 on, ... Where there are fewer nodes, one goes through all.
#[must_use]
pub fn through_values<const F: usize, const N: usize>(values: &[[f64; F]]) -> Vec<[[f64; F]; N]> {
    divided_differences(1, values, &[])
}

/// The same through `values` and `slopes` at each `N / 2` nodes.
#[must_use]
pub fn through_slopes<const F: usize, const N: usize>(
    values: &[[f64; F]],
    slopes: &[[f64; F]],
) -> Vec<[[f64; F]; N]> {
    divided_differences(2, values, slopes)
}

/// The same with `each` terms for every node.
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

/// The first of the `around` (or fewer) of `count` nodes that surround the interval `at, at + 1`.
#[must_use]
pub fn stencil(at: usize, around: usize, count: usize) -> usize {
    at.saturating_sub(around / 2 - 1)
        .min(count.saturating_sub(around))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Through their values, and where they are known through their slopes.
    #[test]
    fn runs_go_through_their_samples() {
        let f = |t: usize| (0.3 * t as f64).sin();
        let slope = |t: usize| 0.3 * (0.3 * t as f64).cos();
        for count in [1, 3, 4, 5, 6, 9, 15] {
            let values: Vec<[f64; 1]> = (0..count).map(|t| [f(t)]).collect();
            let slopes: Vec<[f64; 1]> = (0..count).map(|t| [slope(t)]).collect();
            let plain = through_values::<1, 6>(&values);
            let slanted = through_slopes::<1, 12>(&values, &slopes);
            assert_eq!(plain.len(), count.saturating_sub(6) + 1);
            assert_eq!(slanted.len(), plain.len());
            for start in 0..plain.len() {
                let plain = Polynomial {
                    nodes: even_nodes(1),
                    differences: plain[start].map(|[difference]| difference),
                };
                let slanted = Polynomial {
                    nodes: even_nodes(2),
                    differences: slanted[start].map(|[difference]| difference),
                };
                for t in 0..count.min(6) {
                    let there = start + t;
                    assert!((plain.at(t as f64).0 - f(there)).abs() < 1e-14, "{there}");
                    let (value, by_t) = slanted.at(t as f64);
                    assert!((value - f(there)).abs() < 1e-14, "{there}");
                    assert!((by_t - slope(there)).abs() < 1e-13, "{there}");
                }
            }
        }
    }

    /// A target at a sample, as exactly as that is known: a row whose end is the resting tip has one.
    #[test]
    fn a_sample_is_found_where_it_is() {
        const COUNT: usize = 10;
        for sign in [1.0, -1.0] {
            let samples: Vec<f64> = (0..COUNT)
                .map(|i| sign * (0.1 * i as f64 - 0.2).exp())
                .collect();
            let polynomial = Polynomial::<COUNT>::through(&samples);
            for (k, sample) in samples.iter().enumerate() {
                for target in [sample.next_down(), *sample, sample.next_up()] {
                    for low in [k.saturating_sub(1), k.min(COUNT - 2)] {
                        let ends = [low as f64, (low + 1) as f64];
                        let problem = RootProblem {
                            target,
                            near: low as f64 + 0.3,
                            bracket: Bracket::new(ends, [samples[low], samples[low + 1]]),
                        };
                        let t = polynomial.solve(&problem, 1e-4);
                        assert!((t - k as f64).abs() < 1e-6, "{t} instead of {k}");
                    }
                }
            }
        }
    }
}
