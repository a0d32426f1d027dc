//! Stiffness along the rod.

use crate::numerics::Real;
use crate::shooting::Section;
use crate::shooting::Stage;

/// How the rod swings at a stage of a step, with `m^2` its inverse compliance.
#[derive(Clone, Copy, Debug)]
pub struct Swing<T> {
    /// `m` at the start of the step over `m`.
    pub light: T,
    /// The same times the radius over that at the start of the step.
    pub pull: T,
    /// `m''/m`.
    pub spring: Option<T>,
}

/// How the material stiffens along the rod.
pub trait Material<T: Real>: Copy {
    /// `rho/S` at a section: what turns a moment into `dtheta/dtau`.
    fn compliance(self, section: &Section<T>) -> T;

    /// At a stage of a step that starts at `from`.
    fn swing(self, taper: Option<T>, from: &Section<T>, stage: &Stage<T>) -> Swing<T>;

    /// `m'/m` there, and `m` over that at the start, whose inverse is `light`; none where they are 0 and 1.
    fn settle(
        self,
        taper: Option<T>,
        from: &Section<T>,
        stage: &Stage<T>,
        light: T,
    ) -> Option<[T; 2]>;
}

/// The same modulus everywhere: `S = rho^4`.
#[derive(Clone, Copy, Debug)]
pub struct Even;

#[allow(
    clippy::manual_map,
    reason = "a closure is not inlined into functions that are compiled for a SIMD unit"
)]
impl<T: Real> Material<T> for Even {
    #[inline(always)]
    fn compliance(self, section: &Section<T>) -> T {
        section.inverse_cube
    }

    #[inline(always)]
    fn swing(self, taper: Option<T>, _: &Section<T>, stage: &Stage<T>) -> Swing<T> {
        let shrunk = stage.shrunk;
        Swing {
            light: shrunk * shrunk * shrunk,
            pull: shrunk,
            spring: match taper {
                Some(taper) => Some(T::of(2.25) * taper * taper),
                None => None,
            },
        }
    }

    #[inline(always)]
    fn settle(self, taper: Option<T>, _: &Section<T>, stage: &Stage<T>, _: T) -> Option<[T; 2]> {
        match taper {
            Some(taper) => Some([T::of(1.5) * taper, stage.grown * stage.grown * stage.shrunk]),
            None => None,
        }
    }
}

/// A modulus that is linear in the arclength: `S = rho^4 (1 + g s)`.
#[derive(Clone, Copy, Debug)]
pub struct Graded<T> {
    /// `g`.
    pub gradient: T,
}

impl<T: Real> Graded<T> {
    /// `1 + g s`.
    #[inline(always)]
    fn modulus(self, section: &Section<T>) -> T {
        self.gradient.mul_add(section.arclength, T::of(1.0))
    }

    /// Its inverse at a stage, and how fast its logarithm falls toward the base.
    #[inline(always)]
    fn fall(self, section: &Section<T>) -> [T; 2] {
        let inverse = T::of(1.0) / self.modulus(section);
        [inverse, self.gradient * section.rho * inverse]
    }
}

impl<T: Real> Material<T> for Graded<T> {
    #[inline(always)]
    fn compliance(self, section: &Section<T>) -> T {
        section.inverse_cube / self.modulus(section)
    }

    #[inline(always)]
    fn swing(self, taper: Option<T>, from: &Section<T>, stage: &Stage<T>) -> Swing<T> {
        let taper = taper.unwrap_or(T::of(0.0));
        let [inverse, fall] = self.fall(&from.at(stage));
        let even = Even.swing(Some(taper), from, stage);
        let softer = (self.modulus(from) * inverse).sqrt();
        Swing {
            light: even.light * softer,
            pull: even.pull * softer,
            spring: Some(
                T::of(2.25) * taper * taper - fall * T::of(0.25).mul_add(fall, taper + taper),
            ),
        }
    }

    #[inline(always)]
    fn settle(
        self,
        taper: Option<T>,
        from: &Section<T>,
        stage: &Stage<T>,
        light: T,
    ) -> Option<[T; 2]> {
        let taper = taper.unwrap_or(T::of(0.0));
        let [_, fall] = self.fall(&from.at(stage));
        let growth = T::of(1.5) * taper - T::of(0.5) * fall;
        Some([growth, T::of(1.0) / light])
    }
}

/// Measured radii, and a modulus that is linear in the arclength: `S = r(s)^4 (1 + g s)` on one cubic piece of `r`.
#[derive(Clone, Copy, Debug)]
pub struct Measured<T> {
    /// Arclength where the piece begins.
    pub from: T,
    /// Coefficients of the radius there.
    pub cubic: [T; 4],
    /// `g`.
    pub gradient: T,
}

impl<T: Real> Measured<T> {
    #[inline(always)]
    fn graded(self) -> Graded<T> {
        let gradient = self.gradient;
        Graded { gradient }
    }

    /// The radius, and its first and second derivative by the arclength.
    #[inline(always)]
    fn radius(self, section: &Section<T>) -> [T; 3] {
        let x = section.arclength - self.from;
        let [c0, c1, c2, c3] = self.cubic;
        let (two, three) = (T::of(2.0), T::of(3.0));
        [
            x.mul_add(x.mul_add(x.mul_add(c3, c2), c1), c0),
            x.mul_add(x.mul_add(three * c3, two * c2), c1),
            two * x.mul_add(three * c3, c2),
        ]
    }
}

impl<T: Real> Material<T> for Measured<T> {
    #[inline(always)]
    fn compliance(self, section: &Section<T>) -> T {
        let [radius, _, _] = self.radius(section);
        let square = radius * radius;
        section.rho / (square * square * self.graded().modulus(section))
    }

    #[inline(always)]
    fn swing(self, taper: Option<T>, from: &Section<T>, stage: &Stage<T>) -> Swing<T> {
        let here = from.at(stage);
        let [inverse, fall] = self.graded().fall(&here);
        let [start, _, _] = self.radius(from);
        let [radius, slope, bend] = self.radius(&here);
        let thinner = start / radius;
        let light =
            thinner * thinner * (stage.grown * self.graded().modulus(from) * inverse).sqrt();
        let taper = taper.unwrap_or(T::of(0.0));
        let (half, two) = (T::of(0.5), T::of(2.0));
        let per_length = here.rho / radius;
        let narrowing = per_length * slope;
        let growth = -(two * narrowing + half * (fall + taper));
        // `-(m'/m)'`, to be taken from the square of `m'/m`.
        let change = two * (narrowing * (narrowing + taper) - here.rho * per_length * bend)
            + half * fall * (taper + fall);
        Swing {
            light,
            pull: light * stage.grown,
            spring: Some(growth * growth - change),
        }
    }

    #[inline(always)]
    fn settle(
        self,
        taper: Option<T>,
        from: &Section<T>,
        stage: &Stage<T>,
        light: T,
    ) -> Option<[T; 2]> {
        let here = from.at(stage);
        let [_, fall] = self.graded().fall(&here);
        let [radius, slope, _] = self.radius(&here);
        let taper = taper.unwrap_or(T::of(0.0));
        let narrowing = here.rho / radius * slope;
        let growth = -(narrowing + narrowing + T::of(0.5) * (fall + taper));
        Some([growth, T::of(1.0) / light])
    }
}
