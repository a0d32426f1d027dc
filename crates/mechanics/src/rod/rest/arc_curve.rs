//! Curves at rest whose curvature is known by arclength, an Euler spiral or a polynomial. They are straight beyond the tip.

use super::arc_series::ArcSeries;
use super::derivative::CurveDerivative;
use crate::numerics::Bracket;
use crate::rod::{CURVATURE_TERMS, CurvaturePolynomial, RodDerivative};
use glam::DVec2;

/// Positive nodes and their weights of the Gauss-Legendre rule with 16 nodes on `[-1, 1]`.
const GAUSS: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_58),
    (0.458_016_777_657_227_37, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_8, 0.149_595_988_816_576_74),
    (0.755_404_408_355_003, 0.124_628_971_255_533_88),
    (0.865_631_202_387_831_8, 0.095_158_511_682_492_79),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_894),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_096),
];

/// Largest rotation of the curve per panel of the rule, in radians: the rule is then exact to rounding.
const TURN_PER_PANEL: f64 = 1.0;

/// Curvature of a curve at rest by arclength.
#[derive(Clone, Copy, Debug)]
enum ArcCurvature {
    /// Coefficients `[k0, k1]` of an Euler spiral.
    Spiral([f64; 2]),
    Polynomial(CurvaturePolynomial),
}

impl ArcCurvature {
    /// Curvature at arclength `s` on the curve.
    fn at(&self, s: f64) -> f64 {
        match self {
            Self::Spiral([k0, k1]) => k1.mul_add(s, *k0),
            Self::Polynomial(curvature) => curvature.at(s),
        }
    }

    /// Taylor terms `[power]` of the curvature around the arclength `s`.
    fn around(&self, s: f64) -> [f64; CURVATURE_TERMS] {
        match self {
            Self::Spiral([_, k1]) => {
                let mut terms = [0.0; CURVATURE_TERMS];
                terms[..2].copy_from_slice(&[self.at(s), *k1]);
                terms
            }
            Self::Polynomial(curvature) => curvature.around(s),
        }
    }

    /// Angle of the tangent at arclength `s` from the base's tangent, in radians.
    fn angle(&self, s: f64) -> f64 {
        match self {
            Self::Spiral([k0, k1]) => s * (0.5 * k1).mul_add(s, *k0),
            Self::Polynomial(curvature) => curvature.angle(s),
        }
    }

    /// Largest curvature between base and tip.
    fn sharpest(&self) -> f64 {
        match self {
            Self::Spiral([k0, k1]) => k0.abs().max((k0 + k1).abs()),
            Self::Polynomial(curvature) => curvature.sharpest(),
        }
    }
}

/// Curve at rest in the frame of the base, from its curvature by arclength.
#[derive(Clone, Debug)]
pub struct ArcCurve {
    curvature: ArcCurvature,
    series: ArcSeries,
    /// Point and unit tangent at the tip.
    tip: (DVec2, DVec2),
}

impl ArcCurve {
    /// Creates the spiral whose curvature is `k0 + k1 s` at arclength `s` (whisker lengths), in radians per whisker length.
    pub fn spiral(coefficients: [f64; 2]) -> Self {
        Self::new(ArcCurvature::Spiral(coefficients))
    }

    /// Creates the curve at rest whose curvature is this polynomial of the arclength.
    pub fn polynomial(curvature: CurvaturePolynomial) -> Self {
        Self::new(ArcCurvature::Polynomial(curvature))
    }

    fn new(curvature: ArcCurvature) -> Self {
        let series =
            ArcSeries::new(curvature.sharpest(), |s| curvature.around(s), |s| curvature.angle(s));
        Self { curvature, tip: series.at(1.0), series }
    }

    /// Returns the curvature of the curve at arclength `s` (whisker lengths), in radians per whisker length; 0 beyond the tip.
    pub fn curvature(&self, s: f64) -> f64 {
        if s > 1.0 {
            return 0.0;
        }
        self.curvature.at(s)
    }

    /// Integral of `integrand` from the base to the arclength `to` on the curve.
    fn integral(&self, to: f64, integrand: impl Fn(f64) -> DVec2) -> DVec2 {
        let most = self.curvature.sharpest() * to;
        let panels = (most / TURN_PER_PANEL).ceil().max(1.0) as u32;
        let half = 0.5 * to / f64::from(panels);
        (0..panels)
            .map(|panel| {
                let middle = f64::from(2 * panel + 1) * half;
                let pairs = GAUSS.map(|(node, weight)| {
                    let [before, after] =
                        [-node, node].map(|node| integrand(half.mul_add(node, middle)));
                    weight * (before + after)
                });
                half * pairs.into_iter().sum::<DVec2>()
            })
            .sum()
    }

    /// Returns point and unit tangent of the curve at arclength `s`, in whisker lengths, in the frame of the base.
    pub fn at_arclength(&self, s: f64) -> (DVec2, DVec2) {
        if s <= 1.0 {
            return self.series.at(s);
        }
        let (point, tangent) = self.tip;
        (point + (s - 1.0) * tangent, tangent)
    }

    /// Returns the derivative of the curve at the arclength `s` (whisker lengths) by a variable, in the frame of the base. No variable
    /// changes a polynomial.
    pub fn derivative(&self, s: f64, by: &RodDerivative) -> CurveDerivative {
        let [k0, k1] = match &self.curvature {
            ArcCurvature::Spiral(_) => by.spiral,
            ArcCurvature::Polynomial(_) => {
                return CurveDerivative { point: DVec2::ZERO, angle: 0.0 };
            }
        };
        let angle = |s: f64| s * (0.5 * k1).mul_add(s, k0);
        let turned = |s: f64| angle(s) * DVec2::from_angle(self.curvature.angle(s)).perp();
        let bent = s.min(1.0);
        CurveDerivative {
            point: self.integral(bent, turned) + (s - bent) * turned(bent),
            angle: angle(bent),
        }
    }

    /// Returns the arclength at which the curve's chord from the base is `chord`, both in whisker lengths. The chord grows along the
    /// curve in every valid scene.
    pub fn arclength_of_chord(&self, chord: f64) -> f64 {
        let reach = self.tip.0.length();
        // The function is the chord less the length, which falls.
        let bracket =
            Bracket { below: if chord < reach { 1.0 } else { chord + 1.0 }, above: chord };
        let newton = |s| {
            let (point, tangent) = self.at_arclength(s);
            let length = point.length();
            let next = s - (length - chord) * length / point.dot(tangent);
            (chord - length, next)
        };
        // The last step is at the level of rounding.
        bracket.newton(chord, |s| 2.0 * f64::EPSILON * s, newton).x
    }
}
