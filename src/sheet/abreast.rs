//! A row of a map in lanes: one polynomial alone would wait for its own products most of the time.

use super::loads::{Curve, LOADS};
use super::polynomial::{NODES, Polynomial};
use crate::model::batch::Task;
use crate::model::simd::{Lanes, WIDTH};

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
