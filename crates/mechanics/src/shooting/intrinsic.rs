//! Rest shapes of the rod: straight, Euler spiral, polynomial curvature. The parabola has a file of its own.

use crate::numerics::{Real, Vector, horner};
use crate::rod::CURVATURE_TERMS;
use crate::shooting::Section;

/// Curvature of the rod at rest, as the integrator evaluates it.
pub trait Intrinsic<T: Real>: Copy {
    /// State that a trajectory carries to evaluate the rest shape.
    type State: Vector<T>;

    /// Rest shape along one step, computed at the start of the step.
    type Course;

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
    fn course(self, _: &Section<T>, (): ()) {}

    #[inline(always)]
    fn turn((): &(), _: T) -> Option<T> {
        None
    }

    #[inline(always)]
    fn after((): &(), _: T) {}
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
    fn course(self, from: &Section<T>, (): ()) -> [T; 3] {
        let curvature = self.slope.mul_add(from.arclength, self.at_base);
        [-from.rho, curvature, T::of(0.5) * self.slope]
    }

    #[inline(always)]
    fn turn([per_along, curvature, slope]: &[T; 3], along: T) -> Option<T> {
        let distance = *per_along * along;
        Some(distance * slope.mul_add(distance, *curvature))
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
        let distance = course.per_along * along;
        let [a, b, c, d, e, f, g] = course.terms;
        Some(distance * horner!(distance; g, f, e, d, c, b, a))
    }

    #[inline(always)]
    fn after(_: &PolynomialSeries<T>, _: T) {}
}
