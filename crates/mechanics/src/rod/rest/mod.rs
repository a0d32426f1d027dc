//! The whisker at rest: a parabola, an Euler spiral or a curve of polynomial curvature, by arclength and by chord, and the pole at first touch. The shape
//! continues beyond the tip for distances that need it.

mod arc_curve;
mod arc_series;
mod derivative;
mod parabola;

use crate::numerics::Bracket;
use crate::rod::Rod;
use crate::rod::rod::pointed;
use arc_curve::ArcCurve;
use glam::DVec2;
use parabola::Parabola;

/// The undeflected shape of a [`Rod`] in the frame of the base: the origin is the base, the first axis its tangent.
#[derive(Clone, Debug)]
pub struct Rest {
    form: Form,
    pole: f64,
    end: f64,
}

#[derive(Clone, Debug)]
enum Form {
    Parabola(Parabola),
    Arc(ArcCurve),
}

impl Rest {
    /// Computes the rest shape of `rod`.
    #[must_use]
    pub fn new(rod: &Rod) -> Self {
        Self {
            form: match (&rod.polynomial, rod.spiral) {
                (Some(curvature), _) => Form::Arc(ArcCurve::polynomial(**curvature)),
                (None, Some(coefficients)) => Form::Arc(ArcCurve::spiral(coefficients)),
                (None, None) => Form::Parabola(Parabola::new(rod)),
            },
            pole: rod.pole,
            end: pointed(rod.taper),
        }
    }

    /// Returns the arclength of the tip, in whisker lengths: 1, or slightly less for a perfect cone, which is cut.
    #[must_use]
    pub const fn end(&self) -> f64 {
        self.end
    }

    /// Returns the distance from the base to the tip of the resting whisker, in whisker lengths.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.at_arclength(self.end).0.length()
    }

    /// Returns the unit tangent of the parabola of `rod` at arclength `s`, in whisker lengths, in the frame of the parabola.
    #[must_use]
    #[inline(always)]
    pub fn parabola_tangent(rod: &Rod, s: f64) -> DVec2 {
        let slope = if rod.bend == 0.0 { rod.slope } else { Parabola::new(rod).slope_at(s) };
        let cos = 1.0 / (1.0 + slope * slope).sqrt();
        DVec2::new(cos, slope * cos)
    }

    /// Returns the curvature of the whisker at rest at arclength `s` (whisker lengths), in radians per whisker length.
    #[must_use]
    pub fn curvature(&self, s: f64) -> f64 {
        match &self.form {
            Form::Parabola(parabola) => parabola.curvature(s),
            Form::Arc(curve) => curve.curvature(s),
        }
    }

    /// Returns point and unit tangent of the whisker at rest at arclength `s`, in whisker lengths, in the frame of the base.
    #[must_use]
    pub fn at_arclength(&self, s: f64) -> (DVec2, DVec2) {
        match &self.form {
            Form::Parabola(parabola) => parabola.at_arclength(s),
            Form::Arc(curve) => curve.at_arclength(s),
        }
    }

    /// Arclength, point and unit tangent at `distance` from the base.
    fn at_distance(&self, distance: f64) -> (f64, DVec2, DVec2) {
        let (s, (point, tangent)) = match &self.form {
            Form::Parabola(parabola) => {
                let x = parabola.x_of_chord(distance);
                (parabola.arclength_at(x), parabola.at(x))
            }
            Form::Arc(curve) => {
                let s = curve.arclength_of_chord(distance);
                (s, curve.at_arclength(s))
            }
        };
        (s, point, tangent)
    }

    /// Returns the point of the whisker at rest at the straight `distance` from the base, both in whisker lengths, in the frame of the
    /// base.
    #[must_use]
    pub fn point_at_distance(&self, distance: f64) -> DVec2 {
        match &self.form {
            Form::Parabola(parabola) => parabola.at(parabola.x_of_chord(distance)).0,
            Form::Arc(_) => self.at_distance(distance).1,
        }
    }

    /// Returns the arclength of the contact, and the pole's centre when it first touches the whisker at `distance` from the base. All are
    /// in whisker lengths, the centre in the frame of the base.
    #[must_use]
    pub fn touch_at_distance(&self, distance: f64) -> (f64, DVec2) {
        let (s, point, tangent) = self.at_distance(distance);
        (s, point - self.pole * tangent.perp())
    }

    /// Returns the centre of the pole when it first touches the whisker at `distance` from the base. Both are in whisker lengths, the
    /// centre in the frame of the base.
    #[must_use]
    pub fn pole_at_distance(&self, distance: f64) -> DVec2 {
        self.touch_at_distance(distance).1
    }

    /// Returns the distance of the first touch from the base when the pole's centre is `pole_distance` from the base, both in whisker
    /// lengths. It is the inverse of the length of [`Rest::pole_at_distance`], which grows with the distance in every valid scene.
    #[must_use]
    pub fn distance_of_pole(&self, pole_distance: f64) -> f64 {
        let radius = self.pole.abs();
        let bracket =
            Bracket { below: (pole_distance - radius).max(0.0), above: pole_distance + radius };
        bracket.bisect(|distance| self.pole_at_distance(distance).length() - pole_distance)
    }
}
