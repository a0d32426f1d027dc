//! Collocation weights of the pieces of a profile, from their compliance. All trajectories that cross a whole piece share its integrals,
//! which are tabulated at their first use.

use crate::numerics::gauss::{Integrals, Weight, integrals};
use crate::rod::rod::arclength_at;
use crate::rod::{Piece, RadiusProfile};
use std::sync::OnceLock;

/// Largest number of steps along a piece that is tabulated.
const TABULATED: usize = 8;

/// Integrals of each step along a piece, from its far end on.
type StepIntegrals = Box<[Integrals<f64>]>;

/// Collocation integrals of each piece of a profile, for each number of steps: `[piece][steps - 1]`.
#[derive(Clone, Debug, Default)]
pub struct PieceWeights(Vec<[OnceLock<StepIntegrals>; TABULATED]>);

/// Tables are equal whatever has been tabulated: that is no property of a profile.
impl PartialEq for PieceWeights {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The weight `radius^-4` backward along a part of a piece.
struct PieceCompliance<'a> {
    piece: &'a Piece,
    from: f64,
    length: f64,
}

impl Weight<f64> for PieceCompliance<'_> {
    fn at(&self, x: f64) -> f64 {
        let radius = self.piece.radius(self.length.mul_add(-x, self.from));
        (radius * radius * radius * radius).recip()
    }
}

impl PieceWeights {
    /// Creates empty tables of collocation integrals for `pieces` pieces.
    pub(super) fn new(pieces: usize) -> Self {
        Self(vec![[const { OnceLock::new() }; TABULATED]; pieces])
    }
}

impl RadiusProfile {
    /// Returns the end `[tau, arclength]` of the piece `k` of a profile; `None` for the piece beyond the last row.
    #[must_use]
    #[inline]
    pub fn end_of(&self, k: usize) -> Option<[f64; 2]> {
        let next = self.pieces.get(k + 1)?;
        Some([next.tau, next.from])
    }

    /// Returns the collocation integrals over the arclength for each of `steps` steps along the whole piece `k`, from its end on: `[step]`. `None` if
    /// they are not tabulated.
    #[must_use]
    #[inline]
    pub fn weights(&self, k: usize, steps: u32) -> Option<&[Integrals<f64>]> {
        let table = self.weights.0[k].get((steps as usize).wrapping_sub(1))?;
        let end = self.end_of(k)?;
        Some(table.get_or_init(|| self.integrate_piece(k, end, steps)))
    }

    #[cold]
    fn integrate_piece(&self, k: usize, [end, _]: [f64; 2], steps: u32) -> StepIntegrals {
        let piece = &self.pieces[k];
        let h = (end - piece.tau) / f64::from(steps);
        let step = |i| {
            let at = |i: u32| arclength_at(self.taper, f64::from(i).mul_add(-h, end));
            let (from, to) = (at(i), at(i + 1));
            let length = from - to;
            let weight = PieceCompliance { piece, from, length };
            integrals(&weight).map(|row| row.map(|weight| length * weight))
        };
        (0..steps).map(step).collect()
    }
}
