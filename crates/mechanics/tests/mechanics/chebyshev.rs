//! Chebyshev points, and Taylor expansions of functions whose values and derivatives are known.

use whiskmap_mechanics::numerics::chebyshev::{
    CHEBYSHEV_COUNT, CHEBYSHEV_POINTS, taylor_at_points,
};

/// `exp(x)` and `exp(-2 x)`: the `i`-th Taylor coefficient is the value times the `i`-th power of the rate over `i!`.
const RATES: [f64; 2] = [1.0, -2.0];

fn exponentials(x: f64) -> [f64; 2] {
    RATES.map(|rate| (rate * x).exp())
}

#[test]
fn points_grow_and_are_symmetric() {
    let points = *CHEBYSHEV_POINTS;
    assert!(points.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(points[0] > 0.0 && points[CHEBYSHEV_COUNT - 1] < 1.0);
    for (low, high) in points.iter().zip(points.iter().rev()) {
        // Two roundings of a sine and of its square each.
        assert!((low + high - 1.0).abs() <= 2.0 * f64::EPSILON);
    }
}

#[test]
fn expansions_go_through_their_values() {
    // An arbitrary function, analytic or not.
    let f = |x: f64| [(40.0 * x).sin(), (x - 0.3).abs()];
    let values = CHEBYSHEV_POINTS.map(f);
    let terms: [[[f64; 2]; 1]; CHEBYSHEV_COUNT] = taylor_at_points(&values);
    for ([term], values) in terms.iter().zip(&values) {
        assert_eq!(term, values);
    }
}

/// Every Taylor expansion of a polynomial of full degree is the polynomial, up to the ends of the interval.
#[test]
fn expansions_with_all_powers_are_the_polynomial() {
    let f = |x: f64| [(15.0 * (2.0 * x - 1.0).acos()).cos()];
    let terms: [[[f64; 1]; CHEBYSHEV_COUNT]; CHEBYSHEV_COUNT] =
        taylor_at_points(&CHEBYSHEV_POINTS.map(f));
    for (at, terms) in CHEBYSHEV_POINTS.iter().zip(terms) {
        for x in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let sum = |sum: f64, term: &[f64; 1]| sum * (x - at) + term[0];
            let value = terms.iter().rev().fold(0.0, sum);
            let away = (value - f(x)[0]).abs();
            // Measured 1.5e-5, from one end of the interval to the other.
            assert!(away < 5e-5, "{at} {x}: {away:e}");
        }
    }
}

/// Largest errors by power. Rounding grows with each power by about the square of the number of points.
const ERRORS: [f64; 6] = [1e-14, 1e-12, 3e-11, 1e-9, 2e-8, 2e-7];

#[test]
fn taylor_coefficients_are_those_of_the_function() {
    let terms: [[[f64; 2]; 6]; CHEBYSHEV_COUNT] =
        taylor_at_points(&CHEBYSHEV_POINTS.map(exponentials));
    for (x, terms) in CHEBYSHEV_POINTS.iter().zip(terms) {
        let mut exact = exponentials(*x);
        for (power, (terms, error)) in terms.iter().zip(ERRORS).enumerate() {
            for function in 0..2 {
                let off = (terms[function] - exact[function]).abs();
                assert!(off < error, "{x} {power}: {off:e}");
                exact[function] *= RATES[function] / (power + 1) as f64;
            }
        }
    }
}
