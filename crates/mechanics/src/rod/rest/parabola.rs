//! Parabola at rest, `y = A (x - x0)^2` (paper, Eqs 7 and 10), or a straight line.

use super::derivative::CurveDerivative;
use crate::numerics::Bracket;
use crate::rod::{Rod, RodDerivative};
use glam::DVec2;

/// `t sqrt(1 + t^2) + asinh(t)`: `4 A` times the arclength from the vertex to the slope `t`.
#[inline(always)]
fn arc(t: f64) -> f64 {
    let root = (1.0 + t * t).sqrt();
    let size = t.abs();
    // asinh, accurate to the last digits for small and large slopes, cheaper than with `hypot`.
    let asinh = libm::log1p(size + size * size / (1.0 + root));
    t * root + asinh.copysign(t)
}

/// Largest last Halley step, relative to the abscissa: the error is its cube, which is below rounding.
const LAST_HALLEY_STEP: f64 = 5e-6;

/// Parabola at rest in the frame of the base.
#[derive(Clone, Copy, Debug)]
pub struct Parabola {
    bend: f64,
    slope: f64,
    /// Unit tangent of the base in the frame of the parabola.
    base: DVec2,
}

impl Parabola {
    /// Computes the parabola at rest of `rod`.
    pub fn new(rod: &Rod) -> Self {
        Self { bend: rod.bend, slope: rod.slope, base: DVec2::new(1.0, rod.slope).normalize() }
    }

    /// Returns the slope of the parabola in its own frame at arclength `s` (whisker lengths), dimensionless.
    #[inline(always)]
    pub fn slope_at(&self, s: f64) -> f64 {
        if self.bend == 0.0 {
            return self.slope;
        }
        // The start has the right limits for small and large `z` and an error of at most 0.5 % between. The Taylor series of
        // the inverse from there to degree 6 has a remainder below 1e-16.
        let z = 4.0 * self.bend * s + arc(self.slope);
        let size = z.abs();
        let power = 1.0 + z * z * (0.253 + 0.0437 * size + z * z / 256.0);
        let t = 0.5 * z / power.sqrt().sqrt().sqrt();
        let square = t * t;
        let root = (1.0 + square).sqrt();
        // With `d = (z - arc(t)) / 2 root`, the terms `d^k / k!` times the derivatives, over powers of `root^3`.
        let d = (z - arc(t)) / (2.0 * root);
        let e = d / (root * root);
        let series = [
            -t,
            -1.0 + 3.0 * square,
            t * (13.0 - 15.0 * square),
            13.0 + square * (-162.0 + 105.0 * square),
            t * (-493.0 + square * (2202.0 - 945.0 * square)),
        ];
        let [c2, c3, c4, c5, c6] = series;
        let tail = c2 / 2.0 + e * (c3 / 6.0 + e * (c4 / 24.0 + e * (c5 / 120.0 + e * c6 / 720.0)));
        t + d * (1.0 + e * tail)
    }

    /// Returns the curvature `2 A cos^3` of the parabola at arclength `s` (whisker lengths), in radians per whisker length.
    pub fn curvature(&self, s: f64) -> f64 {
        2.0 * self.bend / (1.0 + self.slope_at(s).powi(2)).sqrt().powi(3)
    }

    /// Returns the arclength at the abscissa `x` of the parabola, both in whisker lengths from the base.
    pub fn arclength_at(&self, x: f64) -> f64 {
        if self.bend == 0.0 {
            return x * (1.0 + self.slope * self.slope).sqrt();
        }
        let t = (2.0 * self.bend).mul_add(x, self.slope);
        (arc(t) - arc(self.slope)) / (4.0 * self.bend)
    }

    /// Returns point and unit tangent at the abscissa `x` of the parabola, in whisker lengths, in the frame of the base.
    pub fn at(&self, x: f64) -> (DVec2, DVec2) {
        let t = (2.0 * self.bend).mul_add(x, self.slope);
        let point = DVec2::new(x, x * self.bend.mul_add(x, self.slope));
        let tangent = DVec2::new(1.0, t).normalize();
        let to_base = DVec2::new(self.base.x, -self.base.y);
        (to_base.rotate(point), to_base.rotate(tangent))
    }

    /// Returns the derivative of the parabola at the abscissa `x` (whisker lengths) by a variable, in the frame of the base.
    pub fn derivative(&self, x: f64, by: &RodDerivative) -> CurveDerivative {
        let t = (2.0 * self.bend).mul_add(x, self.slope);
        let at_base = by.slope / (1.0 + self.slope * self.slope);
        let rise = DVec2::new(0.0, x * by.bend.mul_add(x, by.slope));
        let (point, _) = self.at(x);
        let to_base = DVec2::new(self.base.x, -self.base.y);
        CurveDerivative {
            point: to_base.rotate(rise) - at_base * point.perp(),
            angle: (2.0 * by.bend).mul_add(x, by.slope) / (1.0 + t * t) - at_base,
        }
    }

    /// Returns point and unit tangent of the parabola at arclength `s`, in whisker lengths, in the frame of the base.
    pub fn at_arclength(&self, s: f64) -> (DVec2, DVec2) {
        let x = if self.bend == 0.0 {
            s / (1.0 + self.slope * self.slope).sqrt()
        } else {
            (self.slope_at(s) - self.slope) / (2.0 * self.bend)
        };
        self.at(x)
    }

    /// Returns the abscissa of the parabola at which the chord from the base is `chord`, both in whisker lengths. It is the root of `x^2
    /// (1 + (A x + t0)^2) = chord^2`, whose left side grows with `x` in every valid scene. With the vertex at the base the equation is
    /// quadratic in `x^2`; otherwise Halley's method solves it.
    pub fn x_of_chord(&self, chord: f64) -> f64 {
        if self.slope == 0.0 {
            let rise = 2.0 * self.bend * chord;
            return chord * (2.0 / (1.0 + (1.0 + rise * rise).sqrt())).sqrt();
        }
        let bracket = Bracket { below: 0.0, above: chord };
        let most = self.bend * chord + self.slope;
        let start = chord / (1.0 + most * most).sqrt();
        let halley = |x: f64| {
            let rise = self.bend * x;
            let slope = rise + self.slope;
            let square = 1.0 + slope * slope;
            // The left side less the right one. Its derivatives over `2 x` and 2.
            let miss = x * x * square - chord * chord;
            let first = square + rise * slope;
            let second = first + rise * (3.0 * slope + rise);
            let slowed = x * first;
            let step = -2.0 * miss * slowed / (4.0 * slowed * slowed - miss * second);
            (miss, x + step)
        };
        bracket.newton(start, |x| LAST_HALLEY_STEP * x, halley).x
    }
}
