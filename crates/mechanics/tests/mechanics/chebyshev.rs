//! Chebyshev expansions against functions whose values, derivatives and coefficients are known.

use whiskmap_mechanics::numerics::WIDTH;
use whiskmap_mechanics::numerics::chebyshev::{Chebyshev, MOST_POINTS, chebyshev_points};

/// `exp(x)` and `exp(-2 x)`: the `i`-th Taylor coefficient is the value times the `i`-th power of the rate over `i!`.
const RATES: [f64; 2] = [1.0, -2.0];

fn exponentials(x: f64) -> [f64; 2] {
    RATES.map(|rate| (rate * x).exp())
}

fn through<const D: usize>(count: usize, f: impl Fn(f64) -> [f64; D]) -> Chebyshev<D> {
    let values: Vec<[f64; D]> = chebyshev_points(count).iter().map(|x| f(*x)).collect();
    Chebyshev::through(&values)
}

fn places() -> impl Iterator<Item = f64> {
    (0..=100).map(|i| f64::from(i) / 100.0)
}

#[test]
fn the_expansion_goes_through_its_values() {
    // An arbitrary function, analytic or not.
    let f = |x: f64| [(40.0 * x).sin(), (x - 0.3).abs()];
    for count in 1..=MOST_POINTS {
        let expansion = through(count, f);
        for x in chebyshev_points(count) {
            for (value, exact) in expansion.at(*x).iter().zip(f(*x)) {
                assert!(
                    (value - exact).abs() < 4e-14,
                    "{count} {x}: {value} {exact}"
                );
            }
        }
    }
}

#[test]
fn a_chebyshev_polynomial_has_one_coefficient() {
    let degree = 7;
    let expansion = through(12, |x| [(f64::from(degree) * (2.0 * x - 1.0).acos()).cos()]);
    for (k, [coefficient]) in expansion.coefficients.iter().enumerate() {
        let exact = if k == degree as usize { 1.0 } else { 0.0 };
        assert!((coefficient - exact).abs() < 4e-15, "{k}: {coefficient}");
    }
}

#[test]
fn points_grow_and_are_symmetric() {
    for count in 1..=MOST_POINTS {
        let points = chebyshev_points(count);
        assert!(points.windows(2).all(|pair| pair[0] < pair[1]), "{count}");
        assert!(points[0] > 0.0 && points[count - 1] < 1.0, "{count}");
        for (low, high) in points.iter().zip(points.iter().rev()) {
            // Two roundings of a sine and of its square each.
            assert!((low + high - 1.0).abs() <= 2.0 * f64::EPSILON, "{count}");
        }
    }
}

/// For `1/(x + 1/4)`, whose coefficients fall by factors of 2.62, the tail is 1 to 20 times the error.
#[test]
fn the_tail_estimates_the_error() {
    for count in [8, 12, 16, 20, 24] {
        let expansion = through(count, |x| [1.0 / (x + 0.25)]);
        let error = places()
            .map(|x| (expansion.at(x)[0] - 1.0 / (x + 0.25)).abs())
            .fold(0.0, f64::max);
        let [tail] = expansion.tail();
        assert!(
            error < tail && tail < 20.0 * error,
            "{count}: {error} {tail}"
        );
    }
    assert_eq!(through(1, |_| [3.0]).tail(), [0.0]);
}

#[test]
fn slopes_are_derivatives() {
    let expansion = through(20, exponentials);
    for x in places() {
        let [values, slopes] = expansion.with_slope(x);
        for ((value, slope), (exact, rate)) in values
            .iter()
            .zip(slopes)
            .zip(exponentials(x).iter().zip(RATES))
        {
            assert!(
                (value - exact).abs() < 4e-15 * exact.max(1.0),
                "{x}: {value} {exact}"
            );
            assert!((slope - rate * exact).abs() < 1e-12, "{x}: {slope}");
        }
    }
}

/// Largest errors by power. Rounding grows with each power by about the square of the number of points.
const ERRORS: [f64; 6] = [1e-14, 1e-12, 3e-11, 1e-9, 2e-8, 2e-7];

/// Around one place at a time, and around several side by side.
#[test]
fn taylor_coefficients_are_those_of_the_function() {
    let expansion = through(16, exponentials);
    let places: [f64; WIDTH] = std::array::from_fn(|i| i as f64 / (WIDTH - 1) as f64);
    let together = expansion.taylor_side_by_side::<6>(&places);
    for (x, together) in places.into_iter().zip(together) {
        let alone = expansion.taylor::<6>(x);
        let mut exact = exponentials(x);
        for power in 0..6 {
            for function in 0..2 {
                for terms in [&alone, &together] {
                    let (term, error) = (terms[power][function], ERRORS[power]);
                    assert!(
                        (term - exact[function]).abs() < error,
                        "{x} {power}: {term}"
                    );
                }
                exact[function] *= RATES[function] / (power + 1) as f64;
            }
        }
    }
}
