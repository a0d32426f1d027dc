//! The way along measured radii, piece by piece.
//!
//! The pieces of a block are those of one profile, its contacts may lie on any of them: the way begins on the piece nearest to the
//! tip, and lanes whose contact is nearer to the base wait there.

use super::gather::{Conditions, Contacts, GatherMaterial, numbers};
use crate::numerics::{Lanes, Vector, WIDTH};
use crate::rod::RadiusProfile;
use crate::shooting::{
    Integrator, Intrinsic, Measured, Nystrom8, RodSystem, Scales, Section, Sensitivity, State,
    Table, collocate,
};

/// What is taken along a piece, lane by lane.
struct Part {
    /// 1 where the piece is on the way, 0 where the contact is nearer to the base.
    goes: [f64; WIDTH],
    /// 1 where the whole piece is on the way.
    is_whole: [f64; WIDTH],
    /// `tau` and arclength where it starts: the contact, or the end of the piece.
    tau: [f64; WIDTH],
    from: [f64; WIDTH],
}

impl Part {
    /// The part of the piece `k` on the way from contacts at `tau` and `s`.
    #[inline(always)]
    fn new(profile: &RadiusProfile, k: usize, tau: &[f64; WIDTH], s: &[f64; WIDTH]) -> Self {
        let piece = &profile.pieces[k];
        let mut part = Self {
            goes: [0.0; WIDTH],
            is_whole: [0.0; WIDTH],
            tau: [piece.tau; WIDTH],
            from: [piece.from; WIDTH],
        };
        let end = profile.end_of(k).unwrap_or([f64::INFINITY; 2]);
        for lane in 0..WIDTH {
            if s[lane] > end[1] {
                part.is_whole[lane] = 1.0;
                part.goes[lane] = 1.0;
                [part.tau[lane], part.from[lane]] = end;
            } else if s[lane] > piece.from {
                part.goes[lane] = 1.0;
                part.tau[lane] = tau[lane];
                part.from[lane] = s[lane];
            }
        }
        part
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
    fn to_base<M: Integrator, I: Intrinsic<T>, S: Sensitivity<T>, const ADVANCES: bool>(
        contacts: &Contacts<T>,
        intrinsic: I,
        start: State<T, I, S>,
    ) -> State<T, I, S> {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let [tau, s] = [contacts.tau.unpack(), contacts.s.unpack()];
        let Some(profile) = &contacts.conditions[0].rod.profile else {
            return start;
        };
        let gradients = numbers(contacts.conditions, |condition| condition.rod.gradient);
        let gradient = if gradients == [0.0; WIDTH] {
            None
        } else {
            Some(T::pack(gradients))
        };
        let (mut nearest, mut farthest) = (s[0], s[0]);
        for s in &s[..T::LANES] {
            nearest = nearest.min(*s);
            farthest = farthest.max(*s);
        }
        let mut state = start;
        for k in (0..=profile.piece(farthest)).rev() {
            let piece = &profile.pieces[k];
            let steps = contacts.key.pieces.of(profile, k, contacts.key.steps);
            let tabulated = profile.weights(k, steps);
            let whole = profile.end_of(k).filter(|[_, end]| nearest > *end);
            let (tau, from, goes, holds) = match whole {
                Some([tau, from]) => (T::of(tau), T::of(from), None, None),
                None => {
                    let part = Part::new(profile, k, &tau, &s);
                    let goes = T::pack(part.goes);
                    let holds = T::pack(part.is_whole);
                    (
                        T::pack(part.tau),
                        T::pack(part.from),
                        Some(goes),
                        Some(holds),
                    )
                }
            };
            let table = match tabulated {
                Some(steps) => Some(Table { steps, holds }),
                None => None,
            };
            let h = (tau - T::of(piece.tau)) / T::of(f64::from(steps));
            let section = Section {
                rho: one - contacts.taper * from,
                inverse_cube: zero,
                arclength: from,
            };
            let system = RodSystem {
                force: contacts.force,
                intrinsic,
                material: Measured {
                    from: T::of(piece.from),
                    cubic: piece.cubic.map(T::of),
                    gradient,
                },
            };
            let scales = Scales::tapered::<Nystrom8>(contacts.taper, h);
            let arrived = collocate::<T, I, S>(&system, scales.end(), section, steps, table, state);
            state = match goes {
                Some(goes) => state.times(one - goes).plus(goes, arrived),
                None => arrived,
            };
        }
        state
    }
}
