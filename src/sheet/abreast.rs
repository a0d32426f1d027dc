//! Polynomials side by side: one alone would wait for its own products most of the time.

use super::polynomial::{LAST_STEP, NODES, Polynomial};

/// How many go together.
const ABREAST: usize = 8;

/// Rounds of Newton's method for all of them; what is not found then is looked for alone.
const ROUNDS: usize = 4;

type Lanes = [f64; ABREAST];

/// A place that is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Search<'a> {
    /// On which polynomial.
    pub polynomial: &'a Polynomial,
    /// Its value there.
    pub target: f64,
    /// Where to start.
    pub near: f64,
    /// The places it is between, at which the polynomial lies on different sides of the target.
    pub between: [f64; 2],
}

/// The places that are looked for.
pub fn solve(searches: &[Search]) -> Vec<f64> {
    let mut places = Vec::with_capacity(searches.len());
    for searches in searches.chunks(ABREAST) {
        places.extend_from_slice(&together(searches)[..searches.len()]);
    }
    places
}

/// The value of every polynomial at its place.
pub fn values<'a>(pairs: impl ExactSizeIterator<Item = (&'a Polynomial, f64)>) -> Vec<f64> {
    let mut values = Vec::with_capacity(pairs.len());
    let mut differences = [[0.0; ABREAST]; NODES];
    let mut places = [0.0; ABREAST];
    let mut lane = 0;
    for (polynomial, place) in pairs {
        spread(&mut differences, lane, polynomial);
        places[lane] = place;
        lane += 1;
        if lane == ABREAST {
            values.extend_from_slice(&value(&differences, &places));
            lane = 0;
        }
    }
    values.extend_from_slice(&value(&differences, &places)[..lane]);
    values
}

fn spread(differences: &mut [Lanes; NODES], lane: usize, polynomial: &Polynomial) {
    for (lanes, difference) in differences.iter_mut().zip(polynomial.differences()) {
        lanes[lane] = *difference;
    }
}

fn together(searches: &[Search]) -> Lanes {
    let mut differences = [[0.0; ABREAST]; NODES];
    let [mut targets, mut places, mut low, mut high] = [[0.0; ABREAST]; 4];
    for (lane, search) in searches.iter().enumerate() {
        spread(&mut differences, lane, search.polynomial);
        targets[lane] = search.target;
        places[lane] = search.near;
        [low[lane], high[lane]] = search.between;
    }
    let mut steps = [f64::INFINITY; ABREAST];
    for _ in 0..ROUNDS {
        let (values, slopes) = value_and_slope(&differences, &places);
        for lane in 0..ABREAST {
            let next = places[lane] - (values[lane] - targets[lane]) / slopes[lane];
            steps[lane] = (next - places[lane]).abs();
            places[lane] = next;
        }
        let known = steps
            .iter()
            .take(searches.len())
            .all(|step| *step < LAST_STEP);
        if known {
            break;
        }
    }
    for (lane, search) in searches.iter().enumerate() {
        let is_inside = low[lane] <= places[lane] && places[lane] <= high[lane];
        if !(is_inside && steps[lane] < LAST_STEP) {
            places[lane] = search
                .polynomial
                .solve(search.target, search.near, search.between);
        }
    }
    places
}

fn value(differences: &[Lanes; NODES], places: &Lanes) -> Lanes {
    let mut values = differences[NODES - 1];
    for i in (0..NODES - 1).rev() {
        for lane in 0..ABREAST {
            values[lane] = values[lane] * (places[lane] - i as f64) + differences[i][lane];
        }
    }
    values
}

fn value_and_slope(differences: &[Lanes; NODES], places: &Lanes) -> (Lanes, Lanes) {
    let (mut values, mut slopes) = (differences[NODES - 1], [0.0; ABREAST]);
    for i in (0..NODES - 1).rev() {
        for lane in 0..ABREAST {
            let x = places[lane] - i as f64;
            slopes[lane] = slopes[lane] * x + values[lane];
            values[lane] = values[lane] * x + differences[i][lane];
        }
    }
    (values, slopes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polynomials that rise from 0 at 0 to 3 at 9, level at their end but for one.
    fn polynomials(count: usize) -> Vec<Polynomial> {
        let through = |i: usize| {
            let power = 1.0 + (0.618 * i as f64).fract() * 6.0;
            let values = (0..NODES).map(|t| 1.0 - (1.0 - t as f64 / 9.0).powf(power));
            Polynomial::through(values.map(|value| 3.0 * value))
        };
        (0..count).map(through).collect()
    }

    #[test]
    fn what_is_found_together_is_found_alone() {
        for count in [1, 7, 8, 9, 50] {
            let polynomials = polynomials(count);
            let parts = [0.0, 0.1, 0.5, 0.999, 1.0].into_iter().cycle();
            let search = |(polynomial, part): (_, f64)| Search {
                polynomial,
                target: 3.0 * part,
                near: 4.5,
                between: [0.0, 9.0],
            };
            let searches: Vec<Search> = polynomials.iter().zip(parts).map(search).collect();
            let found = solve(&searches);
            let pairs = searches.iter().zip(&found);
            let there = values(pairs.map(|(search, t)| (search.polynomial, *t)));
            assert_eq!([found.len(), there.len()], [count; 2]);
            for (i, search) in searches.iter().enumerate() {
                assert!((0.0..=9.0).contains(&found[i]), "{i}: {}", found[i]);
                assert!((there[i] - search.target).abs() < 1e-6, "{i}: {}", found[i]);
                assert_eq!(there[i], search.polynomial.at(found[i]).0, "{i}");
            }
        }
    }
}
