//! Guesses: a row of a map as a curve through the nodes of its level curve on the lattice, asked for push angles.

use super::abreast::{self, Search};
use super::lattice::LOADS;
use super::polynomial::{NODES, Polynomial, stencil};

/// A guess for one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
}

/// A level curve of `D`, sampled at steps of load.
#[derive(Clone, Debug)]
pub struct Level {
    /// Load step of the first node.
    pub first: usize,
    /// Push angle since first touch at each node, in radians, as a magnitude on the sheet's side.
    pub push: Vec<f64>,
    /// `tau` of the contact.
    pub tau: Vec<f64>,
    /// Signed load.
    pub load: Vec<f64>,
}

/// How far beyond the lattice's own detachment angle, in radians, a guess is still made: many times the
/// interpolation error, so that no cell of the sheet is missed.
const MARGIN: f64 = 1e-3;

impl Level {
    /// Guesses for growing push angles (at least 0, in radians, as magnitudes); `None` outside the sheet.
    pub fn guesses(&self, pushes: impl Iterator<Item = f64>) -> Vec<Option<Guess>> {
        let count = self.push.len();
        if count < 2 {
            return pushes.map(|_| None).collect();
        }
        let curve = Polynomial::through_each(&self.push);
        // The fold is the node at load step `LOADS`; intervals beyond it belong to the unstable sheet.
        let last = (LOADS - self.first.min(LOADS - 1)).min(count - 1);
        let piece = |interval: usize| {
            let start = stencil::<NODES>(interval, count);
            let ends = [self.push[interval], self.push[interval + 1]];
            let piece = Piece::new(&curve[start], start, interval, ends);
            if interval + 1 == last {
                piece.up_to_summit()
            } else {
                piece
            }
        };
        let mut interval = 0;
        let mut here = piece(0);
        let mut searches = Vec::new();
        let mut starts = Vec::new();
        let asked: Vec<bool> = pushes
            .map(|push| {
                let before = interval;
                while interval + 1 < last && push > self.push[interval + 1] {
                    interval += 1;
                }
                if interval > before {
                    here = piece(interval);
                }
                let search = here.search(push);
                searches.extend(search);
                starts.extend(search.map(|_| here.start));
                search.is_some()
            })
            .collect();
        let found = abreast::solve(&searches);
        let values = |values: &[f64]| {
            let through = Polynomial::through_each(values);
            let places = starts.iter().zip(&found);
            abreast::values(places.map(|(start, t)| (&through[*start], *t)))
        };
        let states = values(&self.tau).into_iter().zip(values(&self.load));
        let mut guesses = states.map(|(tau, load)| Guess { tau, load });
        let guess = |asked: bool| asked.then(|| guesses.next()).flatten();
        asked.into_iter().map(guess).collect()
    }
}

/// The level curve between two nodes. The first piece and the last one reach one step farther, the first one where its
/// polynomial still falls there, the last one up to the largest push angle of its own.
struct Piece<'a> {
    push: &'a Polynomial,
    /// First node of the polynomial.
    start: usize,
    /// Where it begins and ends, and the push angles there.
    ends: [f64; 2],
    pushes: [f64; 2],
    /// Whether the push angle is level at its end.
    has_summit: bool,
}

impl<'a> Piece<'a> {
    fn new(push: &'a Polynomial, start: usize, interval: usize, pushes: [f64; 2]) -> Self {
        let offset = (interval - start) as f64;
        let mut piece = Self {
            push,
            start,
            ends: [offset, offset + 1.0],
            pushes,
            has_summit: false,
        };
        if interval == 0 {
            let before = push.at(offset - 1.0).0;
            if before < pushes[0] {
                piece.ends[0] = offset - 1.0;
                piece.pushes[0] = before;
            }
        }
        piece
    }

    fn up_to_summit(mut self) -> Self {
        let summit = summit(self.push, self.ends[1] - 1.0);
        self.ends[1] = summit;
        self.pushes[1] = self.push.at(summit).0;
        self.has_summit = true;
        self
    }

    /// Where to look for a push angle; `None` where it is not near the piece.
    fn search(&self, push: f64) -> Option<Search<'a>> {
        let ([low, high], [from, to]) = (self.ends, self.pushes);
        if push < from - MARGIN || push > to + MARGIN {
            return None;
        }
        let target = push.max(from).min(to);
        let part = if from < to {
            (target - from) / (to - from)
        } else {
            1.0
        };
        let part = if self.has_summit {
            1.0 - (1.0 - part).sqrt()
        } else {
            part
        };
        Some(Search {
            polynomial: self.push,
            target,
            near: low + part * (high - low),
            between: [low, high],
        })
    }
}

/// Halvings: the push angle is flat at its summit, so that the place need not be known well.
const SUMMIT_ROUNDS: usize = 12;

/// Where the push angle is largest, within one step of the interval that begins at `offset`.
fn summit(push: &Polynomial, offset: f64) -> f64 {
    let (mut low, mut high) = (offset, offset + 2.0);
    if push.at(high).1 > 0.0 {
        return high;
    }
    for _ in 0..SUMMIT_ROUNDS {
        let middle = 0.5 * (low + high);
        if push.at(middle).1 > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(first: usize, push: &[f64]) -> Level {
        let along = || (0..push.len()).map(|i| (first + i) as f64);
        Level {
            first,
            push: push.to_vec(),
            tau: along().map(|i| 0.5 + 0.01 * i).collect(),
            load: along().map(|i| 0.1 * i).collect(),
        }
    }

    fn guess(level: &Level, push: f64) -> Option<Guess> {
        level.guesses([push].into_iter())[0]
    }

    #[test]
    fn guesses_are_on_the_curve_up_to_its_summit() {
        // The push angle is largest at load step 18.5.
        let push: Vec<f64> = (0..LOADS + 3)
            .map(|m| 1.0 - (1.0 - m as f64 / 18.5).powi(2))
            .collect();
        let level = level(0, &push);
        let is_at = |push: f64, load: f64, error: f64| {
            guess(&level, push).is_some_and(|guess| {
                (guess.load - load).abs() < error && (guess.tau - 0.5 - 0.1 * load).abs() < error
            })
        };
        for (m, push) in push[..=LOADS].iter().enumerate() {
            assert!(is_at(*push, 0.1 * m as f64, 1e-6), "{m}");
        }
        assert!(is_at(1.0 + 0.5 * MARGIN, 1.85, 1e-3));
        assert_eq!(guess(&level, 1.0 + 2.0 * MARGIN), None);
        let all = level.guesses((0..200).map(|i| i as f64 / 180.0));
        assert_eq!(all.iter().flatten().count(), 181);
    }

    #[test]
    fn few_nodes_and_falling_pushes_make_no_number_of_none() {
        let falling = [0.3, 0.29, 0.27, 0.24];
        let level_pushes = [0.1; 3];
        let turning = [0.0, 0.1, 0.2, 0.15, 0.1, 0.3, 0.2, 0.1, 0.0, -0.1];
        for push in [
            &falling[..],
            &falling[..2],
            &turning,
            &turning[..3],
            &level_pushes,
            &[0.1],
            &[],
        ] {
            for first in [0, 1, LOADS - 1, LOADS, LOADS + 1] {
                let pushes = (0..=400).map(|i| i as f64 / 1000.0);
                for guess in level(first, push).guesses(pushes).into_iter().flatten() {
                    assert!(push.len() > 1 && guess.tau.is_finite() && guess.load.is_finite());
                }
            }
        }
    }
}
