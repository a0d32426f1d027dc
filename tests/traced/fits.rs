//! Fits of curves to points.

use super::{bent, points};
use crate::random_rods::Random;
use glam::DVec2;
use whiskmap::mechanics::rod::{Rest, Rod};
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
            let points = points(&rod, 20.0, count, 0.0, &mut Random::new(1));
            let found = TracedShape::fit(points, Some(6)).unwrap();
            for (coefficient, expected) in found.coefficients().iter().zip(shape) {
                worst[0] = worst[0].max((coefficient - expected).abs());
            }
            worst[1] = worst[1].max((found.length_mm / 20.0 - 1.0).abs());
            worst[2] = worst[2].max(found.rms_mm);
            assert!((found.base_angle + 0.4).abs() < 1e-13, "{found:?}");
            assert!(
                (found.base_mm[0] - 3.0).abs() < 1e-13 && (found.base_mm[1] + 8.0).abs() < 1e-13
            );
            let [first, ..] = found.points_at_rest_mm(20.0)[..] else { panic!("{found:?}") };
            assert!(first[0].abs() < 1e-13 && first[1].abs() < 1e-13);
        }
    }
    assert!(worst[0] < 2e-12 && worst[1] < 2e-13 && worst[2] < 2e-13, "{worst:?}");
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
            let points = points(&rod, 20.0, 120, 0.03, &mut Random::new(seed));
            let shape = TracedShape::fit(points, None).unwrap();
            assert!(shape.is_degree_chosen && shape.degree >= degree, "{shape:?}");
            assert!((shape.rms_mm / 0.03 - 1.0).abs() < 0.25, "{}", shape.rms_mm);
            assert!((shape.length_mm / 20.0 - 1.0).abs() < 0.01);
            found.push(shape.degree == degree);
        }
    }
    let right = found.iter().filter(|is_right| **is_right).count();
    assert!(right >= 34, "{right} of 40");
}

/// Neither the unit of the points, nor their place and direction, change the fit: 8e-15 radians of a coefficient, 9e-16 of the rms, and
/// nothing of the length, measured.
#[test]
fn only_the_shape_counts() {
    let rod = bent(SHAPES[3]);
    let points = points(&rod, 20.0, 60, 0.05, &mut Random::new(5));
    let fit = TracedShape::fit(points.clone(), Some(3)).unwrap();
    let moved = points.iter().map(|[x, y]| [300.0 - 10.0 * y, 10.0 * x - 70.0]);
    let other = TracedShape::fit(moved.collect(), Some(3)).unwrap();
    for (coefficient, other) in fit.coefficients().iter().zip(other.coefficients()) {
        assert!((coefficient - other).abs() < 1e-13, "{coefficient} {other}");
    }
    assert!((other.length_mm / fit.length_mm / 10.0 - 1.0).abs() < 1e-14);
    assert!((other.rms_mm / fit.rms_mm / 10.0 - 1.0).abs() < 1e-14);
}

/// The minimum is one: moving any coefficient, and so the curve, makes the sum of squares larger. Coefficients of a fit of a higher
/// degree leave a smaller sum.
#[test]
fn more_terms_leave_smaller_distances() {
    let rod = bent(SHAPES[4]);
    let points = points(&rod, 20.0, 80, 0.1, &mut Random::new(9));
    let mut before = f64::INFINITY;
    for degree in 0..=6 {
        let fit = TracedShape::fit(points.clone(), Some(degree)).unwrap();
        assert_eq!(fit.coefficients().len(), degree + 1);
        assert!(fit.rms_mm <= before, "{degree}");
        assert!(fit.farthest_mm >= fit.rms_mm);
        before = fit.rms_mm;
    }
}

/// The distances of the points from the curve that the shape describes are those of the fit. The curve is drawn as 4000 lines from the
/// fitted base.
#[test]
fn distances_are_those_from_the_curve() {
    let points = points(&bent(SHAPES[3]), 20.0, 40, 0.1, &mut Random::new(3));
    let shape = TracedShape::fit(points, Some(3)).unwrap();
    let rod = Rod { polynomial: Some(shape.curvature.into()), ..Rod::default() };
    let rest = Rest::new(&rod);
    // Points beyond an end have their feet on the curve's continuation.
    let knots = (-40..=4040).map(|i| f64::from(i) / 4000.0);
    let knots: Vec<DVec2> = knots
        .map(|s| {
            let (at, tangent) = rest.at_arclength(s.clamp(0.0, 1.0));
            shape.length_mm * (at + (s - s.clamp(0.0, 1.0)) * tangent)
        })
        .collect();
    let distance = |point: DVec2| {
        let lines = knots.windows(2).map(|pair| {
            let along = pair[1] - pair[0];
            let part = (point - pair[0]).dot(along) / along.length_squared();
            point.distance(pair[0] + part.clamp(0.0, 1.0) * along)
        });
        lines.fold(f64::INFINITY, f64::min)
    };
    let at_rest = shape.points_at_rest_mm(shape.length_mm);
    let distances = at_rest.iter().map(|point| distance((*point).into()));
    let distances: Vec<f64> = distances.collect();
    let squares = distances.iter().map(|distance| distance * distance).sum::<f64>();
    let rms = (squares / distances.len() as f64).sqrt();
    let farthest = distances.iter().fold(0.0_f64, |most, distance| distance.max(most));
    assert!((rms / shape.rms_mm - 1.0).abs() < 1e-5, "{rms} {shape:?}");
    assert!((farthest / shape.farthest_mm - 1.0).abs() < 1e-4, "{farthest}");
}

/// A reflection of the points reflects the curve. The frame of a longer whisker scales the points.
#[test]
fn reflected_and_longer_shapes_have_the_same_distances() {
    let points = points(&bent(SHAPES[3]), 20.0, 40, 0.1, &mut Random::new(3));
    let reflected = points.iter().map(|[x, y]| [*x, -y]).collect();
    let [fit, other] = [points, reflected].map(|all| TracedShape::fit(all, Some(3)).unwrap());
    // Measured: below 1e-13.
    assert!((fit.farthest_mm / other.farthest_mm - 1.0).abs() < 1e-13);
    let length = fit.length_mm;
    let [same, twice] = [length, 2.0 * length].map(|length| fit.points_at_rest_mm(length));
    for (coordinate, other) in same.iter().flatten().zip(twice.iter().flatten()) {
        assert!((2.0 * coordinate - other).abs() < 1e-12, "{coordinate} {other}");
    }
}

/// Coefficients of another machine may differ by 1e-6 radians, and have the same number.
#[test]
fn coefficients_of_an_equal_fit_are_accepted() {
    let points = points(&bent(SHAPES[1]), 20.0, 12, 0.0, &mut Random::new(1));
    let shape = TracedShape::fit(points, Some(0)).unwrap();
    let [coefficient] = shape.coefficients()[..] else {
        panic!("{shape:?}");
    };
    let is_accepted = |coefficients: &[f64]| shape.clone().with_coefficients(coefficients).is_ok();
    assert!(is_accepted(&[coefficient]) && is_accepted(&[coefficient + 0.9e-6]));
    assert!(
        !is_accepted(&[coefficient + 1.1e-6])
            && !is_accepted(&[coefficient, 0.0])
            && !is_accepted(&[])
    );
}

/// Distances from the first point that fall by at most 2% of the largest are noise, however many points they take.
#[test]
fn a_small_fall_is_noise() {
    let line = |falls: &[f64]| {
        let points = (0..=20).map(|i| [f64::from(i), 0.0]);
        let falling = falls.iter().map(|fall| [20.0 - fall, 1e-3]);
        TracedShape::fit(points.chain(falling).collect(), Some(0))
    };
    assert!(line(&[0.39]).is_ok());
    for falls in [&[0.41][..], &[0.3, 0.5]] {
        let why = line(falls).unwrap_err();
        assert_eq!(why.point, Some(20 + falls.len()), "{why}");
    }
}

/// The least numbers of points, and the largest coordinate, are accepted.
#[test]
fn the_ends_of_ranges_are_accepted() {
    let straight = |count: u32, step: f64| {
        let points = (0..count).map(|i| [step * f64::from(i), 0.0]);
        points.collect::<Vec<[f64; 2]>>()
    };
    assert!(TracedShape::fit(straight(8, 1.0), None).is_ok());
    assert!(TracedShape::fit(straight(7, 1.0), Some(3)).is_ok());
    assert!(TracedShape::fit(straight(11, 1e5), Some(0)).is_ok());
    let why = TracedShape::fit(straight(12, 1e5), Some(0)).unwrap_err();
    assert_eq!(why.point, Some(11), "{why}");
}
