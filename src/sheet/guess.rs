//! Guesses: a row of a map as a curve through the nodes of its level curve on the lattice, asked for push angles.

use super::abreast::{Along, Numbers};
use super::loads::{Curve, LAST_STEP, LOADS, PARTS};
use crate::model::batch::Unit;
use crate::model::simd::WIDTH;

/// A guess for one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
}

/// A level curve of `D`, sampled at neighbouring loads of the lattice.
#[derive(Clone, Copy, Debug, Default)]
pub struct Level {
    /// Which load the first node has.
    pub first: usize,
    /// Nodes.
    pub count: usize,
    /// Push angle since first touch at each node, in radians, as a magnitude on the sheet's side.
    pub push: Numbers,
    /// `tau` of the contact.
    pub tau: Numbers,
    /// Signed load.
    pub load: Numbers,
}

/// How far beyond the lattice's own detachment angle, in radians, a guess is still made: many times the
/// interpolation error, so that no cell of the sheet is missed.
const MARGIN: f64 = 1e-4;

impl Level {
    /// Guesses for growing push angles (at least 0, in radians, as magnitudes); `None` outside the sheet.
    pub fn guesses(&self, pushes: impl Iterator<Item = f64>) -> Vec<Option<Guess>> {
        if self.count < 2 {
            return pushes.map(|_| None).collect();
        }
        let through = |values: &Numbers| Curve::through(self.first, &values[..self.count]);
        let curves = Curves {
            push: through(&self.push),
            tau: through(&self.tau),
            load: through(&self.load),
        };
        let pieces = self.pieces(&curves.push);
        let mut guesses = Vec::with_capacity(pushes.size_hint().0);
        let mut block = Block::default();
        let mut at = 0;
        for push in pushes {
            while at + 2 < self.count && push > pieces[at].pushes[1] {
                at += 1;
            }
            if let Some(search) = pieces[at].search(push) {
                block.take(guesses.len(), search);
                guesses.push(Some(Guess {
                    tau: 0.0,
                    load: 0.0,
                }));
                if block.count == WIDTH {
                    block.find(&curves, &mut guesses);
                }
            } else {
                guesses.push(None);
            }
        }
        block.find(&curves, &mut guesses);
        guesses
    }

    /// The curve between its nodes. The first piece begins at the load before, where the push angle still falls there.
    fn pieces(&self, push: &Curve) -> [Piece; LOADS] {
        let mut pieces = [Piece::default(); LOADS];
        let parts = &PARTS[self.first..];
        let summit = self.push[..self.count]
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        let below = |push: f64| (summit - push).max(0.0).sqrt();
        for (i, piece) in pieces[..self.count - 1].iter_mut().enumerate() {
            let (mut from, mut start) = (self.push[i], parts[i]);
            if i == 0 && self.first > 0 {
                let before = PARTS[self.first - 1];
                let push = push.at(before).0;
                if push < from {
                    (from, start) = (push, before);
                }
            }
            let to = self.push[i + 1];
            *piece = Piece {
                ends: [start, parts[i + 1]],
                pushes: [from, to],
                below: [below(from), below(to)],
                summit,
            };
        }
        pieces
    }
}

/// The level curve of a row, as polynomials in the load.
struct Curves {
    push: Curve,
    tau: Curve,
    load: Curve,
}

/// The level curve between two nodes.
#[derive(Clone, Copy, Debug, Default)]
struct Piece {
    /// Where it begins and ends, as parts of the fold's load.
    ends: [f64; 2],
    /// The push angles there.
    pushes: [f64; 2],
    /// The largest push angle of the curve.
    summit: f64,
    /// The roots of how far below it the ends are: at the fold the push angle is flat, and the place goes with this root.
    below: [f64; 2],
}

/// A push angle that is looked for.
#[derive(Clone, Copy, Debug, Default)]
struct Search {
    target: f64,
    near: f64,
    between: [f64; 2],
}

impl Piece {
    /// Where to look for a push angle; `None` where it is not near the piece.
    fn search(&self, push: f64) -> Option<Search> {
        let ([low, high], [from, to]) = (self.ends, self.pushes);
        if push < from - MARGIN || push > to + MARGIN {
            return None;
        }
        let target = push.max(from).min(to);
        let [below_low, below_high] = self.below;
        let below = (self.summit - target).max(0.0).sqrt();
        let part = if below_high < below_low {
            (below_low - below) / (below_low - below_high)
        } else {
            1.0
        };
        Some(Search {
            target,
            near: low + part * (high - low),
            between: self.ends,
        })
    }
}

/// Searches that go together.
#[derive(Default)]
struct Block {
    count: usize,
    searches: [Search; WIDTH],
    /// Indices of their guesses.
    cells: [usize; WIDTH],
}

impl Block {
    fn take(&mut self, cell: usize, search: Search) {
        self.cells[self.count] = cell;
        self.searches[self.count] = search;
        self.count += 1;
    }

    /// Finds what is looked for.
    fn find(&mut self, curves: &Curves, guesses: &mut [Option<Guess>]) {
        let Some(last) = self.count.checked_sub(1) else {
            return;
        };
        let lane = |lane: usize| &self.searches[lane.min(last)];
        let found = Unit::detect().run(Along {
            push: &curves.push,
            tau: &curves.tau,
            load: &curves.load,
            targets: std::array::from_fn(|i| lane(i).target),
            near: std::array::from_fn(|i| lane(i).near),
        });
        for (i, search) in self.searches[..self.count].iter().enumerate() {
            let place = found.place[i];
            let [low, high] = search.between;
            let is_known = found.step[i].abs() < LAST_STEP && low <= place && place <= high;
            let [tau, load] = if is_known {
                [found.tau[i], found.load[i]]
            } else {
                let place = curves
                    .push
                    .solve(search.target, search.near, search.between);
                [curves.tau.at(place).0, curves.load.at(place).0]
            };
            guesses[self.cells[i]] = Some(Guess { tau, load });
        }
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(first: usize, pushes: &[f64]) -> Level {
        let mut level = Level {
            first,
            count: pushes.len(),
            ..Level::default()
        };
        for (i, (push, part)) in pushes.iter().zip(&PARTS[first..]).enumerate() {
            level.push[i] = *push;
            level.tau[i] = 0.1f64.mul_add(*part, 0.5);
            level.load[i] = *part;
        }
        level
    }

    fn guess(level: &Level, push: f64) -> Option<Guess> {
        level.guesses([push].into_iter())[0]
    }

    #[test]
    fn guesses_are_on_the_curve_up_to_its_summit() {
        // The load that a push of this asks for.
        let load = |push: f64| 1.0 - (1.0 - push).sqrt();
        for first in [0, 1, 4] {
            let pushes: Vec<f64> = PARTS[first..]
                .iter()
                .map(|part| 1.0 - (1.0 - part).powi(2))
                .collect();
            let level = level(first, &pushes);
            let least = pushes[0];
            for i in 0..=1000 {
                let push = 1e-3 * f64::from(i);
                let found = guess(&level, push).filter(|_| push >= least);
                assert_eq!(found.is_some(), push >= least, "{first} {push}");
                if let Some(Guess { tau, load: found }) = found {
                    assert!((found - load(push)).abs() < 1e-6, "{push}: {found}");
                    assert!((tau - 0.5 - 0.1 * found).abs() < 1e-12, "{push}: {tau}");
                }
            }
            // One load before the first, where the curve goes on.
            let before = PARTS[first.saturating_sub(1)];
            let least = 1.0 - (1.0 - before).powi(2);
            assert!(guess(&level, least).is_some_and(|guess| (guess.load - before).abs() < 1e-6));
            assert!(
                guess(&level, 1.0 + 0.5 * MARGIN)
                    .is_some_and(|guess| (guess.load - 1.0).abs() < 1e-6)
            );
            assert_eq!(guess(&level, 1.0 + 2.0 * MARGIN), None);
        }
        let pushes: Vec<f64> = PARTS.iter().map(|x| 1.0 - (1.0 - x).powi(2)).collect();
        let all = level(0, &pushes).guesses((0..200).map(|i| f64::from(i) / 180.0));
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
            for first in [0, 1, LOADS - push.len()] {
                let pushes = (0..=400).map(|i| f64::from(i) / 1000.0);
                for guess in level(first, push).guesses(pushes).into_iter().flatten() {
                    assert!(push.len() > 1 && guess.tau.is_finite() && guess.load.is_finite());
                    assert!(guess.load != 0.0 || guess.tau == 0.5);
                }
            }
        }
    }
}
