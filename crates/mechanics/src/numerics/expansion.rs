//! Expansions in Chebyshev polynomials on `[0, 1]`, through values at Chebyshev points of the first kind.
//!
//! With `y = 2 x - 1`, `f(x) = c_0 + c_1 T_1(y) + ... + c_(N-1) T_(N-1)(y)` is the polynomial through `N` values. The coefficients of
//! an analytic function fall geometrically, and the error is about the first coefficient left out (L. N. Trefethen, *Approximation
//! Theory and Approximation Practice*, SIAM 2013, chapters 3 and 8). Clenshaw's recurrence evaluates it. On the interval it is as stable
//! as the barycentric formula (J.-P. Berrut and L. N. Trefethen, SIAM Review 46, 501, 2004), and gives derivatives, too.

use crate::numerics::{LaneNumbers, Lanes, Real, SimdTask, Unit, WIDTH, keep, pack};
use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;

/// The largest number of points of an expansion.
pub const MOST_POINTS: usize = 40;

/// Groups of coefficients in SIMD lanes.
const GROUPS: usize = MOST_POINTS.div_ceil(WIDTH);

/// Number of coefficients in a group of [`Chebyshev::tails`]: an odd or even function has every other coefficient 0.
pub const TAIL: usize = 3;

/// Points and transform for one number of points.
struct ChebyshevGrid {
    points: Vec<f64>,
    /// `[j][k / WIDTH][k % WIDTH]`: weight of the value at the point `j` in the coefficient `k`.
    transform: Vec<[LaneNumbers; GROUPS]>,
}

/// Grids of 1, 2, ... points, each computed at its first use.
static GRIDS: [OnceLock<ChebyshevGrid>; MOST_POINTS] = [const { OnceLock::new() }; MOST_POINTS];

impl ChebyshevGrid {
    fn of(count: usize) -> &'static Self {
        GRIDS[count - 1].get_or_init(|| Self::new(count))
    }

    fn new(count: usize) -> Self {
        // Angles are whole multiples of this part of a right angle, at most a full turn.
        let angle = |multiple: usize| FRAC_PI_2 * multiple as f64 / count as f64;
        let point = |j: usize| libm::sin(0.5 * angle(2 * j + 1)).powi(2);
        let weight = |j: usize, k: usize| {
            let cos = libm::cos(angle(k * (2 * j + 1) % (4 * count)));
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            let each = if k == 0 { 1.0 } else { 2.0 };
            sign * each * cos / count as f64
        };
        let known = |j, k| if k < count { weight(j, k) } else { 0.0 };
        let group = |j, from: usize| std::array::from_fn(|lane| known(j, from + lane));
        let row = |j| std::array::from_fn(|index| group(j, index * WIDTH));
        Self { points: (0..count).map(point).collect(), transform: (0..count).map(row).collect() }
    }
}

/// Returns the `count` Chebyshev points of the first kind on `[0, 1]`, growing: `sin^2((2 j + 1) pi/(4 count))`.
///
/// # Panics
///
/// If `count` is 0 or larger than [`MOST_POINTS`].
#[must_use]
pub fn chebyshev_points(count: usize) -> &'static [f64] {
    &ChebyshevGrid::of(count).points
}

/// Expansion of `D` functions on `[0, 1]` in Chebyshev polynomials.
#[derive(Clone, Debug, PartialEq)]
pub struct Chebyshev<const D: usize> {
    /// Coefficients `[k][function]` of the polynomials `T_k(2 x - 1)` of a Chebyshev expansion, in the units of the functions.
    pub coefficients: Vec<[f64; D]>,
}

impl<const D: usize> Chebyshev<D> {
    /// Creates the expansion through `values` `[point][function]` at the [`chebyshev_points`], one value for each point.
    ///
    /// # Panics
    ///
    /// If there are no values, or more than [`MOST_POINTS`].
    #[must_use]
    pub fn through(values: &[[f64; D]]) -> Self {
        let transform = &ChebyshevGrid::of(values.len()).transform;
        let coefficients = Unit::detect().run(Transform { values, transform });
        Self { coefficients }
    }

    /// Returns the sizes of the last coefficients of each function, the largest of the last [`TAIL`] and of as many before: `[group][function]`. The
    /// last ones estimate the expansion's error where coefficients still fall; the ratio of both is the rate at which they fall. A single point gives
    /// 0. NaN for a function with a coefficient that is.
    #[must_use]
    pub fn tails(&self) -> [[f64; D]; 2] {
        let mut tails = [[0.0_f64; D]; 2];
        let last = self.coefficients.iter().skip(1).rev().take(2 * TAIL);
        for (i, coefficients) in last.enumerate() {
            for (tail, coefficient) in tails[i / TAIL].iter_mut().zip(coefficients) {
                let size = coefficient.abs();
                if !(tail.is_nan() || *tail >= size) {
                    *tail = size;
                }
            }
        }
        tails
    }

    /// Returns the values `[function]` of an expansion at `x` in `[0, 1]`.
    #[must_use]
    pub fn at(&self, x: f64) -> [f64; D] {
        self.values(0, x)
    }

    /// Returns the derivative of one `function` of the expansion by `x`, at `x` in `[0, 1]`.
    #[must_use]
    pub fn slope(&self, function: usize, x: f64) -> f64 {
        let [_, slope] = self.series(function, x);
        slope
    }

    /// Returns the values at `end` and the expansion of the quotient `(f(x) - f(end))/(x - end)`: its coefficients are Clenshaw's sums at `end`.
    #[must_use]
    pub fn quotient(&self, end: f64) -> ([f64; D], Self) {
        let y = 2.0 * end - 1.0;
        let mut coefficients = vec![[0.0; D]; self.coefficients.len().max(2) - 1];
        let (mut later, mut latest) = ([0.0; D], [0.0; D]);
        for (power, terms) in self.coefficients.iter().enumerate().rev() {
            let factor = if power == 0 { y } else { y + y };
            for (i, term) in terms.iter().enumerate() {
                let sum = factor * later[i] + (term - latest[i]);
                latest[i] = later[i];
                later[i] = sum;
            }
            if power > 0 {
                // `x - end` is half of the change of `y`.
                let twice = if power == 1 { 2.0 } else { 4.0 };
                coefficients[power - 1] = later.map(|sum| twice * sum);
            }
        }
        (later, Self { coefficients })
    }

    /// Values of up to `N` functions from `first` on at `x`, by Clenshaw's recurrence; 0 beyond the last function.
    #[inline(always)]
    pub(super) fn values<T: Real, const N: usize>(&self, first: usize, x: T) -> [T; N] {
        let y = T::of(2.0).mul_add(x, T::of(-1.0));
        let (mut later, mut latest) = ([T::of(0.0); N], [T::of(0.0); N]);
        for (power, coefficients) in self.coefficients.iter().enumerate().rev() {
            let factor = if power == 0 { y } else { y + y };
            for i in 0..N.min(D - first) {
                let rest = T::of(coefficients[first + i]) - latest[i];
                latest[i] = later[i];
                later[i] = factor.mul_add(latest[i], rest);
            }
        }
        later
    }

    /// Returns the Taylor coefficients `[power]` of one function of an expansion around `x`, by Clenshaw's recurrence with truncated
    /// power series in place of numbers.
    #[inline(always)]
    pub(super) fn series<T: Real, const P: usize>(&self, function: usize, x: T) -> [T; P] {
        let (zero, two) = (T::of(0.0), T::of(2.0));
        let y = two.mul_add(x, T::of(-1.0));
        let (mut later, mut latest) = ([zero; P], [zero; P]);
        // `factor y b + c - d`, where `y` grows by twice the distance from `x`.
        let combine = |factor: T, b: [T; P], c: f64, d: [T; P]| {
            let mut sum = [zero; P];
            for power in (0..P).rev() {
                let rest = if power == 0 {
                    T::of(c) - d[0]
                } else {
                    (two * factor).mul_add(b[power - 1], -d[power])
                };
                sum[power] = (factor * y).mul_add(b[power], rest);
            }
            sum
        };
        for coefficients in self.coefficients.iter().skip(1).rev() {
            let sum = combine(two, later, coefficients[function], latest);
            (later, latest) = (sum, later);
        }
        let constant = self.coefficients.first().map_or(0.0, |first| first[function]);
        combine(T::of(1.0), later, constant, latest)
    }
}

/// Functions that are transformed together: as many as registers hold.
const TOGETHER: usize = 4;

/// Coefficients from values, side by side in SIMD lanes.
struct Transform<'a, const D: usize> {
    values: &'a [[f64; D]],
    transform: &'a [[LaneNumbers; GROUPS]],
}

impl<const D: usize> SimdTask for Transform<'_, D> {
    type Output = Vec<[f64; D]>;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Vec<[f64; D]> {
        let count = self.values.len();
        let mut coefficients = vec![[0.0; D]; count];
        for (group, into) in coefficients.chunks_mut(WIDTH).enumerate() {
            for first in (0..D).step_by(TOGETHER) {
                // Parts of the group in lanes, as many as there are.
                let mut sums = [[T::of(0.0); WIDTH]; TOGETHER];
                for (values, weights) in self.values.iter().zip(self.transform) {
                    for (part, from) in (0..WIDTH).step_by(T::LANES).enumerate() {
                        let weight: T = pack(&weights[group], from);
                        for (sums, value) in sums.iter_mut().zip(&values[first..]) {
                            sums[part] = T::of(*value).mul_add(weight, sums[part]);
                        }
                    }
                }
                for (i, sums) in sums.iter().enumerate().take(D - first) {
                    let mut unpacked = [0.0; WIDTH];
                    for (sum, from) in sums.iter().zip((0..WIDTH).step_by(T::LANES)) {
                        keep(&mut unpacked, from, *sum);
                    }
                    for (coefficients, coefficient) in into.iter_mut().zip(unpacked) {
                        coefficients[first + i] = coefficient;
                    }
                }
            }
        }
        coefficients
    }
}
