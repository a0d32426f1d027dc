//! Counts of the floating-point operations of a trajectory: the integrator's own step runs with numbers that only count.

use crate::numerics::Real;
use crate::numerics::gauss::NODES;
use crate::rod::{CURVATURE_TERMS, Effects, arclength};
use crate::shooting::batch::{InitialCondition, Method, block_key::BlockKey};
use crate::shooting::sensitivity::{GeneralFirst, SimilarFirst};
use crate::shooting::{
    Bent, Graded, Intrinsic, Measured, Nystrom8, Polynomial, Resolution, RodSystem, Scales,
    Section, Spiral, Straight, Uniform, collocate, integrate,
};
use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number without a value, which counts the operations that it takes part in: 1 for an addition, multiplication, division
/// or root, 2 for a fused multiply-add. Constants have no counter: a compiler does the operations among them.
#[derive(Clone, Copy)]
struct Counted<'a>(Option<&'a Cell<u64>>);

impl Counted<'_> {
    #[inline(never)]
    fn operations(self, count: u64, other: Self) -> Self {
        let counter = self.0.or(other.0);
        if let Some(counter) = counter {
            counter.set(counter.get() + count);
        }
        Self(counter)
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait for Counted<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.operations(1, other)
            }
        }
    )*};
}

operator!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Counted<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self
    }
}

impl Real for Counted<'_> {
    fn of(_: f64) -> Self {
        Self(None)
    }

    fn mul_add(self, a: Self, b: Self) -> Self {
        let factor = Self(self.0.or(a.0));
        factor.operations(2, b)
    }

    fn sqrt(self) -> Self {
        self.operations(1, self)
    }
}

/// Returns the number of operations of one trajectory with first derivatives on its way from the contact to the base. It takes `steps`
/// steps of [`Nystrom8`], or along a measured profile those of [`Resolution::of`] `steps`. Stages whose results are not needed are
/// counted as well. The start and the end of a trajectory, a few percent, are not.
#[must_use]
pub fn flops_of_nystrom8(effects: Effects, steps: u32, condition: &InitialCondition) -> u64 {
    let resolution = Resolution::of(steps);
    let method = Method::new(resolution).with_effects(effects);
    let effects = BlockKey::new(method, condition, steps).effects;
    let counter = Cell::new(0);
    let x = Counted(Some(&counter));
    let of_step = match (effects.polynomial, effects.spiral, effects.curvature) {
        (true, ..) => {
            let centred = [x; CURVATURE_TERMS];
            of_step(effects, &counter, Polynomial { centred }, ())
        }
        (false, true, _) => {
            let (at_base, slope) = (x, x);
            of_step(effects, &counter, Spiral { at_base, slope }, ())
        }
        (false, false, true) => of_step(effects, &counter, Bent { twice_bend: x }, [x; 2]),
        (false, false, false) => of_step(effects, &counter, Straight, ()),
    };
    let InitialCondition { rod, tau, load } = condition;
    let steps = rod.profile.as_ref().map_or(steps, |profile| {
        let needs = resolution.of_pieces(rod, *tau, *load);
        let last = rod.piece(arclength(rod, *tau));
        (0..=last).map(|k| needs.of(profile, k)).sum()
    });
    of_step * u64::from(steps)
}

/// Operations of one step with a rest shape in the state `rest`. All numbers of the state are counted ones.
fn of_step<'a, I: Intrinsic<Counted<'a>>>(
    effects: Effects,
    counter: &'a Cell<u64>,
    intrinsic: I,
    rest: I::State,
) -> u64 {
    let x = Counted(Some(counter));
    let section = Section {
        rho: x,
        inverse_cube: x,
        arclength: x,
    };
    let scales = if effects.advances() {
        Scales::tapered::<Nystrom8>(x, x)
    } else {
        Scales::cylinder::<Nystrom8>(x)
    };
    macro_rules! system {
        ($material:expr) => {
            &RodSystem {
                force: x,
                intrinsic,
                material: $material,
            }
        };
    }
    let general = (rest, ([x; 5], ([x; 2], ([x; 2], [x]))));
    let similar = (rest, ([x; 5], ([x], ([x], [x]))));
    let before = counter.get();
    if effects.profile {
        let material = Measured {
            from: x,
            cubic: [x; 4],
            gradient: effects.gradient.then_some(x),
        };
        let (system, weights) = (system!(material), [[x; NODES]; NODES + 1]);
        collocate::<_, I, GeneralFirst>(system, scales.end(), &section, &weights, general);
    } else if effects.gradient {
        let system = system!(Graded { gradient: x });
        integrate::<Nystrom8, _, I, _, GeneralFirst>(system, &scales, section, 1, general);
    } else if effects.similar() {
        let system = system!(Uniform);
        integrate::<Nystrom8, _, I, _, SimilarFirst>(system, &scales, section, 1, similar);
    } else {
        let system = system!(Uniform);
        integrate::<Nystrom8, _, I, _, GeneralFirst>(system, &scales, section, 1, general);
    }
    counter.get() - before
}
