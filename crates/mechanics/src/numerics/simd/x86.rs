//! The vector units of x86-64.
#![allow(
    unsafe_code,
    reason = "vector instructions may run only where the unit exists, which a token proves; see `registers`"
)]

use super::{Lanes, LanesTask, SimdTask, WIDTH};
use crate::numerics::Real;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

unit!(
    /// The processor has AVX-512.
    Avx512, "avx512f,avx512dq,avx512vl,fma", is_x86_feature_detected ["avx512f" "avx512dq" "avx512vl" "fma"],
    Vector512 [0 __m512d], Vectors512 [0 __m512d, 1 __m512d], 8,
    _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_set1_pd, _mm512_sqrt_pd,
    _mm512_loadu_pd, _mm512_storeu_pd
);
unit!(
    /// The processor has AVX2 with FMA.
    Avx2, "avx2,fma", is_x86_feature_detected ["avx2" "fma"],
    Vector256 [0 __m256d], Vectors256 [0 __m256d, 1 __m256d], 4,
    _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_fmadd_pd, _mm256_set1_pd, _mm256_sqrt_pd,
    _mm256_loadu_pd, _mm256_storeu_pd
);
