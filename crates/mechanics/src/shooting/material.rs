//! Materials: the bending stiffness along the rod.

use crate::numerics::Real;
use crate::shooting::{Section, StepStage};

/// Coefficients at a stage of a step of the equation after Liouville's transformation. With the inverse compliance `m^2` and
/// `chi = m (theta - theta_0)/f` it is `chi'' = (m''/m) chi - (rho/m) cos(theta)`, see [`Nystrom8`]. `m_0` and `rho_0` are
/// values at the start of the step.
///
/// [`Nystrom8`]: crate::shooting::Nystrom8
#[derive(Clone, Copy, Debug)]
pub struct Liouville<T> {
    /// Factor `m_0/m`, which turns `chi` back into an angle, dimensionless.
    pub inverse_scale: T,
    /// Factor `(rho/m)/(rho_0/m_0)` of `cos(theta)`, dimensionless.
    pub forcing: T,
    /// Factor `m''/m` of `chi`, dimensionless. `None` if it is 0.
    pub potential: Option<T>,
}

/// Material of the rod: its bending stiffness as a function of the cross-section.
pub trait Material<T: Real>: Copy {
    /// Returns the compliance `rho/S` at a section: `dtheta/dtau` per moment.
    fn compliance(self, section: &Section<T>) -> T;

    /// Returns Liouville's coefficients at a stage of a step that starts at `from`, on a rod of this taper, if it tapers.
    fn liouville(self, taper: Option<T>, from: &Section<T>, stage: &StepStage<T>) -> Liouville<T>;

    /// Returns `m'/m` and `m/m_0` at a stage, which turn `chi'` back into a lever. `None` if they are 0 and 1.
    fn liouville_scale(
        self,
        taper: Option<T>,
        from: &Section<T>,
        stage: &StepStage<T>,
        inverse_scale: T,
    ) -> Option<[T; 2]>;
}

/// Material with a constant modulus: its stiffness is `S = rho^4`.
#[derive(Clone, Copy, Debug)]
pub struct Uniform;

#[allow(
    clippy::manual_map,
    reason = "a closure is not inlined into functions that are compiled for a SIMD unit"
)]
impl<T: Real> Material<T> for Uniform {
    #[inline(always)]
    fn compliance(self, section: &Section<T>) -> T {
        section.inverse_cube
    }

    #[inline(always)]
    fn liouville(self, taper: Option<T>, _: &Section<T>, stage: &StepStage<T>) -> Liouville<T> {
        let shrunk = stage.shrunk;
        Liouville {
            inverse_scale: shrunk * shrunk * shrunk,
            forcing: shrunk,
            potential: match taper {
                Some(taper) => Some(T::of(2.25) * taper * taper),
                None => None,
            },
        }
    }

    #[inline(always)]
    fn liouville_scale(
        self,
        taper: Option<T>,
        _: &Section<T>,
        stage: &StepStage<T>,
        _: T,
    ) -> Option<[T; 2]> {
        match taper {
            Some(taper) => Some([T::of(1.5) * taper, stage.grown * stage.grown * stage.shrunk]),
            None => None,
        }
    }
}

/// Material with a modulus that is linear in the arclength: its stiffness is `S = rho^4 (1 + g s)`.
#[derive(Clone, Copy, Debug)]
pub struct Graded<T> {
    /// Gradient `g` of Young's modulus, per whisker length.
    pub gradient: T,
}

impl<T: Real> Graded<T> {
    /// The modulus `1 + g s` over the modulus at the base.
    #[inline(always)]
    fn modulus(self, section: &Section<T>) -> T {
        self.gradient.mul_add(section.arclength, T::of(1.0))
    }

    /// Inverse modulus at a section, and the rate at which its logarithm falls toward the base.
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
    fn liouville(self, taper: Option<T>, from: &Section<T>, stage: &StepStage<T>) -> Liouville<T> {
        let taper = taper.unwrap_or(T::of(0.0));
        let [inverse, fall] = self.fall(&from.at(stage));
        let uniform = Uniform.liouville(Some(taper), from, stage);
        let softer = (self.modulus(from) * inverse).sqrt();
        Liouville {
            inverse_scale: uniform.inverse_scale * softer,
            forcing: uniform.forcing * softer,
            potential: Some(
                T::of(2.25) * taper * taper - fall * T::of(0.25).mul_add(fall, taper + taper),
            ),
        }
    }

    #[inline(always)]
    fn liouville_scale(
        self,
        taper: Option<T>,
        from: &Section<T>,
        stage: &StepStage<T>,
        inverse_scale: T,
    ) -> Option<[T; 2]> {
        let taper = taper.unwrap_or(T::of(0.0));
        let [_, fall] = self.fall(&from.at(stage));
        let growth = T::of(1.5) * taper - T::of(0.5) * fall;
        Some([growth, T::of(1.0) / inverse_scale])
    }
}

/// Material with measured radii and a modulus that is linear in the arclength: `S = r(s)^4 (1 + g s)` on one cubic piece of `r`. It is
/// too rough for Liouville's transformation: see [`collocate`](crate::shooting::collocate).
#[derive(Clone, Copy, Debug)]
pub struct Measured<T> {
    /// Arclength at the start of the cubic piece, in whisker lengths.
    pub from: T,
    /// Coefficients `[power]` of the radius over the base radius, by the arclength from the start of the cubic piece.
    pub cubic: [T; 4],
    /// Gradient `g` of Young's modulus, per whisker length. `None` if the modulus is constant.
    pub gradient: Option<T>,
}

impl<T: Real> Measured<T> {
    /// Returns the compliance `r^-4` at the arclength `s`, in whisker lengths, for a modulus of 1.
    #[inline(always)]
    pub fn compliance(&self, s: T) -> T {
        let x = s - self.from;
        let [c0, c1, c2, c3] = self.cubic;
        let radius = x.mul_add(x.mul_add(x.mul_add(c3, c2), c1), c0);
        let square = radius * radius;
        T::of(1.0) / (square * square)
    }
}
