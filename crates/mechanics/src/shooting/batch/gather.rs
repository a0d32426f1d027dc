//! Rest shapes and materials of the rods of a block, side by side in lanes.

use crate::numerics::{Lanes, WIDTH};
use crate::rod::Piece;
use crate::rod::Rod;
use crate::shooting::batch::Launch;
use crate::shooting::batch::kernel::Block;
use crate::shooting::contact::{arc, parabola_tangent};
use crate::shooting::{Bent, Intrinsic, Spiral, Straight};
use crate::shooting::{Even, Graded, Material, Measured};

/// What `number` tells of each launch. (`map` of an array is not inlined into functions for a SIMD unit.)
#[inline(always)]
pub fn numbers(launches: &Block, number: impl Fn(&Launch) -> f64) -> [f64; WIDTH] {
    let mut numbers = [0.0; WIDTH];
    for (lane, launch) in numbers.iter_mut().zip(launches) {
        *lane = number(launch);
    }
    numbers
}

/// The same in lanes.
#[inline(always)]
pub fn lanes<T: Lanes>(launches: &Block, number: impl Fn(&Launch) -> f64) -> T {
    T::pack(numbers(launches, number))
}

/// A place on each rod of a block.
pub struct Place<T> {
    /// `tau` there.
    pub tau: T,
    /// Scale of the coordinates.
    pub radius: T,
    /// Arclength from the base.
    pub s: T,
}

impl<T: Lanes> Place<T> {
    #[inline(always)]
    fn base() -> Self {
        let zero = T::of(0.0);
        Self {
            tau: zero,
            radius: T::of(1.0),
            s: zero,
        }
    }
}

/// A material that can be gathered from the rods of a block, and the way along it.
pub trait GatherMaterial<T: Lanes>: Material<T> {
    /// The material on piece `piece` of a profile.
    fn gather(launches: &Block, piece: usize) -> Self;

    /// Stiffness at the contacts, over that at the base; `radius` and `s` are those there.
    fn stiffness(launches: &Block, radius: T, s: T) -> T;

    /// Where piece `piece` begins; the base for the first one.
    fn begin(launches: &Block, piece: usize) -> Place<T>;

    /// How many pieces the way from the contacts at the arclengths `s` to the base has.
    fn pieces(launches: &Block, s: T) -> usize;
}

impl<T: Lanes> GatherMaterial<T> for Even {
    #[inline(always)]
    fn gather(_: &Block, _: usize) -> Self {
        Self
    }

    #[inline(always)]
    fn stiffness(_: &Block, radius: T, _: T) -> T {
        radius * radius * (radius * radius)
    }

    #[inline(always)]
    fn begin(_: &Block, _: usize) -> Place<T> {
        Place::base()
    }

    #[inline(always)]
    fn pieces(_: &Block, _: T) -> usize {
        1
    }
}

impl<T: Lanes> GatherMaterial<T> for Graded<T> {
    #[inline(always)]
    fn gather(launches: &Block, _: usize) -> Self {
        let gradient: T = lanes(launches, |launch| launch.rod.gradient);
        Self { gradient }
    }

    #[inline(always)]
    fn stiffness(launches: &Block, radius: T, s: T) -> T {
        let gradient: T = lanes(launches, |launch| launch.rod.gradient);
        radius * radius * (radius * radius) * gradient.mul_add(s, T::of(1.0))
    }

    #[inline(always)]
    fn begin(_: &Block, _: usize) -> Place<T> {
        Place::base()
    }

    #[inline(always)]
    fn pieces(_: &Block, _: T) -> usize {
        1
    }
}

impl<T: Lanes> GatherMaterial<T> for Measured<T> {
    #[inline(always)]
    fn gather(launches: &Block, piece: usize) -> Self {
        // A rod without a profile has no business in this kernel; its piece is its own cone.
        let pieces = launches.map(|launch| match launch.rod.profile {
            Some(profile) => profile.pieces[piece],
            None => Piece::cone(launch.rod.taper),
        });
        Self {
            from: T::pack(pieces.map(|piece| piece.from)),
            cubic: std::array::from_fn(|i| T::pack(pieces.map(|piece| piece.cubic[i]))),
            gradient: lanes(launches, |launch| launch.rod.gradient),
        }
    }

    #[inline(always)]
    fn stiffness(launches: &Block, _: T, s: T) -> T {
        let s = s.unpack();
        T::pack(std::array::from_fn(|i| launches[i].rod.stiffness(s[i])))
    }

    #[inline(always)]
    fn begin(launches: &Block, piece: usize) -> Place<T> {
        let begin = |rod: &Rod| {
            rod.profile
                .map_or(0.0, |profile| profile.pieces[piece].from)
        };
        Place {
            tau: lanes(launches, |Launch { rod, .. }| rod.tau(begin(rod))),
            radius: lanes(launches, |Launch { rod, .. }| 1.0 - rod.taper * begin(rod)),
            s: lanes(launches, |Launch { rod, .. }| begin(rod)),
        }
    }

    #[inline(always)]
    fn pieces(launches: &Block, s: T) -> usize {
        launches[0].rod.piece(s.unpack()[0]) + 1
    }
}

/// A rest shape that can be gathered from the rods of a block.
pub trait Gather<T: Lanes>: Intrinsic<T> {
    /// The rest shape, and what is known of it at the arclengths `s`.
    fn gather(launches: &Block, s: T) -> (Self, AtRest<T, Self::State>);
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
    fn gather(_: &Block, _: T) -> (Self, AtRest<T, ()>) {
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
    fn gather(launches: &Block, s: T) -> (Self, AtRest<T, [T; 2]>) {
        let bend = lanes(launches, |launch| launch.rod.bend);
        let twice_bend = bend + bend;
        let is_level = launches.iter().all(|launch| launch.rod.slope == 0.0);
        let at_base = if is_level {
            T::of(0.0)
        } else {
            arc(lanes(launches, |launch| launch.rod.slope))
        };
        let [cos, sin] = parabola_tangent(bend, at_base, s);
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
    fn gather(launches: &Block, s: T) -> (Self, AtRest<T, ()>) {
        let coefficient =
            |i: usize| move |launch: &Launch| launch.rod.spiral.unwrap_or_default()[i];
        let spiral = Self {
            at_base: lanes(launches, coefficient(0)),
            slope: lanes(launches, coefficient(1)),
        };
        let at_rest = AtRest {
            state: (),
            curvature: spiral.slope.mul_add(s, spiral.at_base),
            slope: spiral.slope,
        };
        (spiral, at_rest)
    }
}
