//! Rest shapes and materials of the rods of a block, side by side in lanes.

use crate::numerics::{Lanes, WIDTH};
use crate::rod::Piece;
use crate::rod::Rod;
use crate::shooting::batch::InitialCondition;
use crate::shooting::contact::{arc, parabola_tangent};
use crate::shooting::{Bent, Intrinsic, Spiral, Straight};
use crate::shooting::{Graded, Material, Measured, Uniform};

/// One condition for every lane.
pub type Conditions<'a> = [&'a InitialCondition<'a>; WIDTH];

/// What `number` tells of each condition. (`map` of an array is not inlined into functions for a SIMD unit.)
#[inline(always)]
pub fn numbers(conditions: &Conditions, number: impl Fn(&InitialCondition) -> f64) -> [f64; WIDTH] {
    let mut numbers = [0.0; WIDTH];
    for (lane, condition) in numbers.iter_mut().zip(conditions) {
        *lane = number(condition);
    }
    numbers
}

/// The same in lanes.
#[inline(always)]
pub fn lanes<T: Lanes>(conditions: &Conditions, number: impl Fn(&InitialCondition) -> f64) -> T {
    T::pack(numbers(conditions, number))
}

/// A place along each rod of a block.
pub struct ArcPosition<T> {
    /// `tau` there.
    pub tau: T,
    /// Scale of the coordinates.
    pub radius: T,
    /// Arclength from the base.
    pub s: T,
}

/// A material that can be gathered from the rods of a block, and the way along it.
pub trait GatherMaterial<T: Lanes>: Material<T> {
    /// The material on piece `piece` of a profile.
    fn gather(conditions: &Conditions, piece: usize) -> Self;

    /// Stiffness at the contacts, over that at the base; `radius` and `s` are those there.
    fn stiffness(conditions: &Conditions, radius: T, s: T) -> T;

    /// Where piece `piece` begins; the base for the first one.
    #[inline(always)]
    fn begin(_conditions: &Conditions, _piece: usize) -> ArcPosition<T> {
        ArcPosition {
            tau: T::of(0.0),
            radius: T::of(1.0),
            s: T::of(0.0),
        }
    }

    /// How many pieces the way from the contacts at the arclengths `s` to the base has.
    #[inline(always)]
    fn pieces(_conditions: &Conditions, _s: T) -> usize {
        1
    }
}

impl<T: Lanes> GatherMaterial<T> for Uniform {
    #[inline(always)]
    fn gather(_: &Conditions, _: usize) -> Self {
        Self
    }

    #[inline(always)]
    fn stiffness(_: &Conditions, radius: T, _: T) -> T {
        radius * radius * (radius * radius)
    }
}

impl<T: Lanes> GatherMaterial<T> for Graded<T> {
    #[inline(always)]
    fn gather(conditions: &Conditions, _: usize) -> Self {
        let gradient: T = lanes(conditions, |condition| condition.rod.gradient);
        Self { gradient }
    }

    #[inline(always)]
    fn stiffness(conditions: &Conditions, radius: T, s: T) -> T {
        let gradient: T = lanes(conditions, |condition| condition.rod.gradient);
        radius * radius * (radius * radius) * gradient.mul_add(s, T::of(1.0))
    }
}

impl<T: Lanes> GatherMaterial<T> for Measured<T> {
    #[inline(always)]
    fn gather(conditions: &Conditions, piece: usize) -> Self {
        // A rod without a profile comes here only where the method has the effect; its piece is its own cone.
        let pieces = conditions.map(|condition| match &condition.rod.profile {
            Some(profile) => profile.pieces[piece],
            None => Piece::cone(condition.rod.taper),
        });
        Self {
            from: T::pack(pieces.map(|piece| piece.from)),
            cubic: std::array::from_fn(|i| T::pack(pieces.map(|piece| piece.cubic[i]))),
            gradient: lanes(conditions, |condition| condition.rod.gradient),
        }
    }

    #[inline(always)]
    fn stiffness(conditions: &Conditions, _: T, s: T) -> T {
        let s = s.unpack();
        T::pack(std::array::from_fn(|i| conditions[i].rod.stiffness(s[i])))
    }

    #[inline(always)]
    fn begin(conditions: &Conditions, piece: usize) -> ArcPosition<T> {
        let begin = |rod: &Rod| {
            rod.profile
                .as_ref()
                .map_or(0.0, |profile| profile.pieces[piece].from)
        };
        ArcPosition {
            tau: lanes(conditions, |InitialCondition { rod, .. }| {
                rod.tau(begin(rod))
            }),
            radius: lanes(conditions, |InitialCondition { rod, .. }| {
                1.0 - rod.taper * begin(rod)
            }),
            s: lanes(conditions, |InitialCondition { rod, .. }| begin(rod)),
        }
    }

    #[inline(always)]
    fn pieces(conditions: &Conditions, s: T) -> usize {
        conditions[0].rod.piece(s.unpack()[0]) + 1
    }
}

/// A rest shape that can be gathered from the rods of a block.
pub trait Gather<T: Lanes>: Intrinsic<T> {
    /// The rest shape, and what is known of it at the arclengths `s`.
    fn gather(conditions: &Conditions, s: T) -> (Self, AtRest<T, Self::State>);
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
    fn gather(_: &Conditions, _: T) -> (Self, AtRest<T, ()>) {
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
    fn gather(conditions: &Conditions, s: T) -> (Self, AtRest<T, [T; 2]>) {
        let bend = lanes(conditions, |condition| condition.rod.bend);
        let twice_bend = bend + bend;
        let is_level = conditions
            .iter()
            .all(|condition| condition.rod.slope == 0.0);
        let at_base = if is_level {
            T::of(0.0)
        } else {
            arc(lanes(conditions, |condition| condition.rod.slope))
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
    fn gather(conditions: &Conditions, s: T) -> (Self, AtRest<T, ()>) {
        let coefficient = |i: usize| {
            move |condition: &InitialCondition| condition.rod.spiral.unwrap_or_default()[i]
        };
        let spiral = Self {
            at_base: lanes(conditions, coefficient(0)),
            slope: lanes(conditions, coefficient(1)),
        };
        let at_rest = AtRest {
            state: (),
            curvature: spiral.slope.mul_add(s, spiral.at_base),
            slope: spiral.slope,
        };
        (spiral, at_rest)
    }
}
