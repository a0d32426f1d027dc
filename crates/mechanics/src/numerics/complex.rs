//! Complex numbers over any scalar: the operations that the shooting map needs.

use crate::numerics::Real;

/// A complex number `re + i im`.
#[derive(Clone, Copy, Debug)]
pub struct Complex<T> {
    /// The real part.
    pub re: T,
    /// The imaginary part.
    pub im: T,
}

impl<T: Real> Complex<T> {
    /// The number `re + i im`.
    #[inline(always)]
    pub fn new(re: T, im: T) -> Self {
        Self { re, im }
    }

    /// The product with `other`.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self::new(
            self.re * other.re - self.im * other.im,
            self.re.mul_add(other.im, self.im * other.re),
        )
    }

    /// The inverse.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        let over = T::of(1.0) / self.re.mul_add(self.re, self.im * self.im);
        Self::new(over * self.re, -over * self.im)
    }

    /// This number less `other`.
    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}
