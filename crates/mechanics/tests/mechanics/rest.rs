//! The whisker at rest.

use glam::DVec2;
use std::sync::Arc;
use whiskmap_mechanics::rod::{CurvaturePolynomial, Rest, Rod};

/// The vertex is at the base, or so near that Halley's method is used.
#[test]
fn a_chord_ends_on_the_parabola() {
    for bend in [0.0, 0.02, -0.4, 5.0] {
        for slope in [0.0, 1e-12, 0.3] {
            let rest = Rest::new(&Rod { bend, slope, ..Rod::default() });
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

/// Nodes on `[-1, 1]` and weights of the Gauss-Legendre rule with 5 nodes.
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Integral from 0 to `to`, in this number of panels.
fn integral<V: std::iter::Sum + std::ops::Mul<f64, Output = V>>(
    to: f64,
    panels: u32,
    value: impl Fn(f64) -> V,
) -> V {
    let half = 0.5 * to / f64::from(panels);
    let at = |(panel, (node, weight)): (u32, (f64, f64))| {
        value(half * (f64::from(2 * panel + 1) + node)) * (half * weight)
    };
    let nodes = (0..panels).flat_map(|panel| GAUSS.map(|node| (panel, node)));
    nodes.map(at).sum()
}

/// Checks points and tangents against integrals of the curvature and of the tangent. Returns the largest error.
fn error(rest: &Rest) -> f64 {
    let angle = |s: f64| integral(s, 1, |s| rest.curvature(s));
    let places = [0.0, 0.1, 0.37, 0.5, 0.75, 0.9, 1.0];
    let errors = places.map(|s| {
        let (point, tangent) = rest.at_arclength(s);
        let expected = integral(s, 64, |s| DVec2::from_angle(angle(s)));
        let turned = tangent.distance(DVec2::from_angle(angle(s)));
        turned.max(point.distance(expected))
    });
    errors.into_iter().fold(0.0, f64::max)
}

/// Each coefficient is that of a Legendre polynomial. Points and tangents of the curve are within 2e-14 (measured) of integrals, also of
/// the sharpest one that a scene may have.
#[test]
fn a_polynomial_curvature_gives_its_curve() {
    for (degree, size) in (0..7).flat_map(|degree| [0.5, 3.0, 20.0].map(|size| (degree, size))) {
        let mut coefficients = [0.0; 7];
        coefficients[degree] = size;
        let curvature = CurvaturePolynomial::new(coefficients);
        let rest = Rest::new(&Rod { polynomial: Some(Arc::new(curvature)), ..Rod::default() });
        for s in [0.0, 0.1, 0.37, 0.5, 0.9, 1.0] {
            let expected = size * legendre(2.0 * s - 1.0)[degree];
            let error = (curvature.at(s) - expected).abs();
            assert!(error < 5e-15 * size, "{degree} {s}: {error:e}");
        }
        let error = error(&rest);
        assert!(error < 4e-14, "{degree} {size}: {error:e}");
        assert!(curvature.sharpest() >= size * (1.0 - 1e-12), "{degree}");
    }
}

/// Points and tangents of Euler spirals are within 6e-15 (measured) of integrals. The point at the distance of a point is that point, also
/// beyond the tip.
#[test]
fn a_spiral_gives_its_curve() {
    for spiral in [[0.0, 0.0], [1.0, -2.0], [-0.3, 4.0], [-20.0, 40.0]] {
        let rest = Rest::new(&Rod { spiral: Some(spiral), ..Rod::default() });
        let error = error(&rest);
        assert!(error < 1e-14, "{spiral:?}: {error:e}");
        for s in [0.1, 0.5, 1.0, 1.3] {
            let (point, _) = rest.at_arclength(s);
            if spiral[1] < 40.0 {
                let found = rest.point_at_distance(point.length());
                assert!(found.distance(point) < 1e-15, "{spiral:?} {s}: {found}");
            }
        }
    }
}
