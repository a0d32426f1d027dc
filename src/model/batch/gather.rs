//! Rest shapes and materials of the rods of a block, side by side in lanes.

use super::Launch;
use crate::model::Rod;
use crate::model::contact::parabola_tangent;
use crate::model::radius::Piece;
use crate::model::rhs::{Bent, Even, Graded, Intrinsic, Material, Measured, Spiral, Straight};
use crate::model::simd::{Lanes, WIDTH};

/// A material that can be gathered from the rods of a block, and the way along it.
pub trait GatherMaterial<T: Lanes>: Material<T> {
    /// The material on piece `piece` of a profile.
    fn gather(launches: &[Launch; WIDTH], piece: usize) -> Self;

    /// Stiffness at the contacts, over that at the base; `radius` and `s` are those there.
    fn stiffness(launches: &[Launch; WIDTH], radius: T, s: T) -> T;

    /// How many pieces the way from the contacts to the base has.
    fn pieces(launches: &[Launch; WIDTH]) -> usize;
}

impl<T: Lanes> GatherMaterial<T> for Even {
    #[inline(always)]
    fn gather(_: &[Launch; WIDTH], _: usize) -> Self {
        Self
    }

    #[inline(always)]
    fn stiffness(_: &[Launch; WIDTH], radius: T, _: T) -> T {
        radius * radius * (radius * radius)
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
    fn stiffness(launches: &[Launch; WIDTH], radius: T, s: T) -> T {
        let gradient = T::pack(launches.map(|launch| launch.rod.gradient));
        radius * radius * (radius * radius) * gradient.mul_add(s, T::of(1.0))
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
    fn stiffness(launches: &[Launch; WIDTH], _: T, s: T) -> T {
        let s = s.unpack();
        T::pack(std::array::from_fn(|i| launches[i].rod.stiffness(s[i])))
    }

    #[inline(always)]
    fn pieces(launches: &[Launch; WIDTH]) -> usize {
        launches[0].rod.piece(launches[0].tau) + 1
    }
}

/// A rest shape that can be gathered from the rods of a block.
pub trait Gather<T: Lanes>: Intrinsic<T> {
    /// The rest shape, and what is known of it at the arclengths `s`.
    fn gather(rods: &[&Rod; WIDTH], s: T) -> (Self, AtRest<T, Self::State>);
}

/// The whisker at rest where the contact is.
pub struct AtRest<T, S> {
    /// What the integration carries along.
    pub state: S,
    /// Curvature.
    pub curvature: T,
    /// Its derivative by the arclength.
    pub slope: T,
}

impl<T: Lanes> Gather<T> for Straight {
    #[inline(always)]
    fn gather(_: &[&Rod; WIDTH], _: T) -> (Self, AtRest<T, ()>) {
        let zero = T::of(0.0);
        let at_rest = AtRest {
            state: (),
            curvature: zero,
            slope: zero,
        };
        (Self, at_rest)
    }
}

impl<T: Lanes> Gather<T> for Bent<T> {
    #[inline(always)]
    fn gather(rods: &[&Rod; WIDTH], s: T) -> (Self, AtRest<T, [T; 2]>) {
        let bend = T::pack(rods.map(|rod| rod.bend));
        let twice_bend = bend + bend;
        let slope = T::pack(rods.map(|rod| rod.slope));
        let [cos, sin] = parabola_tangent(bend, slope, s);
        let curvature = twice_bend * cos * cos * cos;
        let at_rest = AtRest {
            state: [cos, sin],
            curvature,
            slope: T::of(-3.0) * twice_bend * curvature * sin * cos * cos,
        };
        (Self { twice_bend }, at_rest)
    }
}

impl<T: Lanes> Gather<T> for Spiral<T> {
    #[inline(always)]
    fn gather(rods: &[&Rod; WIDTH], s: T) -> (Self, AtRest<T, ()>) {
        let coefficients = rods.map(|rod| rod.spiral.unwrap_or_default());
        let spiral = Self {
            at_base: T::pack(coefficients.map(|[k0, _]| k0)),
            slope: T::pack(coefficients.map(|[_, k1]| k1)),
        };
        let at_rest = AtRest {
            state: (),
            curvature: spiral.slope.mul_add(s, spiral.at_base),
            slope: spiral.slope,
        };
        (spiral, at_rest)
    }
}
