//! Integration along measured radii, piece by piece.
//!
//! All rods of a block have one profile. Contacts may lie on any piece, and lanes take their own numbers of steps along each.
//! Integration begins on the piece nearest to the tip. Lanes whose contact is nearer to the base wait there, and on each piece
//! lanes with fewer steps wait for the others.

use super::InitialCondition;
use super::gather::{Conditions, Contacts, GatherMaterial, numbers};
use crate::numerics::gauss::{Integrals, NODES};
use crate::numerics::{Lanes, Vector, WIDTH};
use crate::rod::RadiusProfile;
use crate::shooting::{
    BackwardCompliance, Intrinsic, Measured, PieceSteps, RodSystem, Scales, Section, Sensitivity,
    StepObserver, StepStage, TrajectoryState, collocate,
};

/// Integration along one piece: its extent and its steps in each lane.
struct PieceSpan {
    /// Number of steps; 0 if the contact is nearer to the base.
    steps: [u32; WIDTH],
    /// Largest number of steps of any lane.
    most: u32,
    /// True if the trajectory crosses the whole piece.
    is_whole: [bool; WIDTH],
    /// `tau` and, in `from`, the arclength where integration along the piece starts: the contact or the end of the piece.
    tau: [f64; WIDTH],
    from: [f64; WIDTH],
}

impl PieceSpan {
    /// The span of the piece `k` for contacts at `tau` and `s` with these `steps`.
    #[inline(always)]
    fn new(
        profile: &RadiusProfile,
        k: usize,
        tau: &[f64; WIDTH],
        s: &[f64; WIDTH],
        steps: &[PieceSteps],
    ) -> Self {
        let piece = &profile.pieces[k];
        let end = profile.end_of(k).unwrap_or([f64::INFINITY; 2]);
        let mut span = Self {
            steps: [0; WIDTH],
            most: 0,
            is_whole: [false; WIDTH],
            tau: [piece.tau; WIDTH],
            from: [piece.from; WIDTH],
        };
        let mut last = (PieceSteps::default(), 0);
        for (lane, steps) in steps.iter().enumerate() {
            if s[lane] <= piece.from {
                continue;
            }
            if last.0 != *steps {
                last = (*steps, steps.of(profile, k));
            }
            span.steps[lane] = last.1;
            span.most = span.most.max(last.1);
            span.is_whole[lane] = s[lane] > end[1];
            [span.tau[lane], span.from[lane]] =
                if span.is_whole[lane] { end } else { [tau[lane], s[lane]] };
        }
        span
    }

    /// Length of each step in `tau`, to the beginning of the piece at `begin`; 0 without a step.
    #[inline(always)]
    fn step_lengths(&self, begin: f64) -> [f64; WIDTH] {
        let mut lengths = self.tau;
        for (length, steps) in lengths.iter_mut().zip(&self.steps) {
            *length = (*length - begin) / f64::from((*steps).max(1));
        }
        lengths
    }

    /// 1 in the lanes that take the step `i`, 0 in the others.
    #[inline(always)]
    fn takes(&self, i: u32) -> [f64; WIDTH] {
        let mut takes = [0.0; WIDTH];
        for (takes, steps) in takes.iter_mut().zip(&self.steps) {
            *takes = f64::from(u8::from(i < *steps));
        }
        takes
    }

    /// Collocation integrals of the step `i`. In lanes that cross the whole piece `k` they come from its table, in others they are
    /// `computed`. They are 0 in lanes that do not take the step.
    #[inline(always)]
    fn weights<T: Lanes>(
        &self,
        (i, takes): (u32, [f64; WIDTH]),
        (profile, k): (&RadiusProfile, usize),
        computed: BackwardCompliance<T>,
    ) -> Integrals<T> {
        let mut weights = [[T::of(0.0); NODES]; NODES + 1];
        let mut left = takes;
        for lane in 0..WIDTH {
            if left[lane] == 0.0 || !self.is_whole[lane] {
                continue;
            }
            let steps = self.steps[lane];
            let Some(table) = profile.weights(k, steps) else {
                continue;
            };
            let mut alike = [0.0; WIDTH];
            for other in 0..WIDTH {
                let holds = self.is_whole[other] && self.steps[other] == steps;
                alike[other] = f64::from(u8::from(holds));
                left[other] -= alike[other];
            }
            let alike = T::pack(alike);
            for (weights, table) in weights.iter_mut().zip(&table[i as usize]) {
                for (weight, tabulated) in weights.iter_mut().zip(table) {
                    *weight = alike.mul_add(T::of(*tabulated), *weight);
                }
            }
        }
        if left != [0.0; WIDTH] {
            let left = T::pack(left);
            for (weights, computed) in weights.iter_mut().zip(computed.weights()) {
                for (weight, computed) in weights.iter_mut().zip(computed) {
                    *weight = left.mul_add(computed, *weight);
                }
            }
        }
        weights
    }
}

impl<T: Lanes> GatherMaterial<T> for Measured<T> {
    #[inline(always)]
    fn stiffness(conditions: &Conditions, _: T, s: T) -> T {
        let s = s.unpack();
        let mut stiffness = [1.0; WIDTH];
        for (lane, stiffness) in stiffness.iter_mut().enumerate() {
            *stiffness = conditions[lane].rod.stiffness(s[lane]);
        }
        T::pack(stiffness)
    }

    #[inline(always)]
    fn to_base<I: Intrinsic<T>, S: Sensitivity<T>, const ADVANCES: bool>(
        contacts: &Contacts<T>,
        intrinsic: I,
        start: TrajectoryState<T, I, S>,
        observer: &mut impl StepObserver<T>,
    ) -> TrajectoryState<T, I, S> {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let [tau, s] = [contacts.tau.unpack(), contacts.s.unpack()];
        let Some(profile) = &contacts.conditions[0].rod.profile else {
            return start;
        };
        let gradients = numbers(contacts.conditions, |condition| condition.rod.gradient);
        let gradient = if gradients == [0.0; WIDTH] { None } else { Some(T::pack(gradients)) };
        let mut needs = [PieceSteps::default(); WIDTH];
        let mut farthest = 0.0_f64;
        for lane in 0..T::LANES {
            let InitialCondition { rod, tau, load } = contacts.conditions[lane];
            needs[lane] = contacts.resolution.of_pieces(rod, *tau, *load);
            farthest = farthest.max(s[lane]);
        }
        let mut state = start;
        for k in (0..=profile.piece(farthest)).rev() {
            let piece = &profile.pieces[k];
            let span = PieceSpan::new(profile, k, &tau, &s, &needs[..T::LANES]);
            let from = T::pack(span.from);
            let mut section =
                Section { rho: one - contacts.taper * from, inverse_cube: zero, arclength: from };
            let system = RodSystem {
                force: contacts.force,
                intrinsic,
                material: Measured {
                    from: T::of(piece.from),
                    cubic: piece.cubic.map(T::of),
                    gradient,
                },
            };
            let h = T::pack(span.step_lengths(piece.tau));
            let scales = Scales::tapered(contacts.taper, h);
            for i in 0..span.most {
                let lanes = span.takes(i);
                let takes = T::pack(lanes);
                // Waiting lanes take a step of length 0.
                let end = StepStage {
                    along: takes * scales.end().along,
                    grown: takes.mul_add(scales.end().grown - one, one),
                    ..*scales.end()
                };
                let computed = BackwardCompliance {
                    material: &system.material,
                    from: section.arclength,
                    length: section.rho * end.along,
                };
                let weights = span.weights((i, lanes), (profile, k), computed);
                let stepped = collocate::<T, I, S>(&system, &end, &section, &weights, state);
                state = state.times(one - takes).plus(takes, stepped);
                section = section.at(&end);
                observer.take(&section, &state.1.0);
            }
        }
        state
    }
}
