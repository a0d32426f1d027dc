//! Roots of polynomials in Newton's form, side by side: one alone would wait for its own products most of the time.

use crate::numerics::{Lanes, Task, WIDTH};

/// A number for every lane.
pub type Numbers = [f64; WIDTH];

/// Iterations of Newton's method. The last step of each lane tells whether they were enough.
const ITERATIONS: usize = 3;

/// The divided differences of a polynomial.
#[derive(Clone, Copy, Debug)]
pub enum Terms<'a, const N: usize> {
    /// The same polynomial in every lane.
    Same(&'a [f64; N]),
    /// One for each lane.
    Each(&'a [Numbers; N]),
}

impl<const N: usize> Terms<'_, N> {
    /// Value and slope at `t`, in the lanes from `from` on.
    #[inline(always)]
    fn at<T: Lanes>(&self, nodes: &[f64; N], from: usize, t: T) -> (T, T) {
        match self {
            Self::Same(terms) => horner(nodes, *terms, from, t),
            Self::Each(terms) => horner(nodes, *terms, from, t),
        }
    }
}

/// A term in the lanes from `from` on.
trait Term {
    fn pack<T: Lanes>(&self, from: usize) -> T;
}

impl Term for f64 {
    #[inline(always)]
    fn pack<T: Lanes>(&self, _: usize) -> T {
        T::of(*self)
    }
}

impl Term for Numbers {
    #[inline(always)]
    fn pack<T: Lanes>(&self, from: usize) -> T {
        pack(self, from)
    }
}

#[inline(always)]
fn horner<T: Lanes, C: Term, const N: usize>(
    nodes: &[f64; N],
    terms: &[C; N],
    from: usize,
    t: T,
) -> (T, T) {
    let (mut value, mut slope): (T, T) = (terms[N - 1].pack(from), T::of(0.0));
    for i in (0..N - 1).rev() {
        let x = t - T::of(nodes[i]);
        slope = slope.mul_add(x, value);
        value = value.mul_add(x, terms[i].pack(from));
    }
    (value, slope)
}

/// Where polynomials on the same `nodes` are as large as wanted, and what `others` are there.
#[derive(Clone, Copy, Debug)]
pub struct Roots<'a, const N: usize, const M: usize> {
    /// The nodes of all of them.
    pub nodes: &'a [f64; N],
    /// The polynomial that is solved.
    pub terms: Terms<'a, N>,
    /// What it is to be.
    pub targets: Numbers,
    /// Where to start.
    pub near: Numbers,
    /// The polynomials that are evaluated there.
    pub others: [Terms<'a, N>; M],
}

/// What [`Roots`] finds.
#[derive(Clone, Copy, Debug)]
pub struct Found<const M: usize> {
    /// The places.
    pub place: Numbers,
    /// The last steps toward them.
    pub step: Numbers,
    /// The other polynomials there.
    pub others: [Numbers; M],
}

impl<const N: usize, const M: usize> Task for Roots<'_, N, M> {
    type Output = Found<M>;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Found<M> {
        let mut found = Found {
            place: [0.0; WIDTH],
            step: [0.0; WIDTH],
            others: [[0.0; WIDTH]; M],
        };
        for from in (0..WIDTH).step_by(T::LANES) {
            let target: T = pack(&self.targets, from);
            let (mut place, mut step): (T, T) = (pack(&self.near, from), T::of(0.0));
            for _ in 0..ITERATIONS {
                let (value, slope) = self.terms.at(self.nodes, from, place);
                step = (target - value) / slope;
                place = place + step;
            }
            keep(&mut found.place, from, place);
            keep(&mut found.step, from, step);
            for (numbers, other) in found.others.iter_mut().zip(&self.others) {
                keep(numbers, from, other.at(self.nodes, from, place).0);
            }
        }
        found
    }
}

/// The lanes from `from` on.
#[inline(always)]
pub fn pack<T: Lanes>(numbers: &Numbers, from: usize) -> T {
    let mut lanes = [0.0; WIDTH];
    lanes[..WIDTH - from].copy_from_slice(&numbers[from..]);
    T::pack(lanes)
}

/// Sets the numbers from `from` on to those of `lanes`.
#[inline(always)]
pub fn keep<T: Lanes>(numbers: &mut Numbers, from: usize, lanes: T) {
    numbers[from..from + T::LANES].copy_from_slice(&lanes.unpack()[..T::LANES]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::newton_form::Polynomial;
    use crate::numerics::{Bracket, Unit};

    const N: usize = 12;

    /// The polynomial through 0 at 0 to 3 at the last node, there level but for some.
    fn rising(lane: usize) -> Polynomial<N> {
        let power = 1.0 + (0.618 * lane as f64).fract() * 2.0;
        let value = |node: usize| 3.0 * (1.0 - (1.0 - node as f64 / (N - 1) as f64).powf(power));
        Polynomial::through(&std::array::from_fn::<_, N, _>(value))
    }

    /// With a polynomial for every lane, and with one for all.
    #[test]
    fn what_is_found_together_is_found_alone() {
        let mut each = [[[0.0; WIDTH]; N]; 2];
        for lane in 0..WIDTH {
            for i in 0..N {
                each[0][i][lane] = rising(lane).differences[i];
                each[1][i][lane] = rising(lane + 1).differences[i];
            }
        }
        let [same, other] = [1, WIDTH + 1].map(rising);
        let targets: Numbers = std::array::from_fn(|lane| 0.1 + 0.15 * lane as f64);
        for unit in Unit::all() {
            for is_same in [false, true] {
                let of_lane = |lane| if is_same { same } else { rising(lane) };
                let alone: Numbers = std::array::from_fn(|lane| {
                    let bracket = Bracket::new([0.0, (N - 1) as f64], [0.0, 3.0]);
                    of_lane(lane).solve(targets[lane], 4.5, bracket, 1e-4)
                });
                let found = unit.run(Roots {
                    nodes: &same.nodes,
                    terms: if is_same {
                        Terms::Same(&same.differences)
                    } else {
                        Terms::Each(&each[0])
                    },
                    targets,
                    near: alone.map(|place| place + 0.1),
                    others: [Terms::Each(&each[1]), Terms::Same(&other.differences)],
                });
                for (lane, place) in alone.into_iter().enumerate() {
                    assert!(found.step[lane].abs() < 1e-4, "{unit} {lane}");
                    let near = |found: f64, value: f64| (found - value).abs() < 1e-6;
                    assert!(near(found.place[lane], place), "{unit} {lane}");
                    let [each, same] = found.others.map(|numbers| numbers[lane]);
                    assert!(near(each, rising(lane + 1).at(place).0), "{unit} {lane}");
                    assert!(near(same, other.at(place).0), "{unit} {lane}");
                }
            }
        }
    }
}
