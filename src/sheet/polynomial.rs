//! Interpolation by polynomials of degree 7: in Newton's form on evenly spaced samples, else barycentric.

/// Nodes of a polynomial.
pub const NODES: usize = 8;

/// How well a place on a polynomial is known, in its spacings: interpolation leaves more than that.
const ENOUGH: f64 = 1e-9;

/// A polynomial through up to [`NODES`] values at `0, 1, 2, ...`.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial {
    /// Divided differences.
    differences: [f64; NODES],
}

impl Polynomial {
    /// Through `values[0]` at 0, `values[1]` at 1, ...; at most [`NODES`] of them count.
    pub fn through(values: impl IntoIterator<Item = f64>) -> Self {
        let mut differences = [0.0; NODES];
        let mut n = 0;
        for (slot, value) in differences.iter_mut().zip(values) {
            *slot = value;
            n += 1;
        }
        for level in 1..n {
            for i in (level..n).rev() {
                differences[i] = (differences[i] - differences[i - 1]) / level as f64;
            }
        }
        Self { differences }
    }

    /// Value and slope at `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> (f64, f64) {
        let (mut value, mut slope) = (self.differences[NODES - 1], 0.0);
        for i in (0..NODES - 1).rev() {
            let x = t - i as f64;
            slope = slope * x + value;
            value = value * x + self.differences[i];
        }
        (value, slope)
    }

    /// Where the polynomial is `target` between `low` and `high`, at which it lies on different sides of it:
    /// Newton's method from `near`, bisecting where a step would leave the bracket.
    #[must_use]
    pub fn solve(&self, target: f64, near: f64, mut low: f64, mut high: f64) -> f64 {
        let rising = self.at(high).0 > self.at(low).0;
        let mut t = near;
        for _ in 0..60 {
            let (value, slope) = self.at(t);
            if (value < target) == rising {
                low = t;
            } else {
                high = t;
            }
            let newton = t - (value - target) / slope;
            let next = if newton > low.min(high) && newton < low.max(high) {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - t).abs() < ENOUGH {
                return next;
            }
            t = next;
        }
        t
    }
}

/// The first of the [`NODES`] (or fewer) samples among `from..to` that surround the interval `at, at + 1`.
#[must_use]
pub fn stencil(at: usize, from: usize, to: usize) -> usize {
    let last = to.saturating_sub(NODES).max(from);
    at.saturating_sub(NODES / 2 - 1).clamp(from, last)
}

/// Places of samples, in growing or falling order, that polynomials go through.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    places: [f64; NODES],
    weights: [f64; NODES],
}

impl Places {
    /// `None` where the order changes, or for other than [`NODES`] places.
    pub fn new(places: impl IntoIterator<Item = f64>) -> Option<Self> {
        let places: Vec<f64> = places.into_iter().collect();
        let places: [f64; NODES] = places.try_into().ok()?;
        let rising = places[1] > places[0];
        let in_order = |pair: &[f64]| {
            if rising {
                pair[0] < pair[1]
            } else {
                pair[0] > pair[1]
            }
        };
        let weight = |i: usize| {
            let others = (0..NODES).filter(|j| *j != i);
            1.0 / others.map(|j| places[i] - places[j]).product::<f64>()
        };
        places.windows(2).all(in_order).then(|| Self {
            weights: std::array::from_fn(weight),
            places,
        })
    }

    /// By how much each sample counts `at` a place.
    #[must_use]
    pub fn shares(&self, at: f64) -> [f64; NODES] {
        let mut shares = [0.0; NODES];
        let mut sum = 0.0;
        for ((share, place), weight) in shares.iter_mut().zip(self.places).zip(self.weights) {
            if at == place {
                let hit = |other: f64| if other == place { 1.0 } else { 0.0 };
                return self.places.map(hit);
            }
            *share = weight / (at - place);
            sum += *share;
        }
        shares.map(|share| share / sum)
    }
}
