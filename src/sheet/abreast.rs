//! A row of a map in lanes: one polynomial alone would wait for its own products most of the time.

use super::loads::{Curve, LOADS};
use super::polynomial::{NODES, Polynomial};
use crate::model::batch::{Lanes, Task, WIDTH};

/// A number for every lane.
pub type Numbers = [f64; WIDTH];

/// Rounds of Newton's method; what is not found then is looked for alone.
const ROUNDS: usize = 3;

/// Polynomials along the columns, one for every load, by divided differences.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// Of `ln D`.
    pub ln_distance: [Numbers; NODES],
    /// Of the direction of the pole.
    pub phi: [Numbers; NODES],
}

/// The places in a patch where every load's `ln D` is the same.
pub struct Across<'a> {
    /// The patch.
    pub patch: &'a Patch,
    /// `ln tau` of the columns.
    pub ln_tau: &'a Polynomial,
    /// `ln q` of the columns' folds.
    pub ln_q: &'a Polynomial,
    /// The distance.
    pub target: f64,
    /// Where to start.
    pub near: Numbers,
}

/// What a row has at every load.
#[derive(Clone, Copy, Debug)]
pub struct Crossed {
    /// The places.
    pub place: Numbers,
    /// The last steps toward them.
    pub step: Numbers,
    /// Direction of the pole there.
    pub phi: Numbers,
    /// `ln tau` there.
    pub ln_tau: Numbers,
    /// `ln q` of the fold there.
    pub ln_q: Numbers,
}

impl Task for Across<'_> {
    type Output = Crossed;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Crossed {
        let nothing = [0.0; WIDTH];
        let mut crossed = Crossed {
            place: nothing,
            step: nothing,
            phi: nothing,
            ln_tau: nothing,
            ln_q: nothing,
        };
        let target = T::of(self.target);
        for from in (0..WIDTH).step_by(T::LANES) {
            let (mut place, mut step) = (T::pack(part(&self.near, from)), T::of(0.0));
            for _ in 0..ROUNDS {
                let mut slope = T::of(0.0);
                let mut value = T::pack(part(&self.patch.ln_distance[NODES - 1], from));
                for i in (0..NODES - 1).rev() {
                    let x = place - T::of(i as f64);
                    slope = slope.mul_add(x, value);
                    value = value.mul_add(x, T::pack(part(&self.patch.ln_distance[i], from)));
                }
                step = (target - value) / slope;
                place = place + step;
            }
            let mut phi = T::pack(part(&self.patch.phi[NODES - 1], from));
            let mut ln_tau = T::of(self.ln_tau.differences()[NODES - 1]);
            let mut ln_q = T::of(self.ln_q.differences()[NODES - 1]);
            for i in (0..NODES - 1).rev() {
                let x = place - T::of(i as f64);
                phi = phi.mul_add(x, T::pack(part(&self.patch.phi[i], from)));
                ln_tau = ln_tau.mul_add(x, T::of(self.ln_tau.differences()[i]));
                ln_q = ln_q.mul_add(x, T::of(self.ln_q.differences()[i]));
            }
            keep(&mut crossed.place, from, place);
            keep(&mut crossed.step, from, step);
            keep(&mut crossed.phi, from, phi);
            keep(&mut crossed.ln_tau, from, ln_tau);
            keep(&mut crossed.ln_q, from, ln_q);
        }
        crossed
    }
}

/// The places along a level curve where the push angle is as wanted.
pub struct Along<'a> {
    /// The push angle.
    pub push: &'a Curve,
    /// `tau` of the contact.
    pub tau: &'a Curve,
    /// The load.
    pub load: &'a Curve,
    /// The push angles.
    pub targets: Numbers,
    /// Where to start.
    pub near: Numbers,
}

/// What a level curve has at every push angle.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// The places, as parts of the fold's load.
    pub place: Numbers,
    /// The last steps toward them.
    pub step: Numbers,
    /// `tau` there.
    pub tau: Numbers,
    /// The load there.
    pub load: Numbers,
}

impl Task for Along<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Found {
        let nothing = [0.0; WIDTH];
        let mut found = Found {
            place: nothing,
            step: nothing,
            tau: nothing,
            load: nothing,
        };
        for from in (0..WIDTH).step_by(T::LANES) {
            let target = T::pack(part(&self.targets, from));
            let (mut place, mut step) = (T::pack(part(&self.near, from)), T::of(0.0));
            for _ in 0..ROUNDS {
                let mut slope = T::of(0.0);
                let mut value = T::of(self.push.differences[LOADS - 1]);
                for i in (0..LOADS - 1).rev() {
                    let x = place - T::of(self.push.parts[i]);
                    slope = slope.mul_add(x, value);
                    value = value.mul_add(x, T::of(self.push.differences[i]));
                }
                step = (target - value) / slope;
                place = place + step;
            }
            let mut tau = T::of(self.tau.differences[LOADS - 1]);
            let mut load = T::of(self.load.differences[LOADS - 1]);
            for i in (0..LOADS - 1).rev() {
                let x = place - T::of(self.push.parts[i]);
                tau = tau.mul_add(x, T::of(self.tau.differences[i]));
                load = load.mul_add(x, T::of(self.load.differences[i]));
            }
            keep(&mut found.place, from, place);
            keep(&mut found.step, from, step);
            keep(&mut found.tau, from, tau);
            keep(&mut found.load, from, load);
        }
        found
    }
}

/// The numbers from `from` on, and nothing after them.
#[inline(always)]
fn part(numbers: &Numbers, from: usize) -> Numbers {
    let mut part = [0.0; WIDTH];
    part[..WIDTH - from].copy_from_slice(&numbers[from..]);
    part
}

#[inline(always)]
fn keep<T: Lanes>(numbers: &mut Numbers, from: usize, lanes: T) {
    numbers[from..from + T::LANES].copy_from_slice(&lanes.unpack()[..T::LANES]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::batch::Unit;
    use crate::sheet::loads::PARTS;

    /// A value for each lane that rises from 0 at 0 to 3 at the last of `places`, level at the end but for some.
    fn values(places: &[f64], lane: usize) -> Vec<f64> {
        let last = places[places.len() - 1];
        let power = 1.0 + (0.618 * lane as f64).fract() * 2.0;
        let value = |place: &f64| 3.0 * (1.0 - (1.0 - place / last).powf(power));
        places.iter().map(value).collect()
    }

    #[test]
    fn what_is_found_together_is_found_alone() {
        let places: Vec<f64> = (0..NODES).map(|place| place as f64).collect();
        let of_lane = |lane| Polynomial::through(values(&places, lane));
        let mut patch = Patch {
            ln_distance: [[0.0; WIDTH]; NODES],
            phi: [[0.0; WIDTH]; NODES],
        };
        for lane in 0..WIDTH {
            for i in 0..NODES {
                patch.ln_distance[i][lane] = of_lane(lane).differences()[i];
                patch.phi[i][lane] = of_lane(lane + 1).differences()[i];
            }
        }
        let [ln_tau, ln_q] = [of_lane(WIDTH + 1), of_lane(WIDTH + 2)];
        for unit in [Unit::detect(), Unit::scalar()] {
            for target in [0.1, 0.7, 1.9, 2.5] {
                let alone: [f64; WIDTH] = std::array::from_fn(|lane| {
                    of_lane(lane).solve(target, 4.5, [0.0, (NODES - 1) as f64])
                });
                let crossed = unit.run(Across {
                    patch: &patch,
                    ln_tau: &ln_tau,
                    ln_q: &ln_q,
                    target,
                    near: alone.map(|place| place + 0.1),
                });
                for (lane, place) in alone.into_iter().enumerate() {
                    assert!(crossed.step[lane].abs() < 1e-4, "{unit} {target} {lane}");
                    let near = |found: f64, value: f64| (found - value).abs() < 1e-6;
                    assert!(near(crossed.place[lane], place), "{unit} {target} {lane}");
                    assert!(near(crossed.phi[lane], of_lane(lane + 1).at(place).0));
                    assert!(near(crossed.ln_tau[lane], ln_tau.at(place).0));
                    assert!(near(crossed.ln_q[lane], ln_q.at(place).0));
                }
            }
        }
    }

    #[test]
    fn a_row_finds_its_push_angles() {
        let [push, tau, load] =
            [0, 1, 2].map(|lane| Curve::through(0, &values(PARTS.as_slice(), lane)));
        for unit in [Unit::detect(), Unit::scalar()] {
            let targets: Numbers = std::array::from_fn(|lane| 0.1 + 0.15 * lane as f64);
            let alone = targets.map(|target| push.solve(target, 0.5, [0.0, 1.0]));
            let found = unit.run(Along {
                push: &push,
                tau: &tau,
                load: &load,
                targets,
                near: alone.map(|place| place + 0.02),
            });
            for (lane, place) in alone.into_iter().enumerate() {
                assert!(found.step[lane].abs() < 1e-5, "{unit} {lane}");
                let near = |found: f64, value: f64| (found - value).abs() < 1e-8;
                assert!(near(found.place[lane], place), "{unit} {lane}");
                assert!(near(found.tau[lane], tau.at(place).0), "{unit} {lane}");
                assert!(near(found.load[lane], load.at(place).0), "{unit} {lane}");
            }
        }
    }
}
