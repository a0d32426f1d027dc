//! Rest shapes of the rod: straight, parabola, Euler spiral, polynomial curvature.

use crate::numerics::{Real, Vector, horner, rotated_by_small};
use crate::rod::CURVATURE_TERMS;
use crate::shooting::Section;
use crate::shooting::contact::parabola_tangent;

/// Curvature of the rod at rest, as the integrator evaluates it.
pub trait Intrinsic<T: Real>: Copy {
    /// State that a trajectory carries to evaluate the rest shape.
    type State: Vector<T>;

    /// Rest shape along one step, computed at the start of the step.
    type Course;

    /// Returns `rho kappa_i` and the derivative of the rest shape's state by `sigma`, at a cross-section.
    fn rhs(self, section: &Section<T>, state: Self::State) -> (T, Self::State);

    /// Returns the rest shape along a step that starts at the section `from`.
    fn course(self, from: &Section<T>, state: Self::State) -> Self::Course;

    /// Returns the rotation of the tangent at rest, in radians, from the start of the step to `along`: the arclength toward the base over
    /// the radius at the start. `None` if the rod is straight.
    fn turn(course: &Self::Course, along: T) -> Option<T>;

    /// Returns the state of the rest shape at `along`: the arclength from the step's start toward the base, over the radius at the start.
    fn after(course: &Self::Course, along: T) -> Self::State;
}

/// A rod that is straight at rest.
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
    fn rhs(self, section: &Section<T>, [cos, sin]: [T; 2]) -> (T, [T; 2]) {
        let turn = section.rho * self.twice_bend * cos * cos * cos;
        (turn, [turn * sin, -turn * cos])
    }

    #[inline(always)]
    fn course(self, from: &Section<T>, tangent: [T; 2]) -> ParabolaSeries<T> {
        let [cos, sin] = tangent;
        let square = sin * sin;
        macro_rules! terms {
            ($($n:literal)*) => { [$(term::<T, $n>(sin, square)),*] };
        }
        let terms = terms!(0 1 2 3 4 5 6 7 8 9 10 11);
        ParabolaSeries {
            tangent,
            rate: -from.rho * self.twice_bend * cos * cos,
            terms,
        }
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

/// A rod that is an Euler spiral at rest: `kappa_i = k0 + k1 s` (E. L. Starostin et al., Science Advances 6, eaax5145, 2020).
#[derive(Clone, Copy, Debug)]
pub struct Spiral<T> {
    /// Curvature `k0` of the spiral at the base, in radians per whisker length.
    pub at_base: T,
    /// Derivative `k1` of the spiral's curvature by the arclength, in radians per squared whisker length.
    pub slope: T,
}

impl<T: Real> Spiral<T> {
    /// Returns the curvature of the spiral at the arclength `s`, and its derivative by `s`: `[curvature, derivative]`, in radians and whisker
    /// lengths.
    #[inline(always)]
    pub fn at(self, s: T) -> [T; 2] {
        [self.slope.mul_add(s, self.at_base), self.slope]
    }
}

impl<T: Real> Intrinsic<T> for Spiral<T> {
    type State = ();
    /// Arclength per `along`, curvature at the start of the step, and half of its derivative.
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

/// A rod whose curvature at rest is a polynomial of the arclength. A traced shape has such a curvature.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial<T> {
    /// Coefficients `[power]` of the curvature in powers of `s - 1/2`, in radians per whisker length to the power plus one.
    pub centred: [T; CURVATURE_TERMS],
}

impl<T: Real> Polynomial<T> {
    /// Returns the curvature of the polynomial at the arclength `s`, and its derivative by `s`: `[curvature, derivative]`, in radians and whisker
    /// lengths.
    #[inline(always)]
    pub fn at(self, s: T) -> [T; 2] {
        let [curvature, slope, ..] = self.around(s);
        [curvature, slope]
    }

    /// Coefficients `[power]` of the Taylor polynomial of the curvature around the arclength `s`: repeated synthetic division.
    #[inline(always)]
    fn around(self, s: T) -> [T; CURVATURE_TERMS] {
        let x = s - T::of(0.5);
        let [mut a, mut b, mut c, mut d, mut e, mut f, g] = self.centred;
        macro_rules! divide {
            ($higher:expr; $($lower:ident),*) => {{
                let sum = $higher;
                $(let sum = sum.mul_add(x, $lower); $lower = sum;)*
                let _ = sum;
            }};
        }
        divide!(g; f, e, d, c, b, a);
        divide!(g; f, e, d, c, b);
        divide!(g; f, e, d, c);
        divide!(g; f, e, d);
        divide!(g; f, e);
        divide!(g; f);
        [a, b, c, d, e, f, g]
    }
}

/// Taylor series of the rotation of the tangent along one step, for a rod with a polynomial curvature.
pub struct PolynomialSeries<T> {
    /// Arclength per `along`, see [`Intrinsic::turn`].
    per_along: T,
    /// Coefficients `[power]` of the rotation over the arclength from the start of the step.
    terms: [T; CURVATURE_TERMS],
}

impl<T: Real> Intrinsic<T> for Polynomial<T> {
    type State = ();
    type Course = PolynomialSeries<T>;

    #[inline(always)]
    fn rhs(self, section: &Section<T>, (): ()) -> (T, ()) {
        let x = section.arclength - T::of(0.5);
        let [a, b, c, d, e, f, g] = self.centred;
        (section.rho * horner!(x; g, f, e, d, c, b, a), ())
    }

    #[inline(always)]
    fn course(self, from: &Section<T>, (): ()) -> PolynomialSeries<T> {
        let [a, b, c, d, e, f, g] = self.around(from.arclength);
        PolynomialSeries {
            per_along: -from.rho,
            terms: [
                a,
                b * T::of(1.0 / 2.0),
                c * T::of(1.0 / 3.0),
                d * T::of(1.0 / 4.0),
                e * T::of(1.0 / 5.0),
                f * T::of(1.0 / 6.0),
                g * T::of(1.0 / 7.0),
            ],
        }
    }

    #[inline(always)]
    fn turn(course: &PolynomialSeries<T>, along: T) -> Option<T> {
        let way = course.per_along * along;
        let [a, b, c, d, e, f, g] = course.terms;
        Some(way * horner!(way; g, f, e, d, c, b, a))
    }

    #[inline(always)]
    fn after(_: &PolynomialSeries<T>, _: T) {}
}
