//! Dual numbers: a value with its derivative, in `f64` or in SIMD lanes. Each lane has the derivative in its own direction.

use crate::numerics::Real;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number `value + derivative e` with `e^2 = 0`: arithmetic on it differentiates by the chain rule, without truncation error.
///
/// ```
/// use whiskmap_mechanics::numerics::{Dual, Real};
///
/// let x = Dual { value: 3.0, derivative: 1.0 };
/// let root = (x * x + Dual::of(7.0)).sqrt();
/// assert_eq!((root.value, root.derivative), (4.0, 0.75));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T> {
    /// Value of the number.
    pub value: T,
    /// Derivative of the number, per unit of the variable that its lane differentiates by.
    pub derivative: T,
}

/// A single number, whose value decides between cases: no lanes.
pub trait Scalar: Real {
    /// Returns the value of the number without its derivative.
    fn value(self) -> f64;
}

impl Scalar for f64 {
    fn value(self) -> f64 {
        self
    }
}

impl Scalar for Dual<f64> {
    fn value(self) -> f64 {
        self.value
    }
}

impl<T: Real> Add for Dual<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, derivative: self.derivative + other.derivative }
    }
}

impl<T: Real> Sub for Dual<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, derivative: self.derivative - other.derivative }
    }
}

impl<T: Real> Mul for Dual<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let change = self.value * other.derivative;
        Self {
            value: self.value * other.value,
            derivative: self.derivative.mul_add(other.value, change),
        }
    }
}

impl<T: Real> Div for Dual<T> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = T::of(1.0) / other.value;
        let value = self.value * inverse;
        Self { value, derivative: (-value).mul_add(other.derivative, self.derivative) * inverse }
    }
}

impl<T: Real> Neg for Dual<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, derivative: -self.derivative }
    }
}

impl<T: Real> Real for Dual<T> {
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self { value: T::of(x), derivative: T::of(0.0) }
    }

    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        let change = self.value.mul_add(a.derivative, b.derivative);
        Self {
            value: self.value.mul_add(a.value, b.value),
            derivative: self.derivative.mul_add(a.value, change),
        }
    }

    /// Returns the square root. The root of a constant 0 is a constant 0.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        // The smallest normal number changes no root but the root of 0.
        let slope = T::of(0.5) / (value + T::of(f64::MIN_POSITIVE));
        Self { value, derivative: self.derivative * slope }
    }
}
