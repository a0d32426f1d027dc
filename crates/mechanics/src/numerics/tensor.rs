//! Chebyshev expansions of functions of two variables on `[0, 1]^2`, and the lines on which one of the functions is constant.
//!
//! The expansions go through values on the tensor of [`chebyshev_points`] in both variables. A column of the tensor is the expansion in
//! `x` at one `y`. On a level line, each column is solved for `x`, side by side in SIMD lanes.
//!
//! [`chebyshev_points`]: crate::numerics::expansion::chebyshev_points

use crate::numerics::expansion::{Chebyshev, MOST_POINTS};
use crate::numerics::{LaneNumbers, Lanes, SimdTask, Unit, WIDTH, keep, pack};

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
            in_x.iter().map(move |expansion| expansion.coefficients[power]).collect()
        };
        Self { coefficients: (0..rows.len()).map(of).collect() }
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
        let in_y = |terms: &Vec<[f64; D]>| Chebyshev { coefficients: terms.clone() };
        let sum = |sum: [[f64; D]; 2], expansion: Chebyshev<D>| {
            let tails = expansion.tails();
            std::array::from_fn(|group| std::array::from_fn(|i| sum[group][i] + tails[group][i]))
        };
        let zero = [[0.0; D]; 2];
        let longest = self.coefficients.iter().map(Vec::len).max().unwrap_or(0);
        [(0..longest).map(in_x).fold(zero, sum), self.coefficients.iter().map(in_y).fold(zero, sum)]
    }

    /// Removes coefficients for which `is_rounding` is true, from the last polynomial of `y` on, for each polynomial of `x`.
    pub fn shorten(&mut self, is_rounding: impl Fn(&[f64; D]) -> bool) {
        for in_y in &mut self.coefficients {
            while in_y.last().is_some_and(&is_rounding) {
                in_y.pop();
            }
        }
    }

    /// Returns the numbers of polynomials of `x` and of `y` with a coefficient.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        let lengths = self.coefficients.iter().map(Vec::len);
        let in_x = lengths.clone().rposition(|length| length > 0);
        [in_x.map_or(0, |last| last + 1), lengths.max().unwrap_or(0)]
    }

    /// Returns the values of the first `N` functions of the expansion at each of `places`, `(x, y)` in `[0, 1]^2`: `[place][function]`.
    #[must_use]
    pub fn at<const N: usize>(&self, places: &[[f64; 2]]) -> Vec<[f64; N]> {
        let unit = Unit::detect();
        let blocks = places.chunks(WIDTH).flat_map(|places| {
            let [mut xs, mut ys] = places[0].map(|coordinate| [coordinate; WIDTH]);
            for ([x, y], (into_x, into_y)) in places.iter().zip(xs.iter_mut().zip(&mut ys)) {
                (*into_x, *into_y) = (*x, *y);
            }
            let terms = unit.run(Contraction { coefficients: &self.coefficients, places: &ys });
            let values: [LaneNumbers; N] = unit.run(AtEach { terms: &terms, places: &xs });
            (0..places.len()).map(move |lane| values.map(|lanes| lanes[lane]))
        });
        blocks.collect()
    }

    /// Returns the expansion of one `function` with `x` and `y` exchanged.
    #[must_use]
    pub fn transposed(&self, function: usize) -> ChebyshevTensor<1> {
        let [_, length] = self.counts();
        let of = |power: usize| {
            let terms = self.coefficients.iter().map(move |in_y| in_y.get(power));
            let terms = terms.map(|term| [term.map_or(0.0, |term| term[function])]);
            terms.collect()
        };
        ChebyshevTensor { coefficients: (0..length).map(of).collect() }
    }

    /// Returns the columns of the tensor at each `y` of `places`.
    #[must_use]
    pub fn columns(&self, places: &[f64]) -> TensorColumns<D> {
        let unit = Unit::detect();
        let even: [f64; INTERVALS + 1] = std::array::from_fn(|i| i as f64 / INTERVALS as f64);
        let blocks = places.chunks(WIDTH).map(|places| {
            let mut at = [places[0]; WIDTH];
            at[..places.len()].copy_from_slice(places);
            let terms = unit.run(Contraction { coefficients: &self.coefficients, places: &at });
            let starts = unit.run(AtPlaces { terms: &terms, places: &even });
            ColumnBlock { count: places.len(), terms, starts }
        });
        TensorColumns { blocks: blocks.collect() }
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
                for (terms, polynomial) in in_y.iter().zip(&polynomials) {
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
    starts: Vec<LaneNumbers>,
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
    /// Functions of the tensor on the level line, `[function][column]`; columns beyond the count equal the first column.
    pub values: [LaneNumbers; D],
    /// Functions of `x` alone on the level line: `[function][column]`.
    pub along: [LaneNumbers; L],
}

impl<const D: usize> TensorColumns<D> {
    /// Returns the number of columns.
    #[must_use]
    pub fn count(&self) -> usize {
        self.blocks.iter().map(|block| block.count).sum()
    }

    /// Returns the points at which the first function is `level`, with the values of `along` there: functions of `x` alone. There is one point
    /// for each column, in blocks of [`WIDTH`].
    ///
    /// The point of a column is the first at which the first function grows beyond the level. Returns `None` if a column has no such point, or
    /// if Newton's method fails.
    #[must_use]
    pub fn level<const L: usize>(
        &self,
        level: f64,
        along: &Chebyshev<L>,
    ) -> Option<Vec<LevelBlock<D, L>>> {
        let unit = Unit::detect();
        let blocks = self.blocks.iter().map(|block| {
            // Columns beyond the count are as the first one.
            let mut starts = [block.start(0, level)?; WIDTH];
            for (lane, start) in starts[..block.count].iter_mut().enumerate().skip(1) {
                *start = block.start(lane, level)?;
            }
            let found = unit.run(LevelPoints { block, along, level, starts: &starts });
            let mut first = found.values[0][..block.count].iter();
            let is_on_level = first.all(|value| (value - level).abs() <= ON_LEVEL);
            is_on_level.then_some(found)
        });
        blocks.collect()
    }

    /// Returns the quotients `(f(x) - f(end))/(x - end)` of the first function with the `ends` of the columns, `[block][column]`, at each `x` of
    /// `places`: `[block][place][column]`. Columns beyond the count of a block are as its first one, if their ends are.
    #[must_use]
    pub fn quotients(&self, ends: &[LaneNumbers], places: &[f64]) -> Vec<Vec<LaneNumbers>> {
        let unit = Unit::detect();
        let blocks = self.blocks.iter().zip(ends);
        let quotients = blocks.map(|(block, ends)| {
            let terms = unit.run(QuotientTerms { block, ends });
            unit.run(AtPlaces { terms: &terms, places })
        });
        quotients.collect()
    }
}

impl<const D: usize> ColumnBlock<D> {
    /// Returns the approximate smallest `x` at which the first function grows beyond `level` in the column `lane`.
    fn start(&self, lane: usize, level: f64) -> Option<f64> {
        let value = |i: usize| self.starts[i][lane];
        let is_before = |i: usize| value(i) <= level;
        let after = (0..INTERVALS).find(|i| is_before(*i) && !is_before(i + 1))?;
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

/// Values of the first function of columns with these `terms` at some `places` of `x`.
struct AtPlaces<'a, const D: usize> {
    terms: &'a [[LaneNumbers; D]],
    places: &'a [f64],
}

impl<const D: usize> SimdTask for AtPlaces<'_, D> {
    type Output = Vec<LaneNumbers>;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let mut all = vec![[0.0; WIDTH]; self.places.len()];
        for from in (0..WIDTH).step_by(T::LANES) {
            let groups = self.places.chunks(TOGETHER);
            for (places, found) in groups.zip(all.chunks_mut(TOGETHER)) {
                let ys: [T; TOGETHER] =
                    std::array::from_fn(|i| T::of(2.0 * places.get(i).unwrap_or(&0.0) - 1.0));
                let (mut later, mut latest) = ([T::of(0.0); TOGETHER], [T::of(0.0); TOGETHER]);
                for (power, terms) in self.terms.iter().enumerate().rev() {
                    let term = pack::<T>(&terms[0], from);
                    for (i, y) in ys.into_iter().enumerate() {
                        let factor = if power == 0 { y } else { y + y };
                        let rest = term - latest[i];
                        latest[i] = later[i];
                        later[i] = factor.mul_add(latest[i], rest);
                    }
                }
                for (into, value) in found.iter_mut().zip(later) {
                    keep(into, from, value);
                }
            }
        }
        all
    }
}

/// Values of the first `N` functions of columns with these `terms`, each at its own `x` of `places`.
struct AtEach<'a, const D: usize, const N: usize> {
    terms: &'a [[LaneNumbers; D]],
    places: &'a LaneNumbers,
}

impl<const D: usize, const N: usize> SimdTask for AtEach<'_, D, N> {
    type Output = [LaneNumbers; N];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let mut all = [[0.0; WIDTH]; N];
        for from in (0..WIDTH).step_by(T::LANES) {
            let found: [T; N] = values(self.terms, 0, from, pack(self.places, from));
            for (lanes, found) in all.iter_mut().zip(found) {
                keep(lanes, from, found);
            }
        }
        all
    }
}

/// Coefficients of the quotients `(f(x) - f(end))/(x - end)` of the first function of columns: Clenshaw's sums at their `ends`.
struct QuotientTerms<'a, const D: usize> {
    block: &'a ColumnBlock<D>,
    ends: &'a LaneNumbers,
}

impl<const D: usize> SimdTask for QuotientTerms<'_, D> {
    type Output = Vec<[LaneNumbers; 1]>;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let terms = &self.block.terms;
        let mut quotients = vec![[[0.0; WIDTH]]; terms.len().max(2) - 1];
        for from in (0..WIDTH).step_by(T::LANES) {
            let y = T::of(2.0).mul_add(pack(self.ends, from), T::of(-1.0));
            let (mut later, mut latest) = (T::of(0.0), T::of(0.0));
            for power in (1..terms.len()).rev() {
                let rest = pack::<T>(&terms[power][0], from) - latest;
                latest = later;
                later = (y + y).mul_add(latest, rest);
                // `x - end` is half of the change of `y`.
                let twice = if power == 1 { 2.0 } else { 4.0 };
                keep(&mut quotients[power - 1][0], from, T::of(twice) * later);
            }
        }
        quotients
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
        let mut found =
            LevelBlock { count: *count, values: [[0.0; WIDTH]; D], along: [[0.0; WIDTH]; L] };
        for from in (0..*count).step_by(T::LANES) {
            let mut x: T = pack(self.starts, from);
            for _ in 0..STEPS {
                let [value, slope] = value_and_slope(terms, from, x);
                x = x + (T::of(self.level) - value) / slope;
            }
            for first in (0..D).step_by(TOGETHER) {
                let packed = values::<T, D, TOGETHER>(terms, first, from, x);
                for (into, value) in found.values[first..].iter_mut().zip(packed) {
                    keep(into, from, value);
                }
            }
            for (into, value) in found.along.iter_mut().zip(self.along.values::<T, L>(0, x)) {
                keep(into, from, value);
            }
        }
        // Columns beyond the count are as the first one, for every number of lanes.
        for lanes in found.values.iter_mut().chain(&mut found.along) {
            let first = lanes[0];
            lanes[*count..].fill(first);
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
            assert_eq!(blocks.iter().map(|block| block.count).sum::<usize>(), 21);
            for block in &blocks {
                let mut all = block.values.iter().chain(&block.along);
                let is_first =
                    |lanes: &LaneNumbers| lanes[block.count..].iter().all(|x| *x == lanes[0]);
                assert!(all.all(is_first));
            }
            for (m, y) in places.iter().enumerate() {
                let (block, lane) = (&blocks[m / WIDTH], m % WIDTH);
                let x = level - 0.25 * y * y;
                let wanted = function(x, *y);
                for (found, wanted) in block.values.iter().zip(wanted) {
                    assert!((found[lane] - wanted).abs() < 1e-13, "{level} {y}");
                }
                assert!((block.along[0][lane] - x.exp()).abs() < 1e-13);
            }
        }
        // The line leaves the square at the last columns.
        assert!(columns.level(0.15, &along).is_none() && columns.level(1.01, &along).is_none());
        let [in_x, in_y] = tensor.tails();
        assert!([in_x[0], in_y[0]].as_flattened().iter().all(|tail| *tail < 1e-12));
    }

    /// Along columns of an expansion with exchanged variables, quotients with places of each column equal the quotients of its functions.
    #[test]
    fn quotients_are_those_of_columns() {
        let function = |x: f64, y: f64| (x + 2.0 * y).sin();
        let columns = tensor(|x, y| [0.0, function(y, x), 0.0]).transposed(1);
        let at: Vec<f64> = (0..=10).map(|i| 0.1 * f64::from(i)).collect();
        let ends: Vec<LaneNumbers> = at
            .chunks(WIDTH)
            .map(|places| std::array::from_fn(|i| places.get(i).map_or(0.5, |y| 0.2 + 0.7 * y)))
            .collect();
        let places = [0.0, 0.11, 0.43, 0.52, 0.93, 1.0];
        let quotients = columns.columns(&at).quotients(&ends, &places);
        for (m, y) in at.iter().enumerate() {
            let (block, lane) = (m / WIDTH, m % WIDTH);
            let end = ends[block][lane];
            for (i, x) in places.into_iter().enumerate() {
                let wanted = (function(x, *y) - function(end, *y)) / (x - end);
                let off = quotients[block][i][lane] - wanted;
                assert!(off.abs() < 1e-12, "{x} {y}: {off}");
            }
        }
    }

    /// Two places of a column can have the value of the level: the line has the place where the function grows. Above the largest value there is no
    /// place.
    #[test]
    fn a_level_line_is_where_the_function_grows() {
        let tensor = tensor(|x, y| [x * (0.9 - x) + y, x, 0.0]);
        let along = Chebyshev { coefficients: vec![[1.0]] };
        let columns = tensor.columns(&[0.5]);
        let found = columns.level(0.64, &along).unwrap();
        assert!((found[0].values[1][0] - 0.2).abs() < 1e-12);
        assert!(columns.level(0.75, &along).is_none());
    }
}
