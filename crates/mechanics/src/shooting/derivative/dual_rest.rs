//! Rest shapes in dual numbers, with the derivatives of their coefficients by the variable of each lane.

use super::varied_condition::VariedCondition;
use crate::numerics::{Dual, Lanes, Real};
use crate::rod::CURVATURE_TERMS;
use crate::shooting::batch::FEW_KERNELS;
use crate::shooting::contact::arc;
use crate::shooting::{Bent, Intrinsic, Polynomial, Spiral};

/// A rest shape whose numbers are dual.
pub trait DualRest<T: Lanes>: Intrinsic<Dual<T>> {
    /// Returns the rest shape of a trajectory and, at the arclength `s`: its state, and its curvature with the derivative by `s`.
    fn start(varied: &VariedCondition, s: Dual<T>) -> (Self, Self::State, [Dual<T>; 2]);
}

impl<T: Lanes> DualRest<T> for Bent<Dual<T>> {
    #[inline(always)]
    fn start(varied: &VariedCondition, s: Dual<T>) -> (Self, Self::State, [Dual<T>; 2]) {
        let bend = varied.number(|rod| rod.bend, |by| by.bend);
        let slope = varied.number(|rod| rod.slope, |by| by.slope);
        Self::at(bend, arc(slope), s)
    }
}

impl<T: Lanes> DualRest<T> for Spiral<Dual<T>> {
    #[inline(always)]
    fn start(varied: &VariedCondition, s: Dual<T>) -> (Self, Self::State, [Dual<T>; 2]) {
        let coefficient = |i: usize| {
            varied.number(move |rod| rod.spiral.unwrap_or_default()[i], move |by| by.spiral[i])
        };
        let spiral = Self { at_base: coefficient(0), slope: coefficient(1) };
        (spiral, (), spiral.at(s))
    }
}

/// No variable changes the coefficients: they are numbers without a unit, which a whisker of another length keeps.
impl<T: Lanes> DualRest<T> for Polynomial<Dual<T>> {
    #[inline(always)]
    fn start(varied: &VariedCondition, s: Dual<T>) -> (Self, Self::State, [Dual<T>; 2]) {
        let mut centred = [Dual::of(0.0); CURVATURE_TERMS];
        if let Some(polynomial) = &varied.condition.rod.polynomial {
            for (coefficient, value) in centred.iter_mut().zip(polynomial.centred()) {
                *coefficient = Dual::of(*value);
            }
        } else if FEW_KERNELS {
            let (Spiral { at_base, slope }, ..) = Spiral::start(varied, s);
            (centred[0], centred[1]) = (slope.mul_add(Dual::of(0.5), at_base), slope);
        }
        let polynomial = Self { centred };
        (polynomial, (), polynomial.at(s))
    }
}
