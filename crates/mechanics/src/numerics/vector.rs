//! States of a trajectory as vectors: arrays, pairs of vectors, and the empty state of an effect that is absent.

use crate::numerics::Real;

/// Vector operations that an integrator needs.
pub trait Vector<T: Real>: Copy {
    /// Returns `self + h k` for a vector `k` and a number `h`.
    #[must_use]
    fn plus(self, h: T, k: Self) -> Self;

    /// Returns the vector multiplied by the number `h`.
    #[must_use]
    fn times(self, h: T) -> Self;
}

impl<T: Real> Vector<T> for () {
    #[inline(always)]
    fn plus(self, _: T, (): Self) -> Self {}

    #[inline(always)]
    fn times(self, _: T) -> Self {}
}

/// Written out for each length: a compiler takes long to unroll many thousands of loops.
macro_rules! array {
    ($($length:literal: $($i:literal)+),+) => {$(
        impl<T: Real> Vector<T> for [T; $length] {
            #[inline(always)]
            fn plus(self, h: T, k: Self) -> Self {
                [$(h.mul_add(k[$i], self[$i])),+]
            }

            #[inline(always)]
            fn times(self, h: T) -> Self {
                [$(h * self[$i]),+]
            }
        }
    )+};
}

array!(1: 0, 2: 0 1, 3: 0 1 2, 5: 0 1 2 3 4);

impl<T: Real, A: Vector<T>, B: Vector<T>> Vector<T> for (A, B) {
    #[inline(always)]
    fn plus(self, h: T, k: Self) -> Self {
        (self.0.plus(h, k.0), self.1.plus(h, k.1))
    }

    #[inline(always)]
    fn times(self, h: T) -> Self {
        (self.0.times(h), self.1.times(h))
    }
}
