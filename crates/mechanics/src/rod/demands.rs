//! What the pieces of a profile ask of an integrator, each by its own: most of many pieces hardly bend, and need no more than a step.
//!
//! A load bends a piece by its compliance and the lever to the contact: how much of the whole that is depends on where the contact is,
//! so demands are tabulated by reach, as the largest of all contacts of about one distance from the base: those of one reach are within a
//! factor of `2^(1/4)` of each other.

use crate::rod::RadiusProfile;

/// Reaches by which the distance from the base halves.
const REACHES_PER_OCTAVE: f64 = 4.0;

/// Reaches in all; contacts of the last one are within a 4096th of the whisker from the base.
const REACHES: u32 = 49;

/// How far the sheet goes beyond the tip at most, in whisker lengths from the base.
const BEYOND_TIP: f64 = 1.5;

/// What a piece asks for on the way from contacts of one reach. In `f32`, because it only counts steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// Its part in the bending that has to be followed: the root of its share in the compliance times its part of the way, or half
    /// of its share. On a rod that is the same everywhere, its part of the way, about.
    pub bending: f32,
    /// How rough it is: by how much `ln radius` changes over it, times the fifth root of the same product. The levers at five nodes
    /// feel its compliance to the fifth order (`benches/NOTES.md`).
    pub roughness: f32,
}

/// The demands of the pieces, by reach.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Demands {
    /// Piece by piece, from the reach at the tip on.
    by_reach: Vec<Demand>,
    pieces: usize,
}

impl Demands {
    /// Those of the pieces of `profile`, whose scale vanishes at the arclength `end`.
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
            let ways = profile
                .widths
                .iter()
                .map(|width| (width / nearest).min(1.0));
            let demand = |((share, way), change): ((&f64, f64), &f64)| Demand {
                bending: (share * way).sqrt().max(0.5 * share) as f32,
                roughness: (change * libm::pow(share * way, 0.2)) as f32,
            };
            let from = by_reach.len();
            by_reach.extend(shares.iter().zip(ways).zip(&profile.changes).map(demand));
            // The piece beyond the tip has no length of its own: it asks for as much as any other.
            let most = |one: Demand, other: &Demand| Demand {
                bending: one.bending.max(other.bending),
                roughness: one.roughness.max(other.roughness),
            };
            let tail = by_reach[from..].iter().fold(Demand::default(), most);
            by_reach[from + pieces - 1] = tail;
        }
        Self { by_reach, pieces }
    }

    /// The reach of contacts at arclength `s`.
    #[must_use]
    pub fn reach(s: f64) -> u32 {
        ((-REACHES_PER_OCTAVE * libm::log2(s)) as u32).min(REACHES - 1)
    }

    /// That of the piece `k` on the way from a contact of this `reach`.
    #[must_use]
    pub fn of(&self, reach: u32, k: usize) -> Demand {
        self.by_reach[reach as usize * self.pieces + k]
    }
}
