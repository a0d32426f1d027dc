//! Position of the pole in the frame of the base, with derivatives, in lanes.
//!
//! Let the complex number `w` be the vector from the base to the pole's centre in the axes of the contact. Let `theta` be the angle of
//! the base's tangent. `G = ln w - i theta` has the real part `ln D` and the imaginary part `phi`. Its derivatives need no trigonometry:
//! `G_i = w_i/w - i theta_i`, `G_ij = w_ij/w - w_i w_j/w^2 - i theta_ij`.

use crate::numerics::{Lanes, Real, WIDTH};
use crate::shooting::ShootingMap;
use crate::shooting::sensitivity::{Arrival, BaseDerivatives, Triple};
use glam::DVec2;

/// A complex number `re + i im`, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Complex<T> {
    pub re: T,
    pub im: T,
}

impl<T: Real> Complex<T> {
    #[inline(always)]
    fn new(re: T, im: T) -> Self {
        Self { re, im }
    }

    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self::new(
            self.re * other.re - self.im * other.im,
            self.re.mul_add(other.im, self.im * other.re),
        )
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        let over = T::of(1.0) / self.re.mul_add(self.re, self.im * self.im);
        Self::new(over * self.re, -over * self.im)
    }

    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

/// Position of the pole's centre relative to the base, in lanes.
pub struct PoleCentre<T> {
    /// Vector from the base to the pole's centre in the frame of the base, in whisker lengths.
    pub pole: Complex<T>,
    inverse: Complex<T>,
}

impl<T: Real> PoleCentre<T> {
    #[inline(always)]
    pub fn new(arrival: &Arrival<T>, [to_x, to_y]: [T; 2]) -> Self {
        let [c, s, x, y, _] = arrival.rod;
        let w = Complex::new(to_x - x, to_y - y);
        Self { pole: Complex::new(c, -s).times(w), inverse: w.inverse() }
    }

    /// Returns `w_i/w` for the derivatives `[theta_i, x_i, y_i]` of the base by a variable `i`. Here, `w` is the vector from the base to the pole's
    /// centre as a complex number.
    #[inline(always)]
    pub fn moved(&self, [_, x, y]: Triple<T>) -> Complex<T> {
        Complex::new(-x, -y).times(self.inverse)
    }

    /// Returns the derivative of `ln D + i phi` (`phi` in radians) by a variable `i`, from the derivatives `[theta_i, x_i, y_i]` of the base.
    #[inline(always)]
    pub fn ln_pole_by(&self, of: Triple<T>) -> Complex<T> {
        let moved = self.moved(of);
        Complex::new(moved.re, moved.im - of[0])
    }

    /// Returns the derivative of `ln D + i phi` (`phi` in radians) by two variables, from the second derivatives `of` the base. `by` and `and` are
    /// the results of [`PoleCentre::moved`] for each variable.
    #[inline(always)]
    pub fn ln_pole_by_twice(&self, of: Triple<T>, by: Complex<T>, and: Complex<T>) -> Complex<T> {
        self.ln_pole_by(of).minus(by.times(and))
    }
}

impl<T: Lanes> PoleCentre<T> {
    /// Returns the shooting map of each lane, `[lane]`.
    #[inline(always)]
    pub fn maps(&self, first: &BaseDerivatives<T>) -> [ShootingMap; WIDTH] {
        let tau = self.ln_pole_by(first.by_tau);
        let load = self.ln_pole_by(first.by_load);
        let pole = self.pole;
        let numbers = [pole.re, pole.im, tau.re, tau.im, load.re, load.im];
        spread(numbers, |_, [x, y, ln_d_tau, phi_tau, ln_d_load, phi_load]| ShootingMap {
            pole: DVec2::new(x, y),
            by_tau: DVec2::new(ln_d_tau, phi_tau),
            by_load: DVec2::new(ln_d_load, phi_load),
        })
    }
}

/// The result of `output` for the index and the numbers of each lane. It is outside the kernels, because it computes nothing.
#[inline(never)]
fn transposed<A: Copy + Default, const N: usize>(
    columns: &[[f64; WIDTH]; N],
    output: impl Fn(usize, [f64; N]) -> A,
) -> [A; WIDTH] {
    let mut outputs = [A::default(); WIDTH];
    for (lane, slot) in outputs.iter_mut().enumerate() {
        *slot = output(lane, columns.each_ref().map(|column| column[lane]));
    }
    outputs
}

/// Returns the results of `output` for the index and the `numbers` of each lane, `[lane]`.
#[inline(always)]
pub fn spread<T: Lanes, A: Copy + Default, const N: usize>(
    numbers: [T; N],
    output: impl Fn(usize, [f64; N]) -> A,
) -> [A; WIDTH] {
    let mut columns = [[0.0; WIDTH]; N];
    for (column, number) in columns.iter_mut().zip(numbers) {
        *column = number.unpack();
    }
    transposed(&columns, output)
}
