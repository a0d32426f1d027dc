//! Interpolation by polynomials of degree 9, in Newton's form on evenly spaced samples.

/// Nodes of a polynomial.
pub const NODES: usize = 10;

/// The last step of Newton's method, in spacings: its square is left, and interpolation leaves more than that.
pub const LAST_STEP: f64 = 1e-4;

/// A polynomial through up to [`NODES`] values at `0, 1, 2, ...`.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial {
    /// Divided differences.
    differences: [f64; NODES],
}

impl Polynomial {
    /// Of these divided differences: the value at 0, the slope from 0 to 1, ...
    pub const fn of(differences: [f64; NODES]) -> Self {
        Self { differences }
    }

    /// Through `values[0]` at 0, `values[1]` at 1, ...; at most [`NODES`] of them count.
    pub fn through(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().take(NODES).collect();
        Self::through_each(&values)[0]
    }

    /// Through each [`NODES`] neighbours of `values`, or through all where there are fewer: the first one through `values[0]`
    /// at 0, the next one through `values[1]` at 0, ...
    pub fn through_each(values: &[f64]) -> Vec<Self> {
        let values: Vec<[f64; 1]> = values.iter().map(|value| [*value]).collect();
        let each = differences_of_each(&values).into_iter();
        each.map(|differences| Self::of(differences.map(|[difference]| difference)))
            .collect()
    }

    /// Divided differences: the value at 0, the slope from 0 to 1, ...
    #[must_use]
    pub const fn differences(&self) -> &[f64; NODES] {
        &self.differences
    }

    /// Value and slope at `t`.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> (f64, f64) {
        let (mut value, mut slope) = (self.differences[NODES - 1], 0.0);
        for i in (0..NODES - 1).rev() {
            let x = t - i as f64;
            slope = slope * x + value;
            value = value * x + self.differences[i];
        }
        (value, slope)
    }

    /// Where the polynomial is `target` in `between`, at whose ends it lies on different sides of it.
    #[must_use]
    pub fn solve(&self, target: f64, near: f64, between: [f64; 2]) -> f64 {
        bracketed(|t| self.at(t), target, near, between, LAST_STEP)
    }
}

/// Divided differences of `N` functions at once, through each [`NODES`] neighbours of their `values`, or through all where there
/// are fewer.
pub fn differences_of_each<const N: usize>(values: &[[f64; N]]) -> Vec<[[f64; N]; NODES]> {
    let runs = values.len().saturating_sub(NODES) + 1;
    let mut each = vec![[[0.0; N]; NODES]; runs];
    let mut differences = values.to_vec();
    for level in 0..NODES.min(values.len()) {
        if level > 0 {
            let part = 1.0 / level as f64;
            for i in 0..values.len() - level {
                let next = differences[i + 1];
                for (here, next) in differences[i].iter_mut().zip(next) {
                    *here = (next - *here) * part;
                }
            }
        }
        for (run, difference) in each.iter_mut().zip(&differences) {
            run[level] = *difference;
        }
    }
    each
}

/// Where a function with the value and slope `at` is `target` between `low` and `high`, at which it lies on different sides of
/// it: Newton's method from `near` down to `last_step`, bisecting where a step would leave the bracket.
pub fn bracketed(
    at: impl Fn(f64) -> (f64, f64),
    target: f64,
    near: f64,
    [mut low, mut high]: [f64; 2],
    last_step: f64,
) -> f64 {
    if low >= high {
        return low;
    }
    // At an end the value can be the target but for rounding, at both it cannot.
    let rising = at(low).0 < at(high).0;
    let inside = low < near && near < high;
    let mut t = if inside { near } else { 0.5 * (low + high) };
    for _ in 0..60 {
        let (value, slope) = at(t);
        if (value < target) == rising {
            low = t;
        } else {
            high = t;
        }
        let newton = t - (value - target) / slope;
        let inside = low < newton && newton < high;
        if inside && (newton - t).abs() < last_step {
            return newton;
        }
        let next = if inside { newton } else { 0.5 * (low + high) };
        if next == t {
            return next;
        }
        t = next;
    }
    t
}

/// The first of the [`NODES`] (or fewer) of `count` samples that surround the interval `at, at + 1`.
#[must_use]
pub fn stencil(at: usize, count: usize) -> usize {
    at.saturating_sub(NODES / 2 - 1)
        .min(count.saturating_sub(NODES))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet has six columns at least.
    #[test]
    fn runs_go_through_their_values() {
        for count in [1, 3, 6, 9, NODES, NODES + 5] {
            let samples: Vec<f64> = (0..count).map(|i| (0.3 * i as f64).sin()).collect();
            let runs = Polynomial::through_each(&samples);
            assert_eq!(runs.len(), count.saturating_sub(NODES) + 1);
            for (start, run) in runs.iter().enumerate() {
                for (t, sample) in samples[start..].iter().take(NODES).enumerate() {
                    assert!((run.at(t as f64).0 - sample).abs() < 1e-14, "{start} {t}");
                }
            }
        }
    }

    /// A target at a sample, as exactly as that is known: a row whose end is the resting tip has one.
    #[test]
    fn a_sample_is_found_where_it_is() {
        for slope in [1.0, -1.0] {
            let samples: Vec<f64> = (0..NODES)
                .map(|i| slope * (0.1 * i as f64 - 0.2).exp())
                .collect();
            let polynomial = Polynomial::through(samples.iter().copied());
            for (k, sample) in samples.iter().enumerate() {
                for target in [sample.next_down(), *sample, sample.next_up()] {
                    for low in [k.saturating_sub(1), k.min(NODES - 2)] {
                        let between = [low as f64, (low + 1) as f64];
                        let t = polynomial.solve(target, low as f64 + 0.3, between);
                        assert!((t - k as f64).abs() < 1e-6, "{t} instead of {k}");
                    }
                }
            }
        }
    }
}
