//! Chebyshev points, and Taylor expansions of functions whose values and derivatives are known.

use whiskmap_mechanics::numerics::expansion::{Chebyshev, MOST_POINTS, chebyshev_points};

/// `exp(x)` and `exp(-2 x)`: the `i`-th Taylor coefficient is the value times the `i`-th power of the rate over `i!`.
const RATES: [f64; 2] = [1.0, -2.0];

fn exponentials(x: f64) -> [f64; 2] {
    RATES.map(|rate| (rate * x).exp())
}

#[test]
fn points_grow_and_are_symmetric() {
    for count in 1..=MOST_POINTS {
        let points = chebyshev_points(count);
        assert!(points.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(points[0] > 0.0 && points[count - 1] < 1.0);
        for (low, high) in points.iter().zip(points.iter().rev()) {
            // Two roundings of a sine and of its square each.
            assert!((low + high - 1.0).abs() <= 2.0 * f64::EPSILON);
        }
    }
}

/// The Taylor expansions of a polynomial with all its powers are the polynomial, up to the ends of the interval.
#[test]
fn expansions_with_all_powers_are_the_polynomial() {
    const COUNT: usize = 16;
    let f = |x: f64| [(15.0 * (2.0 * x - 1.0).acos()).cos()];
    let points = chebyshev_points(COUNT);
    let values: Vec<[f64; 1]> = points.iter().map(|x| f(*x)).collect();
    let terms = Chebyshev::through(&values).taylor::<COUNT>(points);
    for (at, terms) in points.iter().zip(terms) {
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

/// Numbers of places that fill the lanes of no unit, of some, and of all.
#[test]
fn taylor_coefficients_are_those_of_the_function() {
    let values: Vec<[f64; 2]> = chebyshev_points(16)
        .iter()
        .map(|x| exponentials(*x))
        .collect();
    let functions = Chebyshev::through(&values);
    for count in [1, 3, 8, 17] {
        let places = chebyshev_points(count);
        let terms = functions.taylor::<6>(places);
        assert_eq!(terms.len(), count);
        for (x, terms) in places.iter().zip(terms) {
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
}
