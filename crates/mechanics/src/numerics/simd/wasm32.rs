//! The vector unit of WebAssembly. Every browser that compiles this module has it: a build either enables it for all code, or for none.
#![allow(
    unsafe_code,
    unused_unsafe,
    reason = "the macros of `registers` are written for instructions that not every processor has"
)]

use super::{Lanes, LanesTask, SimdTask, WIDTH};
use crate::numerics::Real;
use std::arch::wasm32::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `a * b + c`, rounded twice: fused products are no part of the unit.
#[inline]
#[target_feature(enable = "simd128")]
fn unfused(a: v128, b: v128, c: v128) -> v128 {
    f64x2_add(f64x2_mul(a, b), c)
}

#[inline]
#[target_feature(enable = "simd128")]
unsafe fn load(from: *const f64) -> v128 {
    // SAFETY: the caller has two numbers there.
    unsafe { v128_load(from.cast()) }
}

#[inline]
#[target_feature(enable = "simd128")]
unsafe fn store(to: *mut f64, lanes: v128) {
    // SAFETY: the caller has room for two numbers there.
    unsafe { v128_store(to.cast(), lanes) }
}

macro_rules! is_enabled {
    ($feature:tt) => {
        cfg!(target_feature = $feature)
    };
}

unit!(
    /// The build enables the vectors of WebAssembly.
    Simd128, "simd128", is_enabled ["simd128"],
    Vectors2 [0 v128, 1 v128],
    Vectors4 [0 v128, 1 v128, 2 v128, 3 v128], 2,
    f64x2_add, f64x2_sub, f64x2_mul, f64x2_div, unfused, f64x2_splat, f64x2_sqrt, load, store
);
