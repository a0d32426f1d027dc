//! Peak rate of the processor: only multiplications with additions, in independent accumulators.

use crate::numerics::{Lanes, SimdTask, Unit, WIDTH};
use std::hint::black_box;
use std::time::Instant;

/// Timed rounds: milliseconds.
const ROUNDS: u32 = 1 << 20;

/// Numbers of accumulators that are tried: too few wait for one another's results, too many for memory. The best number depends on the
/// registers of the unit and on the latency of an addition.
const ACCUMULATORS: [usize; 8] = [4, 6, 7, 8, 10, 12, 14, 16];

/// Returns the peak rate of all threads of the pool together, in billions of operations per second, with the best number of accumulators.
pub fn peak(unit: Unit) -> f64 {
    let rate = |accumulators| {
        let start = Instant::now();
        let task = MultiplyAndAdd { accumulators };
        let operations: u64 = rayon::broadcast(|_| unit.run(task)).iter().sum();
        1e-9 * operations as f64 / start.elapsed().as_secs_f64()
    };
    ACCUMULATORS.map(rate).into_iter().fold(0.0, f64::max)
}

/// Multiplies and adds in every accumulator, and returns the number of operations.
#[derive(Clone, Copy, Debug)]
struct MultiplyAndAdd {
    /// One of [`ACCUMULATORS`].
    accumulators: usize,
}

impl SimdTask for MultiplyAndAdd {
    type Output = u64;

    #[inline(always)]
    fn run<T: Lanes>(self) -> u64 {
        match self.accumulators {
            4 => rounds::<T, 4>(),
            6 => rounds::<T, 6>(),
            7 => rounds::<T, 7>(),
            8 => rounds::<T, 8>(),
            10 => rounds::<T, 10>(),
            12 => rounds::<T, 12>(),
            14 => rounds::<T, 14>(),
            _ => rounds::<T, 16>(),
        }
    }
}

#[inline(always)]
fn rounds<T: Lanes, const ACCUMULATORS: usize>() -> u64 {
    let start = black_box([1.0; WIDTH]);
    let (factor, term) = (T::of(black_box(0.999_999)), T::of(black_box(1e-6)));
    let mut accumulators: [T; ACCUMULATORS] = std::array::from_fn(|_| T::pack(start));
    for _ in 0..ROUNDS {
        for sum in &mut accumulators {
            *sum = sum.mul_add(factor, term);
        }
    }
    for sum in accumulators {
        black_box(sum.unpack());
    }
    2 * (ACCUMULATORS * T::LANES) as u64 * u64::from(ROUNDS)
}
