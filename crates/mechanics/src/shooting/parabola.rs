//! Rest shape of a rod that is a parabola.

use crate::numerics::{Real, horner, rotated_by_small};
use crate::shooting::contact::parabola_tangent;
use crate::shooting::{Intrinsic, Section};

/// A rod that is a parabola at rest: `kappa_i = 2 A cos^3` (paper, Eq. 10). The state is the unit tangent at rest.
#[derive(Clone, Copy, Debug)]
pub struct Bent<T> {
    /// Twice the coefficient of the parabola at rest, `2 A*`, dimensionless.
    pub twice_bend: T,
}

impl<T: Real> Bent<T> {
    /// Returns the rest shape of the parabola `y = bend x^2 + slope x`, its state at the arclength `s`, and `[curvature, slope]` there. The slope of
    /// the curvature is by the arclength. Lengths are in whisker lengths, angles in radians. `at_base` is the [`arc`](crate::shooting::contact::arc)
    /// of `slope`.
    #[inline(always)]
    pub fn at(bend: T, at_base: T, s: T) -> (Self, [T; 2], [T; 2]) {
        let twice_bend = bend + bend;
        let [cos, sin] = parabola_tangent(bend, at_base, s);
        let curvature = twice_bend * cos * cos * cos;
        let slope = T::of(-3.0) * twice_bend * curvature * sin * cos * cos;
        (Self { twice_bend }, [cos, sin], [curvature, slope])
    }
}

/// Number of terms of the tangent's Taylor series along a parabola. It converges up to `2 A s = pi/4` at least. The remainder
/// of a step that turns by 0.1, 0.2 or 0.4 radians is 1e-13, 1e-9 or 8e-6.
pub const TERMS: usize = 12;

/// Coefficients of the polynomials `P_n/n!` of a parabola's tangent. With `k = 2 A cos^2(alpha)`, the derivatives of the tangent's angle
/// along it are `cos(alpha) k^n P_n(sin alpha)`. There `P_1 = 1` and `P_(n+1)(x) = (1 - x^2) P_n'(x) - (2n + 1) x P_n(x)`.
pub const TANGENT: [[f64; TERMS]; TERMS] = {
    let mut rows = [[0.0; TERMS]; TERMS];
    rows[0][0] = 1.0;
    let mut n = 1;
    while n < TERMS {
        let over = (n + 1) as f64;
        let mut power = 0;
        while power < n {
            let term = rows[n - 1][power] / over;
            rows[n][power + 1] -= (2 * n + 1 + power) as f64 * term;
            if power > 0 {
                rows[n][power - 1] += power as f64 * term;
            }
            power += 1;
        }
        n += 1;
    }
    rows
};

/// `P_(N+1)/(N+1)!` at `sin(alpha)`. Every other coefficient is 0.
#[inline(always)]
fn term<T: Real, const N: usize>(sin: T, square: T) -> T {
    let mut sum = T::of(TANGENT[N][N]);
    let mut power = N;
    while power > 1 {
        power -= 2;
        sum = sum.mul_add(square, T::of(TANGENT[N][power]));
    }
    if N % 2 == 1 { sum * sin } else { sum }
}

/// Taylor series of the tangent's angle along a parabola, from the start of a step.
pub struct ParabolaSeries<T> {
    /// Unit tangent at the start.
    tangent: [T; 2],
    /// `k` per `along`, see [`Intrinsic::turn`].
    rate: T,
    /// `P_n/n!` at the start.
    terms: [T; TERMS],
}

impl<T: Real> Intrinsic<T> for Bent<T> {
    type State = [T; 2];
    type Course = ParabolaSeries<T>;

    #[inline(always)]
    fn course(self, from: &Section<T>, tangent: [T; 2]) -> ParabolaSeries<T> {
        let [cos, sin] = tangent;
        let square = sin * sin;
        macro_rules! terms {
            ($($n:literal)*) => { [$(term::<T, $n>(sin, square)),*] };
        }
        let terms = terms!(0 1 2 3 4 5 6 7 8 9 10 11);
        ParabolaSeries { tangent, rate: -from.rho * self.twice_bend * cos * cos, terms }
    }

    #[inline(always)]
    fn turn(course: &ParabolaSeries<T>, along: T) -> Option<T> {
        let x = course.rate * along;
        let [a, b, c, d, e, f, g, h, i, j, k, l] = course.terms;
        let sum = horner!(x; l, k, j, i, h, g, f, e, d, c, b, a);
        Some(course.tangent[0] * x * sum)
    }

    #[inline(always)]
    fn after(course: &ParabolaSeries<T>, along: T) -> [T; 2] {
        match Self::turn(course, along) {
            Some(turn) => rotated_by_small(course.tangent, turn),
            None => course.tangent,
        }
    }
}
