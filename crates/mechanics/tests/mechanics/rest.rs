//! The whisker at rest.

use glam::DVec2;
use std::sync::Arc;
use whiskmap_mechanics::rod::{CurvaturePolynomial, Rest, Rod};

/// The vertex is at the base, or so near that Halley's method is used.
#[test]
fn a_chord_ends_on_the_parabola() {
    for bend in [0.0, 0.02, -0.4, 5.0] {
        for slope in [0.0, 1e-12, 0.3] {
            let rest = Rest::new(&Rod {
                bend,
                slope,
                ..Rod::default()
            });
            for chord in [1e-6, 0.3, 1.0] {
                // In the frame of the parabola.
                let base = DVec2::new(1.0, slope).normalize();
                let x = base.rotate(rest.point_at_distance(chord)).x;
                let length = DVec2::new(x, x * (bend * x + slope)).length();
                assert!(
                    (length / chord - 1.0).abs() < 4.0 * f64::EPSILON,
                    "{bend} {slope}: {length} for {chord}"
                );
            }
        }
    }
}

/// Legendre polynomials of `x` up to degree 6, from their closed forms.
fn legendre(x: f64) -> [f64; 7] {
    let y = x * x;
    [
        1.0,
        x,
        (3.0 * y - 1.0) / 2.0,
        x * (5.0 * y - 3.0) / 2.0,
        (y * (35.0 * y - 30.0) + 3.0) / 8.0,
        x * (y * (63.0 * y - 70.0) + 15.0) / 8.0,
        (y * (y * (231.0 * y - 315.0) + 105.0) - 5.0) / 16.0,
    ]
}

/// Each coefficient is that of a Legendre polynomial. The curve ends where 4096 midpoints of its tangent lead: 2e-8, measured.
#[test]
fn a_polynomial_curvature_gives_its_curve() {
    for degree in 0..7 {
        let mut coefficients = [0.0; 7];
        coefficients[degree] = 3.0;
        let curvature = CurvaturePolynomial::new(coefficients);
        let rest = Rest::new(&Rod {
            polynomial: Some(Arc::new(curvature)),
            ..Rod::default()
        });
        for s in [0.0, 0.1, 0.37, 0.5, 0.9, 1.0] {
            let expected = 3.0 * legendre(2.0 * s - 1.0)[degree];
            assert!((curvature.at(s) - expected).abs() < 1e-14, "{degree} {s}");
            let count = 4096;
            let h = s / f64::from(count);
            let (mut angle, mut point) = (0.0, DVec2::ZERO);
            for i in 0..count {
                let bend = h * rest.curvature(h * (f64::from(i) + 0.5));
                point += h * DVec2::from_angle(angle + 0.5 * bend);
                angle += bend;
            }
            assert!((curvature.angle(s) - angle).abs() < 1e-6, "{degree} {s}");
            let (found, tangent) = rest.at_arclength(s);
            assert!(found.distance(point) < 1e-6, "{degree} {s}: {found}");
            assert!(tangent.distance(DVec2::from_angle(angle)) < 1e-6);
            let back = rest.at_arclength(0.5 * s).0.length();
            if degree == 0 {
                assert!((rest.point_at_distance(back).length() - back).abs() < 1e-15);
            }
        }
        assert!(curvature.sharpest() >= 3.0 * (1.0 - 1e-12), "{degree}");
    }
}
