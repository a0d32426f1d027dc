//! The vector unit of aarch64. It has as many lanes as AVX2: four registers of two numbers instead of two of four.
#![allow(
    unsafe_code,
    reason = "vector instructions may run only where the unit exists, which a token proves; see `registers`"
)]

use super::{Lanes, LanesTask, SimdTask, WIDTH};
use crate::numerics::Real;
use std::arch::aarch64::*;
use std::arch::is_aarch64_feature_detected;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `a * b + c`, rounded once; the instruction takes `c` first.
#[inline]
#[target_feature(enable = "neon")]
fn fused(a: float64x2_t, b: float64x2_t, c: float64x2_t) -> float64x2_t {
    vfmaq_f64(c, a, b)
}

unit!(
    /// The processor has NEON.
    Neon, "neon", is_aarch64_feature_detected ["neon"],
    Vectors2 [0 float64x2_t, 1 float64x2_t],
    Vectors4 [0 float64x2_t, 1 float64x2_t, 2 float64x2_t, 3 float64x2_t], 2,
    vaddq_f64, vsubq_f64, vmulq_f64, vdivq_f64, fused, vdupq_n_f64, vsqrtq_f64, vld1q_f64, vst1q_f64
);
