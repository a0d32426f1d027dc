//! Rest shapes and materials of the rods of a block, side by side in lanes.

use crate::numerics::{Lanes, WIDTH};
use crate::rod::{Piece, Rod};
use crate::shooting::batch::InitialCondition;
use crate::shooting::contact::{arc, parabola_tangent};
use crate::shooting::{Bent, Graded, Intrinsic, Material, Measured, Spiral, Straight, Uniform};

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
            tau: lanes(conditions, |at| at.rod.tau(begin(at.rod))),
            radius: lanes(conditions, |at| 1.0 - at.rod.taper * begin(at.rod)),
            s: lanes(conditions, |at| begin(at.rod)),
        }
    }

    #[inline(always)]
    fn pieces(conditions: &Conditions, s: T) -> usize {
        conditions[0].rod.piece(s.unpack()[0]) + 1
    }
}

/// A rest shape that can be gathered from the rods of a block.
pub trait Gather<T: Lanes>: Intrinsic<T> {
    /// The rest shape; and at the arclengths `s` the state that is carried along, and the curvature with its derivative by the
    /// arclength.
    fn gather(conditions: &Conditions, s: T) -> (Self, Self::State, [T; 2]);
}

impl<T: Lanes> Gather<T> for Straight {
    #[inline(always)]
    fn gather(_: &Conditions, _: T) -> (Self, (), [T; 2]) {
        (Self, (), [T::of(0.0); 2])
    }
}

impl<T: Lanes> Gather<T> for Bent<T> {
    #[inline(always)]
    fn gather(conditions: &Conditions, s: T) -> (Self, [T; 2], [T; 2]) {
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
        let slope = T::of(-3.0) * twice_bend * curvature * sin * cos * cos;
        (Self { twice_bend }, [cos, sin], [curvature, slope])
    }
}

impl<T: Lanes> Gather<T> for Spiral<T> {
    #[inline(always)]
    fn gather(conditions: &Conditions, s: T) -> (Self, (), [T; 2]) {
        let coefficient = |i: usize| {
            move |condition: &InitialCondition| condition.rod.spiral.unwrap_or_default()[i]
        };
        let spiral = Self {
            at_base: lanes(conditions, coefficient(0)),
            slope: lanes(conditions, coefficient(1)),
        };
        let curvature = spiral.slope.mul_add(s, spiral.at_base);
        (spiral, (), [curvature, spiral.slope])
    }
}
