//! Chebyshev points, and expansions around a place.

use whiskmap_mechanics::numerics::expansion::{Chebyshev, chebyshev_points};

#[test]
fn points_grow_and_are_symmetric() {
    for count in [1, 16, 25, 40] {
        let points = chebyshev_points(count);
        assert!(points.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(points[0] > 0.0 && points[count - 1] < 1.0);
        for (low, high) in points.iter().zip(points.iter().rev()) {
            // Two roundings of a sine and of its square each.
            assert!((low + high - 1.0).abs() <= 2.0 * f64::EPSILON);
        }
    }
}

/// The quotient of a difference has the value of the derivative at its end, and gives the function back everywhere else.
#[test]
fn quotients_are_those_of_differences() {
    let f = |x: f64| [(3.0 * x).sin(), (-2.0 * x).exp()];
    let slope = |x: f64| [3.0 * (3.0 * x).cos(), -2.0 * (-2.0 * x).exp()];
    let values: Vec<[f64; 2]> = chebyshev_points(24).iter().map(|x| f(*x)).collect();
    let expansion = Chebyshev::through(&values);
    for end in [0.0, 0.3, 0.97, 1.0] {
        let (at_end, quotient) = expansion.quotient(end);
        assert_eq!(quotient.coefficients.len(), 23);
        let apart = |one: [f64; 2], other: [f64; 2]| {
            f64::max((one[0] - other[0]).abs(), (one[1] - other[1]).abs())
        };
        assert!(apart(at_end, f(end)) < 1e-14);
        assert!(apart(quotient.at(end), slope(end)) < 1e-12);
        for x in [0.0, 0.2, 0.55, 0.9, 1.0] {
            let quotient = quotient.at(x);
            let found = [0, 1].map(|i| at_end[i] + (x - end) * quotient[i]);
            assert!(apart(found, f(x)) < 1e-14, "{end} {x}: {found:?}");
        }
    }
    let constant = Chebyshev::through(&[[2.0]]);
    let (at_end, quotient) = constant.quotient(0.4);
    assert_eq!((at_end, quotient.at(0.7)), ([2.0], [0.0]));
}
