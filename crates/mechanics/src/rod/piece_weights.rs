//! The compliance of the pieces of a profile, as the weight with which collocation integrates levers: it is the same for all
//! trajectories that cross a piece, and tabulated when the first one asks.

use crate::numerics::gauss::{Integrals, Weight, integrals};
use crate::rod::rod::arclength_at;
use crate::rod::{Piece, RadiusProfile};
use std::sync::OnceLock;

/// Numbers of steps along a piece that are tabulated: more are rare.
const TABULATED: usize = 8;

/// The integrals of every step along a piece, from its far end on.
type Steps = Box<[Integrals<f64>]>;

/// The integrals of every piece, for 1 to so many steps.
#[derive(Clone, Debug, Default)]
pub struct PieceWeights(Vec<[OnceLock<Steps>; TABULATED]>);

/// What has been asked for is no property of a profile.
impl PartialEq for PieceWeights {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// `radius^-4` backward along a part of a piece.
struct Backward<'a> {
    piece: &'a Piece,
    from: f64,
    length: f64,
}

impl Weight<f64> for Backward<'_> {
    fn at(&self, x: f64) -> f64 {
        let radius = self.piece.radius(self.length.mul_add(-x, self.from));
        (radius * radius * radius * radius).recip()
    }
}

impl PieceWeights {
    /// Nothing yet, for so many `pieces`.
    pub(super) fn new(pieces: usize) -> Self {
        Self(vec![[const { OnceLock::new() }; TABULATED]; pieces])
    }
}

impl RadiusProfile {
    /// Where the piece `k` ends, as `tau` and arclength; none beyond the last row.
    #[must_use]
    #[inline]
    pub fn end_of(&self, k: usize) -> Option<[f64; 2]> {
        let next = self.pieces.get(k + 1)?;
        Some([next.tau, next.from])
    }

    /// The compliance of each of so many `steps` along the whole of piece `k`, from its end on, as a weight over arclength; none
    /// where it is not tabulated.
    #[must_use]
    #[inline]
    pub fn weights(&self, k: usize, steps: u32) -> Option<&[Integrals<f64>]> {
        let table = self.weights.0[k].get((steps as usize).wrapping_sub(1))?;
        let end = self.end_of(k)?;
        Some(table.get_or_init(|| self.integrate_piece(k, end, steps)))
    }

    #[cold]
    fn integrate_piece(&self, k: usize, [end, _]: [f64; 2], steps: u32) -> Steps {
        let piece = &self.pieces[k];
        let h = (end - piece.tau) / f64::from(steps);
        let step = |i| {
            let at = |i: u32| arclength_at(self.taper, f64::from(i).mul_add(-h, end));
            let (from, to) = (at(i), at(i + 1));
            let length = from - to;
            let backward = Backward {
                piece,
                from,
                length,
            };
            integrals(&backward).map(|row| row.map(|weight| length * weight))
        };
        (0..steps).map(step).collect()
    }
}
