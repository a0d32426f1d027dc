//! What the processor could do at best: nothing but fused multiply-adds, in as many chains as hide their latency and fit
//! into the registers.

use crate::model::simd::{Lanes, WIDTH};
use std::hint::black_box;

/// Multiplies and adds `rounds` times in every chain, and tells how many operations that were.
#[inline(always)]
pub fn multiply_and_add<T: Lanes, const CHAINS: usize>(rounds: u32) -> u64 {
    let start = black_box([1.0; WIDTH]);
    let (factor, term) = (T::of(black_box(0.999_999)), T::of(black_box(1e-6)));
    let mut chains: [T; CHAINS] = std::array::from_fn(|_| T::pack(start));
    for _ in 0..rounds {
        for chain in &mut chains {
            *chain = chain.mul_add(factor, term);
        }
    }
    for chain in chains {
        black_box(chain.unpack());
    }
    2 * (CHAINS * T::LANES) as u64 * u64::from(rounds)
}
