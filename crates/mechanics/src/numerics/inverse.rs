//! Inverse of a growing Chebyshev expansion, with further functions at the same place, side by side in SIMD lanes.
//!
//! The first function grows from 0 to an end in `[0, 1]`, and may be flat there, as the push angle of a row is at a fold. Near a flat end it is a
//! parabola, and the place is linear in the square root of what is left to the end. So starts are interpolated in this root, and
//! each step solves the quadratic Taylor polynomial (E. Halley's irrational method, 1694). Its error is cubed by each step.

use crate::numerics::expansion::Chebyshev;
use crate::numerics::{Lanes, SimdTask, Unit, WIDTH};

/// Intervals between tabulated starts: their interpolation leaves an error of 1e-3 or less, two steps then 1e-24.
const INTERVALS: usize = 2 * WIDTH;

/// Number of steps from an interpolated start.
const STEPS: usize = 2;

/// Functions that are evaluated together, as a group: as many as registers hold.
pub const TOGETHER: usize = 4;

/// Returns the first function of each group that has a `wanted` function, `[group]`.
#[inline(always)]
pub fn groups(wanted: &[bool]) -> impl Iterator<Item = usize> {
    let groups = wanted.chunks(TOGETHER).enumerate();
    groups.filter_map(|(group, wanted)| wanted.contains(&true).then_some(group * TOGETHER))
}

/// Tabulated value of the first function.
#[derive(Clone, Copy, Debug, Default)]
struct InverseStart {
    value: f64,
    /// Square root of what is left to the value at the end.
    root: f64,
}

/// Functions on `[0, 1]` with a table that inverts the first one, which grows up to an end.
#[derive(Clone, Debug)]
pub struct Inverse<const D: usize> {
    /// Expansion of the functions, the first of which is inverted.
    pub functions: Chebyshev<D>,
    /// Argument up to which the first function is inverted, in `[0, 1]`.
    pub end: f64,
    starts: [InverseStart; INTERVALS + 1],
}

/// Arguments at which the first function has a block of target values, and all functions there.
#[derive(Clone, Copy, Debug)]
pub struct InverseBlock<const D: usize> {
    /// Arguments found for the targets, one in each lane.
    pub places: [f64; WIDTH],
    /// Values of the functions at the arguments found, `[function][lane]`; 0 for functions that are not evaluated. Where the first differs from
    /// the target, the steps have not converged.
    pub values: [[f64; WIDTH]; D],
}

impl<const D: usize> Inverse<D> {
    /// Tabulates the first function of an expansion for its inversion up to the argument `end`. Returns `None` if it does not grow from one
    /// start to the next.
    #[must_use]
    pub fn new(functions: Chebyshev<D>, end: f64) -> Option<Self> {
        let values = Unit::detect().run(Table(&functions, end));
        let last = values[INTERVALS];
        let start = |value: f64| InverseStart { value, root: (last - value).max(0.0).sqrt() };
        let grows = values.windows(2).all(|pair| pair[0] < pair[1]);
        grows.then(|| Self { functions, end, starts: values.map(start) })
    }

    /// Value of the first function at the end.
    const fn last(&self) -> f64 {
        self.starts[INTERVALS].value
    }

    /// Approximate place of a target. `after` is the index of a start at or before the target; it moves along with growing targets.
    fn near(&self, target: f64, after: &mut usize) -> f64 {
        while *after + 2 < self.starts.len() && target > self.starts[*after + 1].value {
            *after += 1;
        }
        let [from, to] = [self.starts[*after], self.starts[*after + 1]];
        let root = (self.last() - target).max(0.0).sqrt();
        let place = *after as f64 + (from.root - root) / (from.root - to.root);
        place * (self.end / INTERVALS as f64)
    }

    /// Finds the arguments at which the first function has the growing `targets`. Calls `take` for each [`WIDTH`] targets with the index
    /// of the first target, the number of targets, and the values there of the functions that are `wanted`: `[function]`.
    pub fn solve(
        &self,
        targets: &[f64],
        wanted: &[bool; D],
        mut take: impl FnMut(usize, usize, &InverseBlock<D>),
    ) {
        let unit = Unit::detect();
        let mut after = 0;
        for (block, chunk) in targets.chunks(WIDTH).enumerate() {
            let mut task = Steps {
                functions: &self.functions,
                wanted,
                targets: [self.last(); WIDTH],
                starts: [self.end; WIDTH],
            };
            for (lane, target) in chunk.iter().enumerate() {
                task.targets[lane] = target.min(self.last());
                task.starts[lane] = self.near(*target, &mut after);
            }
            take(block * WIDTH, chunk.len(), &unit.run(task));
        }
    }
}

/// Values of the first function at the starts, up to an end.
struct Table<'a, const D: usize>(&'a Chebyshev<D>, f64);

impl<const D: usize> SimdTask for Table<'_, D> {
    type Output = [f64; INTERVALS + 1];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        let mut values = [0.0; INTERVALS + 1];
        for from in (0..=INTERVALS).step_by(T::LANES) {
            let part = self.1 / INTERVALS as f64;
            let places = std::array::from_fn(|lane| (from + lane) as f64 * part);
            let [found] = self.0.series::<T, 1>(0, T::pack(places));
            for (value, found) in values[from..].iter_mut().zip(&found.unpack()[..T::LANES]) {
                *value = *found;
            }
        }
        values
    }
}

/// Steps toward the targets of a block.
struct Steps<'a, const D: usize> {
    functions: &'a Chebyshev<D>,
    wanted: &'a [bool; D],
    targets: [f64; WIDTH],
    starts: [f64; WIDTH],
}

impl<const D: usize> SimdTask for Steps<'_, D> {
    type Output = InverseBlock<D>;

    #[inline(always)]
    fn run<T: Lanes>(self) -> InverseBlock<D> {
        let mut block = InverseBlock { places: [0.0; WIDTH], values: [[0.0; WIDTH]; D] };
        let lanes = |numbers: &[f64; WIDTH], from: usize| {
            let mut lanes = [0.0; WIDTH];
            lanes[..T::LANES].copy_from_slice(&numbers[from..from + T::LANES]);
            T::pack(lanes)
        };
        for from in (0..WIDTH).step_by(T::LANES) {
            let target: T = lanes(&self.targets, from);
            let mut place = lanes(&self.starts, from);
            for _ in 0..STEPS {
                let [value, slope, half] = self.functions.series::<T, 3>(0, place);
                place = place + quadratic_step(target - value, slope, half);
            }
            let here = from..from + T::LANES;
            block.places[here.clone()].copy_from_slice(&place.unpack()[..T::LANES]);
            for first in groups(self.wanted) {
                let found = self.functions.values::<T, TOGETHER>(first, place);
                for (values, found) in block.values[first..].iter_mut().zip(found) {
                    values[here.clone()].copy_from_slice(&found.unpack()[..T::LANES]);
                }
            }
        }
        block
    }
}

/// The smaller root `d` of `slope d + half d^2 = rest`; the vertex of the parabola where there is no root.
#[inline(always)]
fn quadratic_step<T: Lanes>(rest: T, slope: T, half: T) -> T {
    let discriminant = slope.mul_add(slope, T::of(4.0) * half * rest);
    // Zero where negative.
    let clipped = T::of(0.5) * (discriminant + (discriminant * discriminant).sqrt());
    // A flat function at its target takes no step.
    (rest + rest) / (slope + clipped.sqrt() + T::of(f64::MIN_POSITIVE))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::numerics::expansion::chebyshev_points;
    use std::f64::consts::FRAC_PI_2;

    /// The sine up to its flat top at `end`, and a function that is not flat there.
    fn arc(count: usize, end: f64) -> Option<Inverse<5>> {
        let values: Vec<[f64; 5]> = chebyshev_points(count)
            .iter()
            .map(|x| {
                let x = FRAC_PI_2 * x / end;
                [x.sin(), x, x.cos(), 1.0, (-x).exp()]
            })
            .collect();
        Inverse::new(Chebyshev::through(&values), end)
    }

    #[test]
    fn a_flat_end_is_inverted() {
        for end in [1.0, 0.9] {
            inverts_up_to(end);
        }
    }

    fn inverts_up_to(end: f64) {
        let inverse = arc(24, end).unwrap();
        let targets: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
        let mut count = 0;
        inverse.solve(&targets, &[true; 5], |from, len, block| {
            for lane in 0..len {
                let target = targets[from + lane];
                let x = target.asin();
                let [sine, angle, cosine, one, decay] = block.values.map(|values| values[lane]);
                assert!((sine - target).abs() < 1e-14, "{target}");
                // The angle is as uncertain as the square root of rounding at the top.
                let error = 3e-15 / x.cos().max(3e-8);
                assert!((angle - x).abs() < error, "{target} {angle}");
                assert!((block.places[lane] * FRAC_PI_2 / end - angle).abs() < 1e-14);
                assert!((cosine - angle.cos()).abs() < 1e-14 && (one - 1.0).abs() < 1e-14);
                assert!((decay - (-angle).exp()).abs() < 1e-14, "{target}");
                count += 1;
            }
        });
        assert_eq!(count, targets.len());
    }

    #[test]
    fn targets_beyond_the_end_are_put_there() {
        let inverse = arc(24, 1.0).unwrap();
        inverse.solve(&[0.5, 1.5], &[true; 5], |_, len, block| {
            assert_eq!(len, 2);
            assert!((block.places[1] - 1.0).abs() < 1e-6 && block.values[0][1] <= 1.0 + 1e-15);
        });
    }

    #[test]
    fn only_wanted_functions_are_evaluated() {
        let inverse = arc(24, 1.0).unwrap();
        let solved = |wanted: [bool; 5]| {
            let mut found = Vec::new();
            inverse.solve(&[0.5], &wanted, |_, _, block| found.push(*block));
            (found[0].places[0], found[0].values.map(|values| values[0]))
        };
        let (place, all) = solved([true; 5]);
        let last = [0.0, 0.0, 0.0, 0.0, all[4]];
        let (_, only_last) = solved([false, false, false, false, true]);
        assert!(all[4] > 0.1 && only_last == last);
        let (same_place, first) = solved([true, false, false, false, false]);
        assert!(same_place == place && first[0] == all[0] && first[4] == 0.0);
    }

    #[test]
    fn a_falling_function_has_no_inverse() {
        let falling: Vec<[f64; 1]> = chebyshev_points(8).iter().map(|x| [x * (0.9 - x)]).collect();
        assert!(Inverse::new(Chebyshev::through(&falling), 1.0).is_none());
    }
}
