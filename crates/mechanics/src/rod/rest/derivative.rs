//! Derivatives of the whisker at rest by a variable: of the point at a distance from the base, and of the pole at first touch.
//!
//! A variable moves each point of the curve by `point`, and turns its tangent `t` by `angle`, at a fixed place along the curve. At a
//! fixed distance `d` from the base, the place then moves by `ds = (d dd - r . dr)/(r . t)` along the curve.

use super::{Form, Rest};
use crate::rod::RodDerivative;
use glam::DVec2;

/// Derivative of the resting curve by a variable, at a fixed place along the curve.
#[derive(Clone, Copy, Debug)]
pub struct CurveDerivative {
    /// Derivative of a point of the resting curve, in whisker lengths per unit of the variable, in the frame of the base.
    pub point: DVec2,
    /// Derivative of the angle between the resting curve's tangent and the base's tangent, in radians per unit of the variable.
    pub angle: f64,
}

impl Rest {
    /// Point, tangent, and their derivatives at a `distance` from the base that changes by `by_distance`.
    fn derivative_at(
        &self,
        distance: f64,
        by_distance: f64,
        by: &RodDerivative,
    ) -> (DVec2, DVec2, CurveDerivative) {
        let (point, tangent, curvature, curve_derivative) = match &self.form {
            Form::Parabola(parabola) => {
                let x = parabola.x_of_chord(distance);
                let (point, tangent) = parabola.at(x);
                let curvature = parabola.curvature(parabola.arclength_at(x));
                (point, tangent, curvature, parabola.derivative(x, by))
            }
            Form::Arc(curve) => {
                let s = curve.arclength_of_chord(distance);
                let (point, tangent) = curve.at_arclength(s);
                (point, tangent, curve.curvature(s), curve.derivative(s, by))
            }
        };
        let along =
            (distance * by_distance - point.dot(curve_derivative.point)) / point.dot(tangent);
        let total = CurveDerivative {
            point: curve_derivative.point + along * tangent,
            angle: curve_derivative.angle + along * curvature,
        };
        (point, tangent, total)
    }

    /// Returns the derivative of [`Rest::point_at_distance`] by a variable that changes the rod by `by` and the distance by `by_distance`. Distance
    /// and point are in whisker lengths.
    #[must_use]
    pub fn point_derivative(&self, distance: f64, by_distance: f64, by: &RodDerivative) -> DVec2 {
        self.derivative_at(distance, by_distance, by).2.point
    }

    /// Returns the derivative of `(ln D, phi)` of the pole's centre at first touch ([`Rest::pole_at_distance`]) by a variable that changes
    /// the rod by `by` and the distance by `by_distance`; `phi` in radians. The distance lies on the whisker, not beyond its tip.
    #[must_use]
    pub fn touch_derivative(&self, distance: f64, by_distance: f64, by: &RodDerivative) -> DVec2 {
        let (point, tangent, curve_derivative) = self.derivative_at(distance, by_distance, by);
        let normal = tangent.perp();
        let pole = point - self.pole * normal;
        let moved = curve_derivative.point - by.pole * normal
            + self.pole * curve_derivative.angle * tangent;
        DVec2::new(pole.dot(moved), pole.perp_dot(moved)) / pole.length_squared()
    }
}
