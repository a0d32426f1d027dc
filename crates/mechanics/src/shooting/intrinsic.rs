//! Rest shapes.

use crate::numerics::{Real, Vector, horner, rotated_by_small};
use crate::shooting::Section;

/// Curvature at rest.
pub trait Intrinsic<T: Real>: Copy {
    /// What has to be carried along to know it.
    type State: Vector<T>;

    /// What a step knows of it from its start.
    type Course;

    /// `(rho kappa_i, dstate/dsigma)`.
    fn rhs(self, section: &Section<T>, state: Self::State) -> (T, Self::State);

    /// The course of a step from a section.
    fn course(self, from: &Section<T>, state: Self::State) -> Self::Course;

    /// How far the tangent at rest turns on the way `along`, toward the base and over the radius at the start of the step.
    fn turn(course: &Self::Course, along: T) -> Option<T>;

    /// The state at its end.
    fn after(course: &Self::Course, along: T) -> Self::State;
}

/// Straight at rest: nothing to carry.
#[derive(Clone, Copy, Debug)]
pub struct Straight;

impl<T: Real> Intrinsic<T> for Straight {
    type State = ();
    type Course = ();

    #[inline(always)]
    fn rhs(self, _: &Section<T>, (): ()) -> (T, ()) {
        (T::of(0.0), ())
    }

    #[inline(always)]
    fn course(self, _: &Section<T>, (): ()) {}

    #[inline(always)]
    fn turn((): &(), _: T) -> Option<T> {
        None
    }

    #[inline(always)]
    fn after((): &(), _: T) {}
}

/// Parabola at rest: carries cos and sin of the rest tangent, `kappa_i = 2 A cos^3` (paper, Eq. 10).
#[derive(Clone, Copy, Debug)]
pub struct Bent<T> {
    /// `2 A*`.
    pub twice_bend: T,
}

/// Terms of the tangent's Taylor series along a parabola. It converges up to `2 A s = pi/4` at least; of a step that bends by
/// 0.1, 0.2 or 0.4, 1e-13, 1e-9 or 8e-6 is left out.
pub const TERMS: usize = 12;

/// With `k = 2 A cos^2(alpha)`, the tangent's derivatives along a parabola are `cos(alpha) k^n P_n(sin alpha)`, where
/// `P_1 = 1` and `P_(n+1)(x) = (1 - x^2) P_n'(x) - (2n + 1) x P_n(x)`. These are the coefficients of `P_n/n!`.
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

/// `P_(N+1)/(N+1)!` at `sin(alpha)`; every other coefficient is 0.
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

/// The Taylor series of the tangent along a parabola.
pub struct Series<T> {
    /// The tangent where it starts.
    tangent: [T; 2],
    /// `k`, with the sign of the way and in its unit.
    rate: T,
    /// `P_n/n!`.
    terms: [T; TERMS],
}

impl<T: Real> Intrinsic<T> for Bent<T> {
    type State = [T; 2];
    type Course = Series<T>;

    #[inline(always)]
    fn rhs(self, section: &Section<T>, [cos, sin]: [T; 2]) -> (T, [T; 2]) {
        let turn = section.rho * self.twice_bend * cos * cos * cos;
        (turn, [turn * sin, -turn * cos])
    }

    #[inline(always)]
    fn course(self, from: &Section<T>, tangent: [T; 2]) -> Series<T> {
        let [cos, sin] = tangent;
        let square = sin * sin;
        macro_rules! terms {
            ($($n:literal)*) => { [$(term::<T, $n>(sin, square)),*] };
        }
        let terms = terms!(0 1 2 3 4 5 6 7 8 9 10 11);
        Series {
            tangent,
            rate: -from.rho * self.twice_bend * cos * cos,
            terms,
        }
    }

    #[inline(always)]
    fn turn(course: &Series<T>, along: T) -> Option<T> {
        let x = course.rate * along;
        let [a, b, c, d, e, f, g, h, i, j, k, l] = course.terms;
        let sum = horner!(x; l, k, j, i, h, g, f, e, d, c, b, a);
        Some(course.tangent[0] * x * sum)
    }

    #[inline(always)]
    fn after(course: &Series<T>, along: T) -> [T; 2] {
        match Self::turn(course, along) {
            Some(turn) => rotated_by_small(course.tangent, turn),
            None => course.tangent,
        }
    }
}

/// Euler spiral at rest, `kappa_i = k0 + k1 s` (E. L. Starostin et al., Science Advances 6, eaax5145, 2020): nothing to
/// carry.
#[derive(Clone, Copy, Debug)]
pub struct Spiral<T> {
    /// `k0`.
    pub at_base: T,
    /// `k1`.
    pub slope: T,
}

impl<T: Real> Intrinsic<T> for Spiral<T> {
    type State = ();
    /// The way per `along`, the curvature at its start, and half of how that changes.
    type Course = [T; 3];

    #[inline(always)]
    fn rhs(self, section: &Section<T>, (): ()) -> (T, ()) {
        let curvature = self.slope.mul_add(section.arclength, self.at_base);
        (section.rho * curvature, ())
    }

    #[inline(always)]
    fn course(self, from: &Section<T>, (): ()) -> [T; 3] {
        let curvature = self.slope.mul_add(from.arclength, self.at_base);
        [-from.rho, curvature, T::of(0.5) * self.slope]
    }

    #[inline(always)]
    fn turn([per_along, curvature, slope]: &[T; 3], along: T) -> Option<T> {
        let way = *per_along * along;
        Some(way * slope.mul_add(way, *curvature))
    }

    #[inline(always)]
    fn after(_: &[T; 3], _: T) {}
}
