//! Fused multiplication and addition where the C library is MinGW-w64's, which rounds twice: [`f64::mul_add`] calls it outside of SIMD
//! kernels, and results would differ from the results on other systems.
#![allow(
    unsafe_code,
    reason = "the linker takes this function in place of the C library's"
)]

/// Returns `x * y + z`, rounded once.
// SAFETY: the name, the arguments and the result agree with the C standard's `fma`.
#[unsafe(no_mangle)]
extern "C" fn fma(x: f64, y: f64, z: f64) -> f64 {
    libm::fma(x, y, z)
}
