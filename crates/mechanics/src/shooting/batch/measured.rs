//! The way along measured radii, piece by piece.
//!
//! The pieces of a block are those of one profile, its contacts may lie on any of them: the way begins on the piece nearest to the
//! tip, and lanes whose contact is nearer to the base wait there.

use super::gather::{Conditions, Contacts, GatherMaterial, lanes};
use crate::numerics::{Lanes, Vector, WIDTH};
use crate::rod::Piece;
use crate::shooting::{
    Integrator, Intrinsic, Measured, Nystrom8, RodSystem, Scales, Section, Sensitivity, State,
    collocate,
};

/// What is taken along a piece, lane by lane.
struct Part {
    /// 1 where the piece is on the way, 0 where the contact is nearer to the base.
    goes: [f64; WIDTH],
    /// `tau` and arclength where it starts: the contact, or the end of the piece.
    tau: [f64; WIDTH],
    from: [f64; WIDTH],
}

impl Part {
    /// The part of the piece `k` on the way from contacts at `tau` and `s`.
    #[inline(always)]
    fn new(pieces: &[Piece], k: usize, tau: &[f64; WIDTH], s: &[f64; WIDTH]) -> Self {
        let mut part = Self {
            goes: [0.0; WIDTH],
            tau: [pieces[k].tau; WIDTH],
            from: [pieces[k].from; WIDTH],
        };
        let next = pieces.get(k + 1);
        for lane in 0..WIDTH {
            if s[lane] > pieces[k].from {
                let ends = next.filter(|next| next.from < s[lane]);
                let [tau, from] = ends.map_or([tau[lane], s[lane]], |next| [next.tau, next.from]);
                part.goes[lane] = 1.0;
                part.tau[lane] = tau;
                part.from[lane] = from;
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
        let gradient = lanes(contacts.conditions, |condition| condition.rod.gradient);
        let mut last = 0;
        for s in &s[..T::LANES] {
            last = last.max(profile.piece(*s));
        }
        let mut state = start;
        for k in (0..=last).rev() {
            let part = Part::new(&profile.pieces, k, &tau, &s);
            let piece = &profile.pieces[k];
            let steps = contacts.key.pieces.of(profile, k, contacts.key.steps);
            let from = T::pack(part.from);
            let h = (T::pack(part.tau) - T::of(piece.tau)) / T::of(f64::from(steps));
            let rho = one - contacts.taper * from;
            let section = Section {
                rho,
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
            let goes = T::pack(part.goes);
            let arrived = collocate::<T, I, S>(&system, scales.end(), section, steps, state);
            state = start.times(one - goes).plus(goes, arrived);
        }
        state
    }
}
