//! What a guess is: contact and load of a cell, read off the row's level curve on the lattice at the cell's push angle.
//!
//! The curve is known at the Chebyshev-Lobatto nodes of the load. Between them push angle, contact and load are polynomials; the
//! first one is solved for the load, the others are evaluated there. Sixteen cells of a row are solved side by side.

use crate::numerics::WIDTH;
use crate::numerics::lobatto::{LOBATTO_COUNT, LobattoPolynomial};
use crate::numerics::newton_form::{RootProblem, stencil};
use crate::numerics::newton_form_simd::{SimdRoots, Terms};
use crate::sheet::lattice::row_curve::{NEAR_CUT, RowCurve};

/// Where Newton's method starts for one cell: contact and load, interpolated on the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
}

/// The last Newton step along a row, in parts of the fold's load: its square is left, and interpolation leaves more than that.
const LAST_PART_STEP: f64 = 1e-5;

impl RowCurve {
    /// Guesses for growing push angles (at least 0, in radians, as magnitudes); `None` outside the sheet.
    pub fn guesses(&self, pushes: impl Iterator<Item = f64>) -> Vec<Option<Guess>> {
        if self.count < 2 {
            return pushes.map(|_| None).collect();
        }
        let intervals = self.intervals();
        let mut guesses = Vec::with_capacity(pushes.size_hint().0);
        let mut block = Block::of(self);
        let mut i = 0;
        for push in pushes {
            while i + 2 < self.count && push > intervals.push[i + 1] {
                i += 1;
            }
            if let Some(problem) = intervals.problem(i, push) {
                block.cells.push((guesses.len(), i));
                block.problems.push(problem);
            }
            guesses.push(None);
            if block.cells.len() == WIDTH {
                block.solve(self, &mut guesses);
            }
        }
        block.solve(self, &mut guesses);
        guesses
    }
}

/// Push angles of a row that are looked for side by side.
struct Block {
    /// Indices of their guesses, and of the points before them.
    cells: Vec<(usize, usize)>,
    problems: Vec<RootProblem>,
    /// Of a row from first touch to the fold: one polynomial is as good at its ends as in its middle.
    whole: Option<[LobattoPolynomial; 3]>,
    /// Of a row that leaves the lattice, the ones used last, and from which point on they are.
    around: Option<(usize, [LobattoPolynomial; 3])>,
}

impl Block {
    fn of(curve: &RowCurve) -> Self {
        let is_whole = curve.count == LOBATTO_COUNT;
        Self {
            cells: Vec::with_capacity(WIDTH),
            problems: Vec::with_capacity(WIDTH),
            whole: is_whole.then(|| curve.polynomials(0, LOBATTO_COUNT)),
            around: None,
        }
    }

    /// Finds what is looked for on `curve`.
    fn solve(&mut self, curve: &RowCurve, guesses: &mut [Option<Guess>]) {
        if let Some(whole) = &self.whole {
            let [tau, load] = roots(whole).solve(0, &self.problems, LAST_PART_STEP);
            for ((cell, _), (tau, load)) in self.cells.iter().zip(tau.into_iter().zip(load)) {
                guesses[*cell] = Some(Guess { tau, load });
            }
        } else {
            let count = curve.count.min(NEAR_CUT);
            for ((cell, i), problem) in self.cells.iter().zip(&self.problems) {
                let from = stencil(*i, NEAR_CUT, curve.count);
                let (_, polynomials) = match &self.around {
                    Some(around) if around.0 == from => around,
                    _ => self.around.insert((from, curve.polynomials(from, count))),
                };
                let [tau, load] = roots(polynomials).solve_alone(0, problem, LAST_PART_STEP);
                guesses[*cell] = Some(Guess { tau, load });
            }
        }
        self.cells.clear();
        self.problems.clear();
    }
}

/// Contact and load where the push angle is as wanted.
fn roots([push, tau, load]: &[LobattoPolynomial; 3]) -> SimdRoots<'_, LOBATTO_COUNT, 2> {
    SimdRoots {
        nodes: &push.nodes,
        terms: Terms::Same(&push.differences),
        others: [tau, load].map(|other| Terms::Same(&other.differences)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::lobatto::LOBATTO_NODES;
    use crate::sheet::lattice::row_curve::MARGIN;
    use std::f64::consts::FRAC_PI_2;

    fn curve(first: usize, pushes: &[f64]) -> RowCurve {
        let mut curve = RowCurve {
            first,
            count: pushes.len(),
            ..RowCurve::default()
        };
        for (i, push) in pushes.iter().enumerate() {
            let part = LOBATTO_NODES[first + i];
            (curve.push[i], curve.tau[i], curve.load[i]) = (*push, 0.5 + 0.1 * part, part);
        }
        curve
    }

    fn guess(curve: &RowCurve, push: f64) -> Option<Guess> {
        curve.guesses([push].into_iter())[0]
    }

    #[test]
    fn guesses_are_on_the_curve_up_to_its_summit() {
        // The push angle grows to 1 at the fold, where it is flat.
        let push = |load: f64| (FRAC_PI_2 * load).sin();
        let load = |push: f64| push.asin() / FRAC_PI_2;
        for (first, count) in [
            (0, LOBATTO_COUNT),
            (1, LOBATTO_COUNT - 1),
            (4, 12),
            (0, 9),
            (5, 4),
            (3, 2),
        ] {
            let pushes: Vec<f64> = LOBATTO_NODES[first..first + count]
                .iter()
                .map(|part| push(*part))
                .collect();
            let curve = curve(first, &pushes);
            // Rows that leave the lattice are known one load farther than their nodes, and less well.
            let error = if count == LOBATTO_COUNT {
                1e-6
            } else {
                1e-2 / count as f64
            };
            let ends = [
                first.saturating_sub(1),
                (first + count).min(LOBATTO_COUNT - 1),
            ];
            let [least, most] = ends.map(|m| push(LOBATTO_NODES[m]));
            for i in 0..=1000 {
                let push = 1e-3 * f64::from(i);
                let found = guess(&curve, push);
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
        let whole: Vec<f64> = LOBATTO_NODES.iter().map(|part| push(*part)).collect();
        let whole = curve(0, &whole);
        let at_summit = guess(&whole, 1.0 + 0.5 * MARGIN);
        assert!(at_summit.is_some_and(|guess| (guess.load - 1.0).abs() < 1e-4));
        assert_eq!(guess(&whole, 1.0 + 2.0 * MARGIN), None);
        let all = whole.guesses((0..200).map(|i| f64::from(i) / 180.0));
        assert_eq!(all.iter().flatten().count(), 181);
    }

    #[test]
    fn few_nodes_and_falling_pushes_make_no_number_of_none() {
        let falling = [0.3, 0.29, 0.27, 0.24];
        let turning = [0.0, 0.1, 0.2, 0.15, 0.1, 0.3, 0.2, 0.1, 0.0, -0.1];
        let (constant, one, none) = ([0.1; 3], [0.1], []);
        let few: [&[f64]; 3] = [&falling[..2], &turning[..3], &one];
        for push in [&falling[..], &turning, &constant, &none]
            .into_iter()
            .chain(few)
        {
            for first in [0, 1, LOBATTO_COUNT - push.len()] {
                let pushes = (0..=400).map(|i| f64::from(i) / 1000.0);
                for guess in curve(first, push).guesses(pushes).into_iter().flatten() {
                    assert!(push.len() > 1 && guess.tau.is_finite() && guess.load.is_finite());
                    assert!(guess.load != 0.0 || guess.tau == 0.5);
                }
            }
        }
    }
}
