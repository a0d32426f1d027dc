//! Guesses: a row of a map as a curve through the nodes of its level curve on the lattice, asked for push angles.

use crate::numerics::lobatto::{Curve, LAST_STEP, LOADS, PARTS, through};
use crate::numerics::newton_form_simd::Numbers;
use crate::numerics::{Unit, WIDTH};
use crate::sheet::lattice::bracket::{Nodes, Search};
use crate::sheet::lattice::simd_roots::Along;

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

/// Nodes of a polynomial near the end of a row that leaves the lattice.
const NEAR_CUT: usize = 7;

impl Level {
    /// Guesses for growing push angles (at least 0, in radians, as magnitudes); `None` outside the sheet.
    pub fn guesses(&self, pushes: impl Iterator<Item = f64>) -> Vec<Option<Guess>> {
        if self.count < 2 {
            return pushes.map(|_| None).collect();
        }
        let nodes = self.nodes();
        let mut piece = 0;
        let searches = pushes.map(|push| {
            while piece + 2 < self.count && push > nodes.push[piece + 1] {
                piece += 1;
            }
            nodes.search(piece, push).map(|search| (piece, search))
        });
        if self.count == LOADS {
            self.whole(searches)
        } else {
            self.cut(searches)
        }
    }

    /// The guesses of a row from first touch to the fold: one polynomial is as good at its ends as in its middle.
    fn whole(&self, searches: impl Iterator<Item = Option<(usize, Search)>>) -> Vec<Option<Guess>> {
        let curves = self.curves(0, LOADS);
        let mut guesses = Vec::with_capacity(searches.size_hint().0);
        let mut block = Block::default();
        for search in searches {
            if let Some((_, search)) = search {
                block.take(guesses.len(), search);
            }
            guesses.push(None);
            if block.count == WIDTH {
                block.find(&curves, &mut guesses);
            }
        }
        block.find(&curves, &mut guesses);
        guesses
    }

    /// Those of a row that leaves the lattice, from the nodes around.
    fn cut(&self, searches: impl Iterator<Item = Option<(usize, Search)>>) -> Vec<Option<Guess>> {
        let count = self.count.min(NEAR_CUT);
        let mut known: Option<(usize, Curves)> = None;
        let mut guess = |(piece, search): (usize, Search)| {
            let from = piece
                .saturating_sub(NEAR_CUT / 2 - 1)
                .min(self.count - count);
            let (_, curves) = match &known {
                Some(there) if there.0 == from => there,
                _ => known.insert((from, self.curves(from, count))),
            };
            curves.alone(&search)
        };
        searches.map(|search| search.map(&mut guess)).collect()
    }

    /// Polynomials through `count` nodes from the node `from` on.
    fn curves(&self, from: usize, count: usize) -> Curves {
        let values = |numbers: &Numbers| {
            let mut values = [0.0; LOADS];
            values[..count].copy_from_slice(&numbers[from..from + count]);
            values
        };
        let [push, tau, load] = through(
            self.first + from,
            count,
            [&self.push, &self.tau, &self.load].map(values),
        );
        Curves { push, tau, load }
    }

    /// The nodes. Where the row leaves the lattice, the one there is one load farther, if the push angle falls before it or grows
    /// after it.
    fn nodes(&self) -> Nodes {
        let (first, count) = (self.first, self.count);
        let near_cut = count.min(NEAR_CUT);
        let mut nodes = Nodes {
            part: [0.0; WIDTH],
            push: self.push,
            summit: 0.0,
            below: [0.0; WIDTH],
        };
        nodes.part[..count].copy_from_slice(&PARTS[first..first + count]);
        if let Some(before) = first.checked_sub(1) {
            let push = self.curves(0, near_cut).push.at(PARTS[before]).0;
            if push < self.push[0] {
                (nodes.part[0], nodes.push[0]) = (PARTS[before], push);
            }
        }
        if let Some(after) = PARTS.get(first + count) {
            let push = self.curves(count - near_cut, near_cut).push.at(*after).0;
            if push > self.push[count - 1] {
                (nodes.part[count - 1], nodes.push[count - 1]) = (*after, push);
            }
        }
        let pushes = &nodes.push[..count];
        let summit = pushes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        nodes.summit = summit;
        nodes.below = nodes.push.map(|push| (summit - push).max(0.0).sqrt());
        nodes
    }
}

/// The level curve of a row, as polynomials in the load.
struct Curves {
    push: Curve,
    tau: Curve,
    load: Curve,
}

impl Curves {
    /// What is looked for, by itself.
    fn alone(&self, search: &Search) -> Guess {
        let place = self
            .push
            .solve(search.target, search.near, search.between, LAST_STEP);
        Guess {
            tau: self.tau.at(place).0,
            load: self.load.at(place).0,
        }
    }
}

/// Searches that go together.
#[derive(Default)]
struct Block {
    count: usize,
    targets: Numbers,
    near: Numbers,
    between: [[f64; 2]; WIDTH],
    /// Indices of their guesses.
    cells: [usize; WIDTH],
}

impl Block {
    fn take(&mut self, cell: usize, search: Search) {
        self.targets[self.count] = search.target;
        self.near[self.count] = search.near;
        self.between[self.count] = search.between;
        self.cells[self.count] = cell;
        self.count += 1;
    }

    /// Finds what is looked for.
    fn find(&mut self, curves: &Curves, guesses: &mut [Option<Guess>]) {
        if self.count == 0 {
            return;
        }
        let found = Unit::detect().run(Along {
            push: &curves.push,
            tau: &curves.tau,
            load: &curves.load,
            targets: self.targets,
            near: self.near,
        });
        for i in 0..self.count {
            let place = found.place[i];
            let [below, above] = self.between[i];
            let is_inside = (place - below) * (place - above) <= 0.0;
            let is_known = found.step[i].abs() < LAST_STEP && is_inside;
            guesses[self.cells[i]] = Some(if is_known {
                Guess {
                    tau: found.tau[i],
                    load: found.load[i],
                }
            } else {
                curves.alone(&Search {
                    target: self.targets[i],
                    near: self.near[i],
                    between: self.between[i],
                })
            });
        }
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::lattice::bracket::MARGIN;
    use std::f64::consts::FRAC_PI_2;

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
        // The push angle grows to 1 at the fold, where it is flat.
        let push = |load: f64| (FRAC_PI_2 * load).sin();
        let load = |push: f64| push.asin() / FRAC_PI_2;
        for (first, count) in [(0, LOADS), (1, LOADS - 1), (4, 12), (0, 9), (5, 4), (3, 2)] {
            let pushes: Vec<f64> = PARTS[first..first + count]
                .iter()
                .map(|part| push(*part))
                .collect();
            let level = level(first, &pushes);
            // Rows that leave the lattice are known one load farther than their nodes, and less well.
            let error = if count == LOADS {
                1e-6
            } else {
                1e-2 / count as f64
            };
            let ends = [first.saturating_sub(1), (first + count).min(LOADS - 1)];
            let [least, most] = ends.map(|m| push(PARTS[m]));
            for i in 0..=1000 {
                let push = 1e-3 * f64::from(i);
                let found = guess(&level, push);
                let slack = 0.02;
                if push > least + slack && push < most - slack || push == 1.0 && most == 1.0 {
                    assert!(found.is_some(), "{first} {count} {push}");
                } else if push < least - slack || push > most + slack {
                    assert_eq!(found, None, "{first} {count} {push}");
                }
                if let Some(Guess { tau, load: found }) = found {
                    let away = (found - load(push)).abs();
                    let flat = (1.0 - push).sqrt().max(0.03);
                    assert!(away * flat < error, "{first} {count} {push}: {found}");
                    assert!((tau - 0.5 - 0.1 * found).abs() < 1e-9, "{push}: {tau}");
                }
            }
        }
        let whole: Vec<f64> = PARTS.iter().map(|part| push(*part)).collect();
        let whole = level(0, &whole);
        let at_summit = guess(&whole, 1.0 + 0.5 * MARGIN);
        assert!(at_summit.is_some_and(|guess| (guess.load - 1.0).abs() < 1e-4));
        assert_eq!(guess(&whole, 1.0 + 2.0 * MARGIN), None);
        let all = whole.guesses((0..200).map(|i| f64::from(i) / 180.0));
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
