//! Fits of curves to points.

use super::{bent, points};
use crate::random_rods::Random;
use whiskmap::traced::TracedShape;

const SHAPES: [[f64; 7]; 5] = [
    [0.0; 7],
    [1.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.4, -0.9, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.7, -0.4, 0.15, -0.1, 0.05, 0.0, 0.0],
    [-0.9, 0.5, 0.2, 0.1, -0.1, 0.05, -0.05],
];

/// Exact points give the curve back, wherever they are. Measured: coefficients to 1.4e-13 radians, lengths to 1.5e-14 of them, distances
/// to 1.1e-14 mm, bases and their angles to 6e-15.
#[test]
fn exact_points_give_the_curve_back() {
    let mut worst = [0.0_f64; 3];
    for shape in SHAPES {
        let rod = bent(shape);
        for count in [12, 200] {
            let points = points(&rod, 20.0, count, 0.0, &mut Random(1));
            let found = TracedShape::fit(points, Some(6)).unwrap();
            for (own, expected) in found.coefficients().iter().zip(shape) {
                worst[0] = worst[0].max((own - expected).abs());
            }
            worst[1] = worst[1].max((found.length_mm / 20.0 - 1.0).abs());
            worst[2] = worst[2].max(found.rms_mm);
            assert!((found.base_angle + 0.4).abs() < 1e-13, "{found:?}");
            assert!(
                (found.base_mm[0] - 3.0).abs() < 1e-13 && (found.base_mm[1] + 8.0).abs() < 1e-13
            );
            let [first, ..] = found.points_at_rest_mm(20.0)[..] else {
                panic!("{found:?}")
            };
            assert!(first[0].abs() < 1e-13 && first[1].abs() < 1e-13);
        }
    }
    assert!(
        worst[0] < 2e-12 && worst[1] < 2e-13 && worst[2] < 2e-13,
        "{worst:?}"
    );
}

/// Cross-validation finds the degree of noisy points. A term is too small to be found if it moves the curve by less than the noise.
#[test]
fn noisy_points_give_the_degree_back() {
    let mut found = Vec::new();
    for (degree, shape) in [
        [0.9, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.6, -0.8, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.6, -0.5, 0.6, 0.0, 0.0, 0.0, 0.0],
        [0.6, -0.5, 0.4, -0.8, 0.0, 0.0, 0.0],
    ]
    .into_iter()
    .enumerate()
    {
        let rod = bent(shape);
        for seed in 0..10 {
            let points = points(&rod, 20.0, 120, 0.03, &mut Random(seed));
            let shape = TracedShape::fit(points, None).unwrap();
            assert!(
                shape.is_degree_chosen && shape.degree >= degree,
                "{shape:?}"
            );
            assert!((shape.rms_mm / 0.03 - 1.0).abs() < 0.25, "{}", shape.rms_mm);
            assert!((shape.length_mm / 20.0 - 1.0).abs() < 0.01);
            found.push(shape.degree == degree);
        }
    }
    let right = found.iter().filter(|own| **own).count();
    assert!(right >= 34, "{right} of 40");
}

/// Neither the unit of the points, nor their place and direction, change the fit: 8e-15 radians of a coefficient, 9e-16 of the rms, and
/// nothing of the length, measured.
#[test]
fn only_the_shape_counts() {
    let rod = bent(SHAPES[3]);
    let points = points(&rod, 20.0, 60, 0.05, &mut Random(5));
    let fit = TracedShape::fit(points.clone(), Some(3)).unwrap();
    let moved = points
        .iter()
        .map(|[x, y]| [300.0 - 10.0 * y, 10.0 * x - 70.0]);
    let other = TracedShape::fit(moved.collect(), Some(3)).unwrap();
    for (own, other) in fit.coefficients().iter().zip(other.coefficients()) {
        assert!((own - other).abs() < 1e-13, "{own} {other}");
    }
    assert!((other.length_mm / fit.length_mm / 10.0 - 1.0).abs() < 1e-14);
    assert!((other.rms_mm / fit.rms_mm / 10.0 - 1.0).abs() < 1e-14);
}

/// The minimum is one: moving any coefficient, and so the curve, makes the sum of squares larger. Coefficients of a fit of a higher
/// degree leave a smaller sum.
#[test]
fn more_terms_leave_smaller_distances() {
    let rod = bent(SHAPES[4]);
    let points = points(&rod, 20.0, 80, 0.1, &mut Random(9));
    let mut before = f64::INFINITY;
    for degree in 0..=6 {
        let fit = TracedShape::fit(points.clone(), Some(degree)).unwrap();
        assert_eq!(fit.coefficients().len(), degree + 1);
        assert!(fit.rms_mm <= before, "{degree}");
        assert!(fit.farthest_mm >= fit.rms_mm);
        before = fit.rms_mm;
    }
}
