//! Rest shapes and materials of the rods of a block, side by side in lanes.

use super::Launch;
use crate::model::radius::Piece;
use crate::model::rhs::{Bent, Even, Graded, Intrinsic, Material, Measured, Spiral, Straight};
use crate::model::simd::{Lanes, WIDTH};
use crate::model::{Rod, Start};

/// A material that can be gathered from the rods of a block, and the way along it.
pub trait GatherMaterial<T: Lanes>: Material<T> {
    /// The material on piece `piece` of a profile.
    fn gather(launches: &[Launch; WIDTH], piece: usize) -> Self;

    /// How many pieces the way from the contacts to the base has.
    fn pieces(launches: &[Launch; WIDTH]) -> usize;
}

impl<T: Lanes> GatherMaterial<T> for Even {
    #[inline(always)]
    fn gather(_: &[Launch; WIDTH], _: usize) -> Self {
        Self
    }

    #[inline(always)]
    fn pieces(_: &[Launch; WIDTH]) -> usize {
        1
    }
}

impl<T: Lanes> GatherMaterial<T> for Graded<T> {
    #[inline(always)]
    fn gather(launches: &[Launch; WIDTH], _: usize) -> Self {
        let gradient = T::pack(launches.map(|launch| launch.rod.gradient));
        Self { gradient }
    }

    #[inline(always)]
    fn pieces(_: &[Launch; WIDTH]) -> usize {
        1
    }
}

impl<T: Lanes> GatherMaterial<T> for Measured<T> {
    #[inline(always)]
    fn gather(launches: &[Launch; WIDTH], piece: usize) -> Self {
        // A rod without a profile has no business in this kernel; its piece is its own cone.
        let pieces = launches.map(|launch| match launch.rod.profile {
            Some(profile) => profile.pieces[piece],
            None => Piece::cone(launch.rod.taper),
        });
        Self {
            from: T::pack(pieces.map(|piece| piece.from)),
            cubic: std::array::from_fn(|i| T::pack(pieces.map(|piece| piece.cubic[i]))),
            gradient: T::pack(launches.map(|launch| launch.rod.gradient)),
        }
    }

    #[inline(always)]
    fn pieces(launches: &[Launch; WIDTH]) -> usize {
        launches[0].rod.piece(launches[0].tau) + 1
    }
}

/// A rest shape that can be gathered from the rods of a block.
pub trait Gather<T: Lanes>: Intrinsic<T> {
    fn gather(rods: &[Rod; WIDTH], starts: &[Start; WIDTH]) -> (Self, Self::State);
}

impl<T: Lanes> Gather<T> for Straight {
    #[inline(always)]
    fn gather(_: &[Rod; WIDTH], _: &[Start; WIDTH]) -> (Self, ()) {
        (Self, ())
    }
}

impl<T: Lanes> Gather<T> for Bent<T> {
    #[inline(always)]
    fn gather(rods: &[Rod; WIDTH], starts: &[Start; WIDTH]) -> (Self, [T; 2]) {
        let twice_bend = T::pack(rods.map(|rod| 2.0 * rod.bend));
        let cos = T::pack(starts.map(|start| start.rest.x));
        let sin = T::pack(starts.map(|start| start.rest.y));
        (Self { twice_bend }, [cos, sin])
    }
}

impl<T: Lanes> Gather<T> for Spiral<T> {
    #[inline(always)]
    fn gather(rods: &[Rod; WIDTH], _: &[Start; WIDTH]) -> (Self, ()) {
        let coefficients = rods.map(|rod| rod.spiral.unwrap_or_default());
        let spiral = Self {
            at_base: T::pack(coefficients.map(|[k0, _]| k0)),
            slope: T::pack(coefficients.map(|[_, k1]| k1)),
        };
        (spiral, ())
    }
}
