//! Demands of the pieces of a measured profile: how many integration steps each needs. Most of many pieces hardly bend and need one step.
//!
//! A load bends a piece in proportion to its compliance and to its lever to the contact. Its share in the whole bending
//! depends on the contact. Demands are therefore tabulated by reach: a range of contacts whose distances from the base are
//! within a factor of `2^(1/4)`. A table entry is the largest demand of all contacts of the reach.

use crate::rod::RadiusProfile;

/// Number of reaches over which the distance from the base halves.
const REACHES_PER_OCTAVE: f64 = 4.0;

/// Number of reaches. Contacts of the last one are within a 4096th of the whisker from the base.
const REACHES: u32 = 49;

/// Farthest contact of a sheet beyond the tip, in whisker lengths from the base.
const BEYOND_TIP: f64 = 1.5;

/// Demand of one piece of a profile for contacts of one reach, dimensionless. It only counts steps, so `f32` suffices.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// Part of the bending to resolve, dimensionless. It is the root of the product of the piece's shares in the compliance and in the
    /// length to the contact. It is at least half of its share in the compliance. On a uniform rod it is about the share in the length.
    pub bending: f32,
    /// Roughness of the piece, dimensionless: the change of `ln radius` over the piece, times the fifth root of the product of its two
    /// shares. Collocation at five nodes depends on the compliance to fifth order (`benches/NOTES.md`).
    pub roughness: f32,
}

/// Demands of all pieces of a profile, for each reach of the contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Demands {
    /// `[reach][piece]`, from the reach at the tip on.
    by_reach: Vec<Demand>,
    pieces: usize,
}

impl Demands {
    /// Computes the demands of the pieces of `profile`. Its cone has the radius 0 at the arclength `end`, in whisker lengths.
    pub(super) fn new(profile: &RadiusProfile, end: f64) -> Self {
        let pieces = profile.pieces.len();
        let mut by_reach = Vec::with_capacity(REACHES as usize * pieces);
        for reach in 0..REACHES {
            let [nearest, mut farthest] =
                [reach + 1, reach].map(|reach| libm::exp2(-f64::from(reach) / REACHES_PER_OCTAVE));
            if reach == 0 {
                farthest = BEYOND_TIP.min(0.999 * end);
            }
            let rows = profile.pieces.iter().map(|piece| piece.from);
            let within = rows.filter(|from| (nearest..farthest).contains(from));
            let mut shares = vec![0.0_f64; pieces];
            for s in within.chain([nearest, farthest]) {
                for (largest, share) in shares.iter_mut().zip(profile.shares_at(s)) {
                    *largest = largest.max(share);
                }
            }
            let ways = profile.widths.iter().map(|width| (width / nearest).min(1.0));
            let demand = |((share, way), change): ((&f64, f64), &f64)| Demand {
                bending: (share * way).sqrt().max(0.5 * share) as f32,
                roughness: (change * libm::pow(share * way, 0.2)) as f32,
            };
            let from = by_reach.len();
            by_reach.extend(shares.iter().zip(ways).zip(&profile.changes).map(demand));
            // The piece beyond the tip has no length of its own: its demand is the largest of all.
            let most = |one: Demand, other: &Demand| Demand {
                bending: one.bending.max(other.bending),
                roughness: one.roughness.max(other.roughness),
            };
            let tail = by_reach[from..].iter().fold(Demand::default(), most);
            by_reach[from + pieces - 1] = tail;
        }
        Self { by_reach, pieces }
    }

    /// Returns the index of the interval of contacts, a reach, in which the arclength `s`, in whisker lengths, lies. Reaches have equal width
    /// in `log s`, and demands are tabulated for each reach.
    #[must_use]
    pub fn reach(s: f64) -> u32 {
        ((-REACHES_PER_OCTAVE * libm::log2(s)) as u32).min(REACHES - 1)
    }

    /// Returns the demand of the piece `k` for contacts of this `reach`.
    #[must_use]
    pub fn of(&self, reach: u32, k: usize) -> Demand {
        self.by_reach[reach as usize * self.pieces + k]
    }
}
