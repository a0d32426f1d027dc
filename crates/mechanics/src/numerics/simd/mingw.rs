//! Fused multiplication and addition for MinGW-w64, whose C library rounds twice. [`f64::mul_add`] calls the C library outside of
//! SIMD kernels, so that results would differ from the results on other systems.
#![allow(unsafe_code, reason = "the linker takes this function in place of the C library's")]

/// Returns `x * y + z`, rounded once.
// SAFETY: the name, the arguments and the result agree with the C standard's `fma`.
#[unsafe(no_mangle)]
extern "C" fn fma(x: f64, y: f64, z: f64) -> f64 {
    libm::fma(x, y, z)
}
