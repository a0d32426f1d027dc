//! Chebyshev expansions of functions of two variables on `[0, 1]^2`, and the lines on which one of the functions is constant.
//!
//! The expansions go through values on the tensor of [`chebyshev_points`] in both variables. A column of the tensor is the expansion in
//! `x` at one `y`. On a level line, each column is solved for `x`, side by side in SIMD lanes.
//!
//! [`chebyshev_points`]: crate::numerics::expansion::chebyshev_points

use crate::numerics::expansion::{Chebyshev, MOST_POINTS};
use crate::numerics::newton_form_simd::{LaneNumbers, keep, pack};
use crate::numerics::{Lanes, SimdTask, Unit, WIDTH};

/// Expansion of `D` functions of `(x, y)` on `[0, 1]^2`.
#[derive(Clone, Debug)]
pub struct ChebyshevTensor<const D: usize> {
    /// Coefficients of a tensor of Chebyshev polynomials, in the units of the functions: `[polynomial of x][polynomial of y][function]`.
    pub coefficients: Vec<Vec<[f64; D]>>,
}

impl<const D: usize> ChebyshevTensor<D> {
    /// Creates the expansion in `x` and `y` through `rows`: expansions in `y` at the Chebyshev points of `x`, all of one length.
    ///
    /// # Panics
    ///
    /// If there are no rows, or more than [`MOST_POINTS`].
    #[must_use]
    pub fn through(rows: &[Chebyshev<D>]) -> Self {
        let powers = 0..rows[0].coefficients.len();
        let in_x: Vec<Chebyshev<D>> = powers
            .map(|power| {
                let values: Vec<[f64; D]> =
                    rows.iter().map(|row| row.coefficients[power]).collect();
                Chebyshev::through(&values)
            })
            .collect();
        let of = |power: usize| {
            in_x.iter()
                .map(move |own| own.coefficients[power])
                .collect()
        };
        Self {
            coefficients: (0..rows.len()).map(of).collect(),
        }
    }

    /// Returns the sizes of the last coefficients of each function in `x`, and in `y`: `[variable][group][function]`. They are the
    /// [`Chebyshev::tails`] in one variable, summed over the polynomials of the other one.
    #[must_use]
    pub fn tails(&self) -> [[[f64; D]; 2]; 2] {
        let in_x = |power: usize| Chebyshev {
            coefficients: self
                .coefficients
                .iter()
                .map(|in_y| in_y.get(power).copied().unwrap_or([0.0; D]))
                .collect(),
        };
        let in_y = |terms: &Vec<[f64; D]>| Chebyshev {
            coefficients: terms.clone(),
        };
        let sum = |sum: [[f64; D]; 2], own: Chebyshev<D>| {
            let tails = own.tails();
            std::array::from_fn(|group| std::array::from_fn(|i| sum[group][i] + tails[group][i]))
        };
        let zero = [[0.0; D]; 2];
        let longest = self.coefficients.iter().map(Vec::len).max().unwrap_or(0);
        [
            (0..longest).map(in_x).fold(zero, sum),
            self.coefficients.iter().map(in_y).fold(zero, sum),
        ]
    }

    /// Removes coefficients for which `is_rounding` is true, from the last polynomial of `y` on, for each polynomial of `x`.
    pub fn shorten(&mut self, is_rounding: impl Fn(&[f64; D]) -> bool) {
        for in_y in &mut self.coefficients {
            while in_y.last().is_some_and(&is_rounding) {
                in_y.pop();
            }
        }
    }

    /// Returns the columns of the tensor at each `y` of `places`.
    ///
    /// # Panics
    ///
    /// If there are more places than [`MOST_POINTS`].
    #[must_use]
    pub fn columns(&self, places: &[f64]) -> TensorColumns<D> {
        assert!(places.len() <= MOST_POINTS, "too many columns");
        let unit = Unit::detect();
        let blocks = places.chunks(WIDTH).map(|places| {
            let mut at = [places[0]; WIDTH];
            at[..places.len()].copy_from_slice(places);
            let terms = unit.run(Contraction {
                coefficients: &self.coefficients,
                places: &at,
            });
            let starts = unit.run(Starts(&terms));
            ColumnBlock {
                count: places.len(),
                terms,
                starts,
            }
        });
        TensorColumns {
            blocks: blocks.collect(),
        }
    }
}

/// Coefficients of the columns at the places of a block.
struct Contraction<'a, const D: usize> {
    coefficients: &'a [Vec<[f64; D]>],
    places: &'a LaneNumbers,
}

impl<const D: usize> SimdTask for Contraction<'_, D> {
    type Output = Vec<[LaneNumbers; D]>;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let mut columns = vec![[[0.0; WIDTH]; D]; self.coefficients.len()];
        let counts = self.coefficients.iter().map(Vec::len);
        let count = counts.max().unwrap_or(0);
        for from in (0..WIDTH).step_by(T::LANES) {
            let y = T::of(2.0).mul_add(pack(self.places, from), T::of(-1.0));
            let mut polynomials = [T::of(1.0); MOST_POINTS];
            polynomials[1] = y;
            for i in 2..count {
                polynomials[i] = (y + y).mul_add(polynomials[i - 1], -polynomials[i - 2]);
            }
            for (column, in_y) in columns.iter_mut().zip(self.coefficients) {
                let mut sums = [T::of(0.0); D];
                for (terms, polynomial) in in_y.iter().zip(polynomials) {
                    for (sum, term) in sums.iter_mut().zip(terms) {
                        *sum = polynomial.mul_add(T::of(*term), *sum);
                    }
                }
                for (lanes, sum) in column.iter_mut().zip(sums) {
                    keep(lanes, from, sum);
                }
            }
        }
        columns
    }
}

/// Number of intervals between tabulated starts of a column. Linear interpolation leaves an error of 1e-3 or less; two steps then 1e-12,
/// and three rounding.
const INTERVALS: usize = 16;

/// Number of Newton steps from an interpolated start.
const STEPS: usize = 3;

/// Largest difference of the first function from its level at a root, in its unit.
const ON_LEVEL: f64 = 1e-12;

/// Functions that are evaluated together: as many as registers hold.
const TOGETHER: usize = 4;

/// Columns of a tensor side by side in SIMD lanes.
#[derive(Clone, Debug)]
struct ColumnBlock<const D: usize> {
    count: usize,
    /// Coefficients of the columns: `[polynomial of x][function][column]`.
    terms: Vec<[LaneNumbers; D]>,
    /// The first function at even parts of `x`: `[start][column]`.
    starts: [LaneNumbers; INTERVALS + 1],
}

/// Columns of a tensor: expansions in `x` at some places of `y`.
#[derive(Clone, Debug)]
pub struct TensorColumns<const D: usize> {
    blocks: Vec<ColumnBlock<D>>,
}

/// Points of one block of columns on a level line of the first function.
#[derive(Clone, Debug)]
pub struct LevelBlock<const D: usize, const L: usize> {
    /// Number of columns of the block.
    pub count: usize,
    /// Functions of the tensor on the level line: `[function][column]`.
    pub values: [LaneNumbers; D],
    /// Functions of `x` alone on the level line: `[function][column]`.
    pub along: [LaneNumbers; L],
}

impl<const D: usize> TensorColumns<D> {
    /// Returns the points at which the first function is `level`, with the values of `along` there: functions of `x` alone. There is one point
    /// for each column, in blocks of [`WIDTH`].
    ///
    /// Returns `None` if the first function does not grow along some column, does not have the level there, or if Newton's method fails.
    #[must_use]
    pub fn level<const L: usize>(
        &self,
        level: f64,
        along: &Chebyshev<L>,
    ) -> Option<Vec<LevelBlock<D, L>>> {
        let unit = Unit::detect();
        let blocks = self.blocks.iter().map(|block| {
            let mut starts = [0.0; WIDTH];
            for (lane, start) in starts[..block.count].iter_mut().enumerate() {
                *start = block.start(lane, level)?;
            }
            let found = unit.run(LevelPoints {
                block,
                along,
                level,
                starts: &starts,
            });
            let mut first = found.values[0][..block.count].iter();
            let is_on_level = first.all(|value| (value - level).abs() <= ON_LEVEL);
            is_on_level.then_some(found)
        });
        blocks.collect()
    }
}

impl<const D: usize> ColumnBlock<D> {
    /// Returns the approximate `x` at which the first function is `level` in the column `lane`.
    fn start(&self, lane: usize, level: f64) -> Option<f64> {
        let value = |i: usize| self.starts[i][lane];
        let mut pairs = 0..INTERVALS;
        let grows = pairs.all(|i| value(i) < value(i + 1));
        let is_inside = grows && value(0) <= level && level <= value(INTERVALS);
        if !is_inside {
            return None;
        }
        let after = (1..INTERVALS).take_while(|i| value(*i) <= level).count();
        let [from, to] = [value(after), value(after + 1)];
        Some((after as f64 + (level - from) / (to - from)) / INTERVALS as f64)
    }
}

/// The `N` functions from `first` on of columns with these `terms`, in the lanes from `from` on, at `x`.
#[inline(always)]
fn values<T: Lanes, const D: usize, const N: usize>(
    terms: &[[LaneNumbers; D]],
    first: usize,
    from: usize,
    x: T,
) -> [T; N] {
    let y = T::of(2.0).mul_add(x, T::of(-1.0));
    let (mut later, mut latest) = ([T::of(0.0); N], [T::of(0.0); N]);
    for (power, terms) in terms.iter().enumerate().rev() {
        let factor = if power == 0 { y } else { y + y };
        for i in 0..N.min(D - first) {
            let rest = pack::<T>(&terms[first + i], from) - latest[i];
            latest[i] = later[i];
            later[i] = factor.mul_add(latest[i], rest);
        }
    }
    later
}

/// Value and slope of the first function of columns with these `terms`, in the lanes from `from` on, at `x`.
#[inline(always)]
fn value_and_slope<T: Lanes, const D: usize>(
    terms: &[[LaneNumbers; D]],
    from: usize,
    x: T,
) -> [T; 2] {
    let (zero, two) = (T::of(0.0), T::of(2.0));
    let y = two.mul_add(x, T::of(-1.0));
    let (mut later, mut latest) = ([zero; 2], [zero; 2]);
    for (power, terms) in terms.iter().enumerate().rev() {
        let factor = if power == 0 { T::of(1.0) } else { two };
        let value = (factor * y).mul_add(later[0], pack::<T>(&terms[0], from) - latest[0]);
        // The argument of the polynomials grows by twice the change of `x`.
        let by_x = (factor + factor) * later[0];
        let slope = (factor * y).mul_add(later[1], by_x - latest[1]);
        latest = later;
        later = [value, slope];
    }
    later
}

/// Values of the first function of columns at even parts of `x`.
struct Starts<'a, const D: usize>(&'a [[LaneNumbers; D]]);

impl<const D: usize> SimdTask for Starts<'_, D> {
    type Output = [LaneNumbers; INTERVALS + 1];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let mut starts = [[0.0; WIDTH]; INTERVALS + 1];
        for from in (0..WIDTH).step_by(T::LANES) {
            for (group, starts) in starts.chunks_mut(TOGETHER).enumerate() {
                let place = |i: usize| (group * TOGETHER + i) as f64 / INTERVALS as f64;
                let ys: [T; TOGETHER] = std::array::from_fn(|i| T::of(2.0 * place(i) - 1.0));
                let (mut later, mut latest) = ([T::of(0.0); TOGETHER], [T::of(0.0); TOGETHER]);
                for (power, terms) in self.0.iter().enumerate().rev() {
                    let term = pack::<T>(&terms[0], from);
                    for (i, y) in ys.into_iter().enumerate() {
                        let factor = if power == 0 { y } else { y + y };
                        let rest = term - latest[i];
                        latest[i] = later[i];
                        later[i] = factor.mul_add(latest[i], rest);
                    }
                }
                for (start, value) in starts.iter_mut().zip(later) {
                    keep(start, from, value);
                }
            }
        }
        starts
    }
}

/// Points of a block of columns on a level line.
struct LevelPoints<'a, const D: usize, const L: usize> {
    block: &'a ColumnBlock<D>,
    along: &'a Chebyshev<L>,
    level: f64,
    starts: &'a LaneNumbers,
}

impl<const D: usize, const L: usize> SimdTask for LevelPoints<'_, D, L> {
    type Output = LevelBlock<D, L>;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let ColumnBlock { count, terms, .. } = self.block;
        let mut found = LevelBlock {
            count: *count,
            values: [[0.0; WIDTH]; D],
            along: [[0.0; WIDTH]; L],
        };
        for from in (0..*count).step_by(T::LANES) {
            let mut x: T = pack(self.starts, from);
            for _ in 0..STEPS {
                let [value, slope] = value_and_slope(terms, from, x);
                x = x + (T::of(self.level) - value) / slope;
            }
            for first in (0..D).step_by(TOGETHER) {
                let own = values::<T, D, TOGETHER>(terms, first, from, x);
                for (into, own) in found.values[first..].iter_mut().zip(own) {
                    keep(into, from, own);
                }
            }
            for (into, own) in found.along.iter_mut().zip(self.along.values::<T, L>(0, x)) {
                keep(into, from, own);
            }
        }
        found
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::numerics::expansion::chebyshev_points;

    fn tensor(function: impl Fn(f64, f64) -> [f64; 3]) -> ChebyshevTensor<3> {
        let rows = chebyshev_points(20).iter().map(|x| {
            let values = chebyshev_points(24).iter().map(|y| function(*x, *y));
            Chebyshev::through(&values.collect::<Vec<_>>())
        });
        ChebyshevTensor::through(&rows.collect::<Vec<_>>())
    }

    /// Along `x + y^2/4 = c` the functions are known; more columns than lanes.
    #[test]
    fn functions_are_found_on_a_level_line() {
        let function =
            |x: f64, y: f64| [x + 0.25 * y * y, (x + 2.0 * y).sin(), 1.0 / (2.0 + x * y)];
        let tensor = tensor(function);
        let values: Vec<[f64; 1]> = chebyshev_points(20).iter().map(|x| [x.exp()]).collect();
        let along = Chebyshev::through(&values);
        let places: Vec<f64> = (0..=20).map(|i| 0.8 * f64::from(i) / 20.0).collect();
        let columns = tensor.columns(&places);
        for level in [0.17, 0.5, 0.99] {
            let blocks = columns.level(level, &along).unwrap();
            assert_eq!(blocks.iter().map(|own| own.count).sum::<usize>(), 21);
            for (m, y) in places.iter().enumerate() {
                let (block, lane) = (&blocks[m / WIDTH], m % WIDTH);
                let x = level - 0.25 * y * y;
                let wanted = function(x, *y);
                for (own, wanted) in block.values.iter().zip(wanted) {
                    assert!((own[lane] - wanted).abs() < 1e-13, "{level} {y}");
                }
                assert!((block.along[0][lane] - x.exp()).abs() < 1e-13);
            }
        }
        // The line leaves the square at the last columns.
        assert!(columns.level(0.15, &along).is_none() && columns.level(1.01, &along).is_none());
        let [in_x, in_y] = tensor.tails();
        assert!(
            [in_x[0], in_y[0]]
                .as_flattened()
                .iter()
                .all(|tail| *tail < 1e-12)
        );
    }

    #[test]
    fn a_function_that_falls_has_no_level_line() {
        let tensor = tensor(|x, y| [x * (0.9 - x) + y, 0.0, 0.0]);
        let along = Chebyshev {
            coefficients: vec![[1.0]],
        };
        assert!(tensor.columns(&[0.5]).level(0.55, &along).is_none());
    }
}
