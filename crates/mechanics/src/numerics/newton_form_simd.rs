//! Polynomials in Newton's form, in lanes.

use crate::numerics::{Lanes, WIDTH};

/// A number for every lane.
pub type Numbers = [f64; WIDTH];

/// What a polynomial has as its terms: a number, or one for every lane.
pub trait Term {
    /// The lanes from `from` on.
    fn lanes<T: Lanes>(&self, from: usize) -> T;
}

impl Term for f64 {
    #[inline(always)]
    fn lanes<T: Lanes>(&self, _: usize) -> T {
        T::of(*self)
    }
}

impl Term for Numbers {
    #[inline(always)]
    fn lanes<T: Lanes>(&self, from: usize) -> T {
        T::pack(part(self, from))
    }
}

/// Value and slope at `place` of polynomials in Newton's form, in the lanes from `from` on.
#[inline(always)]
pub fn at<T: Lanes, C: Term, const N: usize>(
    places: &[f64; N],
    differences: &[C; N],
    from: usize,
    place: T,
) -> (T, T) {
    let (mut value, mut slope): (T, T) = (differences[N - 1].lanes(from), T::of(0.0));
    for i in (0..N - 1).rev() {
        let x = place - T::of(places[i]);
        slope = slope.mul_add(x, value);
        value = value.mul_add(x, differences[i].lanes(from));
    }
    (value, slope)
}

/// The numbers from `from` on, and nothing after them.
#[inline(always)]
pub fn part(numbers: &Numbers, from: usize) -> Numbers {
    let mut part = [0.0; WIDTH];
    part[..WIDTH - from].copy_from_slice(&numbers[from..]);
    part
}

/// Sets the numbers from `from` on to those of `lanes`.
#[inline(always)]
pub fn keep<T: Lanes>(numbers: &mut Numbers, from: usize, lanes: T) {
    numbers[from..from + T::LANES].copy_from_slice(&lanes.unpack()[..T::LANES]);
}
