//! States of a trajectory as vectors: arrays, pairs of vectors, and the empty state of an absent effect.

use crate::numerics::Real;

/// What an integrator needs of a state.
pub trait Vector<T: Real>: Copy {
    /// `self + h k`.
    #[must_use]
    fn plus(self, h: T, k: Self) -> Self;

    /// `h self`.
    #[must_use]
    fn times(self, h: T) -> Self;
}

impl<T: Real> Vector<T> for () {
    #[inline(always)]
    fn plus(self, _: T, (): Self) -> Self {}

    #[inline(always)]
    fn times(self, _: T) -> Self {}
}

impl<T: Real, const N: usize> Vector<T> for [T; N] {
    #[inline(always)]
    fn plus(mut self, h: T, k: Self) -> Self {
        for i in 0..N {
            self[i] = h.mul_add(k[i], self[i]);
        }
        self
    }

    #[inline(always)]
    fn times(mut self, h: T) -> Self {
        for x in &mut self {
            *x = h * *x;
        }
        self
    }
}

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
