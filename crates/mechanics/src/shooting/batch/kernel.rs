//! One specialised kernel per set of effects: no branch on an effect is left inside.

use crate::numerics::{Lanes, WIDTH};
use crate::rod::Effects;
use crate::shooting::batch::gather::{Gather, GatherMaterial, Place, lanes, numbers};
use crate::shooting::batch::output::Derived;
use crate::shooting::batch::{InitialCondition, Method};
use crate::shooting::contact::{Contact, radius_and_arclength};
use crate::shooting::sensitivity::{Arrival, Order};
use crate::shooting::{Bent, Spiral, Straight};
use crate::shooting::{Even, Graded, Measured};
use crate::shooting::{Integrator, Scales, integrate};
use crate::shooting::{RodSystem, Section};

/// The conditions of one block.
pub type Block<'a> = [&'a InitialCondition; WIDTH];

/// One specialised kernel per set of effects.
#[inline(always)]
pub fn by_effects<M: Integrator, K: Derived<T>, T: Lanes>(
    effects: Effects,
    steps: u32,
    conditions: &Block,
) -> [K::Answer; WIDTH] {
    match (effects.curvature, effects.spiral) {
        (_, true) => by_stiffness::<M, K, K::General, T, Spiral<_>>(effects, steps, conditions),
        (true, false) => by_stiffness::<M, K, K::General, T, Bent<_>>(effects, steps, conditions),
        (false, false) => by_stiffness::<M, K, K::Similar, T, Straight>(effects, steps, conditions),
    }
}

/// The same for a rest shape; `E` is what an even cone of that shape has to carry. A profile has one kernel with a gradient
/// or without: it costs one multiplication.
#[inline(always)]
fn by_stiffness<M: Integrator, K: Derived<T>, E, T: Lanes, I: Gather<T>>(
    effects: Effects,
    steps: u32,
    conditions: &Block,
) -> [K::Answer; WIDTH]
where
    E: Order<T, Known = <K::General as Order<T>>::Known>,
{
    match (effects.profile, effects.gradient, effects.advances()) {
        (true, _, _) => block::<M, K, K::General, T, I, Measured<_>, true>(steps, conditions),
        (false, true, _) => block::<M, K, K::General, T, I, Graded<_>, true>(steps, conditions),
        (false, false, true) => block::<M, K, E, T, I, Even, true>(steps, conditions),
        (false, false, false) => block::<M, K, E, T, I, Even, false>(steps, conditions),
    }
}

/// Arclengths of the contacts, and the steps that the trajectories take.
#[inline(always)]
pub fn steps<T: Lanes>(method: Method, conditions: &Block) -> [(f64, u32); WIDTH] {
    let taper = numbers(conditions, |condition| condition.rod.taper);
    let tau = numbers(conditions, |condition| condition.tau);
    let [_, s] = radius_and_arclength(T::pack(taper), T::pack(tau));
    let s = s.unpack();
    let mut steps = [0; WIDTH];
    if method.effects.profile || method.effects.gradient {
        for (lane, condition) in conditions.iter().enumerate() {
            let InitialCondition { rod, tau, load } = condition;
            steps[lane] = method.resolution.steps_from(rod, *tau, *load, s[lane]);
        }
    } else {
        let bend = numbers(conditions, |condition| condition.rod.sharpest_bend());
        let load = numbers(conditions, |condition| condition.load);
        for lane in 0..WIDTH {
            let at = [tau[lane], load[lane], s[lane]];
            steps[lane] = method.resolution.steps_on_even(taper[lane], bend[lane], at);
        }
    }
    let mut pairs = [(0.0, 0); WIDTH];
    for (lane, pair) in pairs.iter_mut().enumerate() {
        *pair = (s[lane], steps[lane]);
    }
    pairs
}

/// Integrates `WIDTH` trajectories in step.
#[inline(always)]
fn block<M, K, O, T, I, C, const TAPER: bool>(steps: u32, conditions: &Block) -> [K::Answer; WIDTH]
where
    M: Integrator,
    K: Derived<T>,
    O: Order<T, Known = <K::General as Order<T>>::Known>,
    T: Lanes,
    I: Gather<T>,
    C: GatherMaterial<T>,
{
    let tau: T = lanes(conditions, |condition| condition.tau);
    let load: T = lanes(conditions, |condition| condition.load);
    let taper: T = lanes(conditions, |condition| condition.rod.taper);
    let [radius, s] = radius_and_arclength(taper, tau);
    let (intrinsic, at_rest) = I::gather(conditions, s);
    let (zero, one) = (T::of(0.0), T::of(1.0));
    // The contact's tangent is that of the angle of friction.
    let friction: T = lanes(conditions, |condition| condition.rod.friction);
    let cos = one / friction.mul_add(friction, one).sqrt();
    let contact = Contact {
        radius,
        force: load * radius * radius,
        tangent: [cos, friction * cos],
        stiffness: C::stiffness(conditions, radius, s),
        curvature: at_rest.curvature,
        curvature_slope: at_rest.slope,
    };
    let [c, sin] = contact.tangent;
    let rod = [c, sin, zero, zero, zero];
    let mut state = (at_rest.state, (rod, O::start(&contact)));
    let mut here = Place { tau, radius, s };
    for piece in (0..C::pieces(conditions, s)).rev() {
        let there = C::begin(conditions, piece);
        let h = (here.tau - there.tau) / T::of(f64::from(steps));
        let system = RodSystem {
            force: contact.force,
            intrinsic,
            material: C::gather(conditions, piece),
        };
        let (scales, rho) = if TAPER {
            (Scales::tapered::<M>(taper, h), here.radius)
        } else {
            (Scales::cylinder::<M>(h), one)
        };
        let section = Section {
            rho,
            inverse_cube: one / (rho * rho * rho),
            arclength: here.s,
        };
        state = integrate::<M, _, I, C, O>(&system, &scales, section, steps, state);
        here = there;
    }
    let (_, (rod, carried)) = state;
    let arrival = Arrival {
        contact,
        taper,
        rod,
    };
    let pole: T = lanes(conditions, |condition| condition.rod.pole);
    // See `Rod::to_pole`.
    let to_pole = [pole * contact.tangent[1], -pole * contact.tangent[0]];
    K::answers(&arrival, to_pole, O::known(&arrival, carried))
}
