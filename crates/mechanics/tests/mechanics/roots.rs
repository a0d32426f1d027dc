//! Roots of functions of one variable, and polynomials.

use whiskmap_mechanics::numerics::chebyshev::{CHEBYSHEV_COUNT, LOBATTO_NODES};
use whiskmap_mechanics::numerics::newton_form::{
    Polynomial, RootProblem, through_nodes, through_runs,
};
use whiskmap_mechanics::numerics::{Bracket, Root, illinois};

const UNIT: Bracket = Bracket { below: 0.0, above: 1.0 };

/// Newton's method for `f`, which returns value and slope.
fn newton(bracket: Bracket, start: f64, f: impl Fn(f64) -> (f64, f64)) -> Root {
    bracket.newton(
        start,
        |_| 1e-8,
        |x| {
            let (value, slope) = f(x);
            (value, x - value / slope)
        },
    )
}

#[test]
fn newton_doubles_its_digits() {
    for turned in [1.0, -1.0] {
        let bracket = Bracket::new([0.0, 2.0], [-turned, turned]);
        let root = newton(bracket, 1.0, |x| (turned * (x * x - 2.0), turned * 2.0 * x));
        assert!((root.x - 2f64.sqrt()).abs() < 4.0 * f64::EPSILON);
        assert!(root.step.abs() < 1e-8 && root.iterations == 5, "{root:?}");
    }
}

#[test]
fn halley_triples_its_digits() {
    let root = Bracket::new([0.0, 2.0], [-2.0, 2.0]).newton(
        1.0,
        |x| 1e-5 * x,
        |x| {
            let miss = x * x - 2.0;
            (miss, x - 2.0 * x * miss / (3.0 * x * x + 2.0))
        },
    );
    assert!((root.x - 2f64.sqrt()).abs() < 4.0 * f64::EPSILON);
    assert_eq!(root.iterations, 3);
}

/// Newton's method for the arctangent diverges from places beyond 1.39.
#[test]
fn a_step_out_of_the_bracket_goes_to_its_middle() {
    let bracket = Bracket::new([-70.0, 100.0], [-1.0, 1.0]);
    let root = newton(bracket, 90.0, |x| (x.atan(), 1.0 / (1.0 + x * x)));
    assert!(root.x.abs() < 1e-15 && root.iterations < 15, "{root:?}");
}

#[test]
fn a_triple_root_is_found_slowly() {
    let root = newton(UNIT, 1.0, |x| ((x - 0.3).powi(3), 3.0 * (x - 0.3).powi(2)));
    assert!((root.x - 0.3).abs() < 3e-8 && root.iterations < 50, "{root:?}");
}

/// The function has an extremum there and does not change its sign.
#[test]
fn a_double_root_is_found() {
    let root = newton(UNIT, 1.0, |x| ((x - 0.3).powi(2), 2.0 * (x - 0.3)));
    assert!((root.x - 0.3).abs() < 3e-8 && root.iterations < 40, "{root:?}");
}

/// A slope of 0 or NaN proposes no step: bisection continues alone.
#[test]
fn without_slopes_it_bisects() {
    for slope in [0.0, f64::NAN, f64::INFINITY] {
        let value = |x: f64| x - 0.3;
        let root =
            newton(UNIT, 1.0, |x| (value(x), if slope.is_infinite() { -1e-9 } else { slope }));
        assert!((root.x - 0.3).abs() <= f64::EPSILON, "{slope} {root:?}");
        assert!((50..60).contains(&root.iterations), "{slope} {root:?}");
    }
}

#[test]
fn nan_counts_as_above() {
    let sqrt = |x: f64| ((0.3 - x).sqrt() - 0.5, -0.5 / (0.3 - x).sqrt());
    let bracket = Bracket { below: 1.0, above: 0.0 };
    let root = newton(bracket, 0.9, sqrt);
    assert!(root.x.is_finite() && root.iterations < 70, "{root:?}");
    let nowhere = newton(UNIT, 0.5, |_| (f64::NAN, f64::NAN));
    assert!((0.0..1.0).contains(&nowhere.x), "{nowhere:?}");
}

#[test]
fn a_root_at_an_end_is_found() {
    for (end, start) in [(0.0, 0.5), (1.0, 0.5), (0.0, 0.0), (1.0, 1.0)] {
        let root = newton(UNIT, start, |x| {
            let x = x - end;
            (x.exp_m1(), x.exp())
        });
        assert!((root.x - end).abs() < 1e-15, "{end} {root:?}");
    }
}

/// Rounding alternates between steps.
#[test]
fn the_iteration_ends_at_rounding() {
    let root = UNIT.newton(
        0.9,
        |_| 0.0,
        |x| {
            let value = (1e6 + x * x) - (1e6 + 0.09);
            (value, x - value / (2.0 * x))
        },
    );
    assert!((root.x - 0.3).abs() < 1e-9 && root.iterations < 60, "{root:?}");
}

#[test]
fn illinois_needs_few_values() {
    let f = |x: f64| Some((0.4 * x).exp() - 1.1);
    let ends = |f: &dyn Fn(f64) -> Option<f64>| [0.0, 1.0].map(|x| [x, f(x).unwrap_or(f64::NAN)]);
    let root = illinois(ends(&f), 1e-16, f);
    assert!(
        root.is_some_and(|root| {
            (root.x - 1.1f64.ln() / 0.4).abs() < 4.0 * f64::EPSILON && root.iterations <= 8
        }),
        "{root:?}"
    );
    // Next to an extremum at the end, where regula falsi without weights needs thousands of values.
    for below in [1e-1, 1e-2, 1e-3, 1e-4] {
        let f = |x: f64| Some(below - (1.0 - x).powi(2));
        let root = illinois(ends(&f), 1e-16, f);
        assert!(
            root.is_some_and(|root| {
                (1.0 - root.x - below.sqrt()).abs() < 1e-12 && root.iterations <= 14
            }),
            "{below} {root:?}"
        );
    }
    assert_eq!(illinois(ends(&f), 1e-16, |_| None), None);
    assert!(
        illinois([[0.0, -1.0], [1.0, 0.0]], 0.0, |x| Some(x - 1.0))
            .is_some_and(|root| root.x == 1.0)
    );
}

/// Polynomials go through the values, and those with slopes through the slopes as well.
#[test]
fn runs_go_through_their_samples() {
    let f = |t: usize| (0.3 * t as f64).sin();
    let slope = |t: usize| 0.3 * (0.3 * t as f64).cos();
    for count in [1, 3, 4, 5, 6, 9, 15] {
        let values: Vec<[f64; 1]> = (0..count).map(|t| [f(t)]).collect();
        let slopes: Vec<[f64; 1]> = (0..count).map(|t| [slope(t)]).collect();
        let plain = through_runs::<1, 6>(&values, &[]);
        let slanted = through_runs::<1, 12>(&values, &slopes);
        assert_eq!(plain.len(), count.saturating_sub(6) + 1);
        assert_eq!(slanted.len(), plain.len());
        for start in 0..plain.len() {
            let plain = Polynomial::on_even_nodes(1, plain[start].map(|[difference]| difference));
            let slanted =
                Polynomial::on_even_nodes(2, slanted[start].map(|[difference]| difference));
            for t in 0..count.min(6) {
                let there = start + t;
                assert!((plain.at(t as f64).0 - f(there)).abs() < 1e-14, "{there}");
                let (value, by_t) = slanted.at(t as f64);
                assert!((value - f(there)).abs() < 1e-14, "{there}");
                assert!((by_t - slope(there)).abs() < 1e-13, "{there}");
            }
        }
    }
}

/// The target is a sample or the number next to it, as for a row whose end is the resting tip.
#[test]
fn a_sample_is_found_where_it_is() {
    const COUNT: usize = 10;
    for sign in [1.0, -1.0] {
        let samples: Vec<f64> = (0..COUNT).map(|i| sign * (0.1 * i as f64 - 0.2).exp()).collect();
        let points = samples.iter().enumerate();
        let [polynomial] = through_nodes::<COUNT, 1>(points.map(|(i, value)| (i as f64, [*value])));
        for (k, sample) in samples.iter().enumerate() {
            for target in [sample.next_down(), *sample, sample.next_up()] {
                for low in [k.saturating_sub(1), k.min(COUNT - 2)] {
                    let ends = [low as f64, (low + 1) as f64];
                    let problem = RootProblem {
                        target,
                        near: low as f64 + 0.3,
                        bracket: Bracket::new(ends, [samples[low], samples[low + 1]]),
                    };
                    let t = polynomial.solve(&problem, 1e-4);
                    assert!((t - k as f64).abs() < 1e-6, "{t} instead of {k}");
                }
            }
        }
    }
}

#[test]
fn polynomials_go_through_their_values() {
    let f = |x: f64| (2.0 * x).sin();
    for first in [0, 3, CHEBYSHEV_COUNT - 2] {
        let count = CHEBYSHEV_COUNT - first;
        let values: Vec<f64> = LOBATTO_NODES[first..].iter().map(|node| f(*node)).collect();
        let points = LOBATTO_NODES[first..].iter().copied();
        let [polynomial] = through_nodes::<CHEBYSHEV_COUNT, 1>(points.map(|x| (x, [f(x)])));
        for (node, value) in LOBATTO_NODES[first..].iter().zip(&values) {
            assert!((polynomial.at(*node).0 - value).abs() < 1e-13, "{first} {node}");
        }
        if count == CHEBYSHEV_COUNT {
            for i in 0..=100 {
                let x = 0.01 * f64::from(i);
                let (value, slope) = polynomial.at(x);
                assert!((value - f(x)).abs() < 1e-12, "{x}");
                assert!((slope - 2.0 * (2.0 * x).cos()).abs() < 1e-10, "{x}");
            }
        }
    }
}

/// Values at uneven nodes, and between many of them those of the function.
#[test]
fn uneven_nodes_give_the_polynomial_through_them() {
    let f = |x: f64| [1.0 / (2.0 + x), (3.0 * x).sin()];
    for count in [1, 2, 5, 7] {
        let nodes = || (0..count).map(|i| 0.1 * f64::from(i * i + i));
        let polynomials = through_nodes::<7, 2>(nodes().map(|x| (x, f(x))));
        for node in nodes() {
            for (polynomial, value) in polynomials.iter().zip(f(node)) {
                let off = (polynomial.at(node).0 - value).abs();
                // Measured 1e-13 at the last of seven nodes.
                assert!(off < 3e-13, "{count} {node}: {off:e}");
            }
        }
    }
    let even = (0..16).map(|i| f64::from(i) / 15.0);
    let [polynomial, _] = through_nodes::<16, 2>(even.map(|x| (x, f(x))));
    for x in [0.01, 0.4, 0.97] {
        assert!((polynomial.at(x).0 - f(x)[0]).abs() < 1e-13, "{x}");
    }
}

#[test]
fn multisection_needs_signs_alone() {
    for [below, above] in [[0.0, 1.0], [1.0, 0.0]] {
        let mut bracket = Bracket { below, above };
        let is_below = |x: &&f64| (**x < 0.3) == (below < above);
        let count = |points: &[f64]| Ok::<_, ()>(points.iter().take_while(is_below).count());
        assert_eq!(bracket.multisect(1e-3, 16, count), Ok(()));
        assert!((bracket.below - bracket.above).abs() <= 1e-3 && bracket.contains(0.3));
        assert_eq!(bracket.multisect(0.0, 1, count), Ok(()));
        assert!((bracket.below - bracket.above).abs() <= f64::EPSILON && bracket.contains(0.3));
    }
    let mut bracket = UNIT;
    let last = |points: &[f64]| points.iter().find(|x| **x >= 0.9).map_or(Ok(0), |x| Err(*x));
    assert_eq!(bracket.multisect(0.0, 16, last), Err(16.0 / 17.0));
}
