//! A row of a map in lanes: one polynomial alone would wait for its own products most of the time.

use crate::numerics::lobatto::Curve;
use crate::numerics::newton_form_simd::{Numbers, at, keep, part};
use crate::numerics::{Lanes, SimdTask, WIDTH};
use crate::sheet::fold::contact_nodes::{Line, TERMS};
use crate::shooting::contact::exp;

/// Rounds of Newton's method; what is not found then is looked for alone.
const ROUNDS: usize = 3;

/// Lines along the columns, one for every load, by divided differences.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// Of `ln D`.
    pub ln_distance: [Numbers; TERMS],
    /// Of the direction of the pole.
    pub phi: [Numbers; TERMS],
}

/// The places in a patch where every load's `ln D` is the same.
pub struct Across<'a> {
    /// The patch.
    pub patch: &'a Patch,
    /// `ln tau` of the columns.
    pub ln_tau: &'a Line,
    /// `ln q` of the columns' folds.
    pub ln_q: &'a Line,
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
    /// `tau` there.
    pub tau: Numbers,
    /// `q` of the fold there.
    pub q: Numbers,
}

impl SimdTask for Across<'_> {
    type Output = Crossed;

    #[inline(always)]
    fn run<T: Lanes>(self) -> Crossed {
        let nothing = [0.0; WIDTH];
        let mut crossed = Crossed {
            place: nothing,
            step: nothing,
            phi: nothing,
            tau: nothing,
            q: nothing,
        };
        let Self {
            patch,
            ln_tau,
            ln_q,
            ..
        } = self;
        let places = &ln_tau.places;
        let target = T::of(self.target);
        for from in (0..WIDTH).step_by(T::LANES) {
            let (mut place, mut step) = (T::pack(part(&self.near, from)), T::of(0.0));
            for _ in 0..ROUNDS {
                let (value, slope) = at(places, &patch.ln_distance, from, place);
                step = (target - value) / slope;
                place = place + step;
            }
            keep(&mut crossed.place, from, place);
            keep(&mut crossed.step, from, step);
            keep(
                &mut crossed.phi,
                from,
                at(places, &patch.phi, from, place).0,
            );
            let tau = exp(at(places, &ln_tau.differences, from, place).0);
            let q = exp(at(places, &ln_q.differences, from, place).0);
            keep(&mut crossed.tau, from, tau);
            keep(&mut crossed.q, from, q);
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

impl SimdTask for Along<'_> {
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
        let Self {
            push, tau, load, ..
        } = self;
        for from in (0..WIDTH).step_by(T::LANES) {
            let target = T::pack(part(&self.targets, from));
            let (mut place, mut step) = (T::pack(part(&self.near, from)), T::of(0.0));
            for _ in 0..ROUNDS {
                let (value, slope) = at(&push.places, &push.differences, from, place);
                step = (target - value) / slope;
                place = place + step;
            }
            keep(&mut found.place, from, place);
            keep(&mut found.step, from, step);
            keep(
                &mut found.tau,
                from,
                at(&push.places, &tau.differences, from, place).0,
            );
            keep(
                &mut found.load,
                from,
                at(&push.places, &load.differences, from, place).0,
            );
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Unit;
    use crate::numerics::lobatto;
    use crate::numerics::lobatto::{LOADS, PARTS};

    /// A value for each lane that rises from 0 at 0 to 3 at the last of `places`, level at the end but for some.
    fn values(places: &[f64], lane: usize) -> Vec<f64> {
        let last = places[places.len() - 1];
        let power = 1.0 + (0.618 * lane as f64).fract() * 2.0;
        let value = |place: &f64| 3.0 * (1.0 - (1.0 - place / last).powf(power));
        places.iter().map(value).collect()
    }

    #[test]
    fn what_is_found_together_is_found_alone() {
        let places: Vec<f64> = (0..TERMS).map(|place| place as f64).collect();
        let of_lane = |lane| Line::through(&values(&places, lane));
        let mut patch = Patch {
            ln_distance: [[0.0; WIDTH]; TERMS],
            phi: [[0.0; WIDTH]; TERMS],
        };
        for lane in 0..WIDTH {
            for i in 0..TERMS {
                patch.ln_distance[i][lane] = of_lane(lane).differences[i];
                patch.phi[i][lane] = of_lane(lane + 1).differences[i];
            }
        }
        let [ln_tau, ln_q] = [of_lane(WIDTH + 1), of_lane(WIDTH + 2)];
        for unit in Unit::all() {
            for target in [0.1, 0.7, 1.9, 2.5] {
                let alone: [f64; WIDTH] = std::array::from_fn(|lane| {
                    of_lane(lane).solve(target, 4.5, [0.0, (TERMS - 1) as f64], 1e-4)
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
                    assert!(near(crossed.tau[lane].ln(), ln_tau.at(place).0));
                    assert!(near(crossed.q[lane].ln(), ln_q.at(place).0));
                }
            }
        }
    }

    #[test]
    fn a_row_finds_its_push_angles() {
        let values = [0, 1, 2].map(|lane| {
            let values = values(PARTS.as_slice(), lane);
            std::array::from_fn(|i| values[i])
        });
        let [push, tau, load] = lobatto::through(0, LOADS, values);
        for unit in Unit::all() {
            let targets: Numbers = std::array::from_fn(|lane| 0.1 + 0.15 * lane as f64);
            let alone = targets.map(|target| push.solve(target, 0.5, [0.0, 1.0], 1e-5));
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
