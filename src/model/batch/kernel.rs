//! One specialised kernel per set of effects: no branch on an effect is left inside.

use super::gather::{Gather, GatherMaterial};
use super::{Kind, Launch};
use crate::model::Effects;
use crate::model::contact::{Contact, radius_and_arclength};
use crate::model::integrator::{Integrator, Scales, integrate};
use crate::model::landing::Pressed;
use crate::model::rhs::{
    Bent, Even, Graded, Measured, RodSystem, Section, Spiral, State, Straight,
};
use crate::model::simd::{Lanes, WIDTH};

/// One specialised kernel per set of effects.
#[inline(always)]
pub fn by_effects<M: Integrator, K: Kind<N>, T: Lanes, const N: usize>(
    effects: Effects,
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH] {
    match (effects.curvature, effects.spiral) {
        (_, true) => by_stiffness::<M, K, T, Spiral<_>, N>(effects, steps, launches),
        (true, false) => by_stiffness::<M, K, T, Bent<_>, N>(effects, steps, launches),
        (false, false) => by_stiffness::<M, K, T, Straight, N>(effects, steps, launches),
    }
}

/// The same for a rest shape. A profile has one kernel with a gradient or without: it costs one multiplication.
#[inline(always)]
fn by_stiffness<M: Integrator, K: Kind<N>, T: Lanes, I: Gather<T>, const N: usize>(
    effects: Effects,
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH] {
    match (effects.profile, effects.gradient, effects.advances()) {
        (true, _, _) => block::<M, K, T, I, Measured<_>, true, N>(steps, launches),
        (false, true, _) => block::<M, K, T, I, Graded<_>, true, N>(steps, launches),
        (false, false, true) => block::<M, K, T, I, Even, true, N>(steps, launches),
        (false, false, false) => block::<M, K, T, I, Even, false, N>(steps, launches),
    }
}

/// Integrates `WIDTH` trajectories in step.
#[inline(always)]
fn block<M, K, T, I, C, const TAPER: bool, const N: usize>(
    steps: u32,
    launches: &[Launch; WIDTH],
) -> [K::Answer; WIDTH]
where
    M: Integrator,
    K: Kind<N>,
    T: Lanes,
    I: Gather<T>,
    C: GatherMaterial<T>,
{
    let rods = launches.each_ref().map(|launch| &launch.rod);
    let tau = launches.map(|launch| launch.tau);
    let load = T::pack(launches.map(|launch| launch.load));
    let taper = T::pack(rods.map(|rod| rod.taper));
    let [radius, s] = radius_and_arclength(taper, T::pack(tau));
    let (intrinsic, at_rest) = I::gather(&rods, s);
    let (zero, one) = (T::of(0.0), T::of(1.0));
    // The contact's tangent is that of the angle of friction.
    let friction = T::pack(rods.map(|rod| rod.friction));
    let cos = one / friction.mul_add(friction, one).sqrt();
    let contact = Contact {
        force: load * radius * radius,
        tangent: [cos, friction * cos],
        stiffness: C::stiffness(launches, radius, s),
        curvature: at_rest.curvature,
        curvature_slope: at_rest.slope,
    };
    let force = contact.force;
    let [c, sin] = contact.tangent;
    let mut state: State<_, I, N> = (at_rest.state, ([c, sin, zero, zero], K::start(&contact)));
    let (radius, force_at, s) = (radius.unpack(), force.unpack(), s.unpack());
    let mut from: [_; WIDTH] = std::array::from_fn(|i| (tau[i], radius[i], s[i]));
    for piece in (0..C::pieces(launches)).rev() {
        let to = rods.map(|rod| {
            let s = rod
                .profile
                .map_or(0.0, |profile| profile.pieces[piece].from);
            (rod.tau(s), 1.0 - rod.taper * s, s)
        });
        let h = T::pack(std::array::from_fn(|i| {
            (from[i].0 - to[i].0) / f64::from(steps)
        }));
        let system = RodSystem {
            force,
            intrinsic,
            material: C::gather(launches, piece),
        };
        let (scales, rho) = if TAPER {
            (
                Scales::tapered::<M>(taper, h),
                T::pack(from.map(|(_, rho, _)| rho)),
            )
        } else {
            (Scales::cylinder::<M>(h), one)
        };
        let section = Section {
            rho,
            inverse_cube: one / (rho * rho * rho),
            arclength: T::pack(from.map(|(_, _, s)| s)),
        };
        state = integrate::<M, _, I, C, K, N>(&system, &scales, section, h, steps, state);
        from = to;
    }
    let (_, (rod, sens)) = state;
    let (rod, sens) = (rod.map(T::unpack), sens.map(T::unpack));
    lanes::<T, _>(|i| {
        let pressed = Pressed {
            radius: radius[i],
            force: force_at[i],
        };
        K::answer(rods[i], pressed, &rod.map(|x| x[i]), &sens.map(|x| x[i]))
    })
}

/// Something for every lane that `T` has; the others repeat the first.
#[inline(always)]
fn lanes<T: Lanes, A: Copy>(each: impl Fn(usize) -> A) -> [A; WIDTH] {
    let first = each(0);
    std::array::from_fn(|i| {
        if i == 0 || i >= T::LANES {
            first
        } else {
            each(i)
        }
    })
}
