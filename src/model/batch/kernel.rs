//! One specialised kernel per set of effects: no branch on an effect is left inside.

use super::gather::{Gather, GatherMaterial};
use super::{Kind, Launch};
use crate::model::integrator::{Integrator, Scales, integrate};
use crate::model::rhs::{
    Bent, Even, Graded, Measured, RodSystem, Section, Spiral, State, Straight,
};
use crate::model::simd::{Lanes, WIDTH};
use crate::model::{Effects, Start};

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
    let rods = launches.map(|launch| launch.rod);
    let starts = lanes::<T, _>(|i| {
        let Launch { rod, tau, load } = &launches[i];
        Start::new(rod, *tau, *load)
    });
    let at_start = lanes::<T, _>(|i| K::start(&starts[i]));

    let (intrinsic, rest) = I::gather(&rods, &starts);
    let force = T::pack(starts.map(|start| start.force));
    let zero = T::of(0.0);
    let mut sens = [zero; N];
    for (n, lane) in sens.iter_mut().enumerate() {
        *lane = T::pack(at_start.map(|values| values[n]));
    }
    let c = T::pack(starts.map(|start| start.tangent.x));
    let s = T::pack(starts.map(|start| start.tangent.y));
    let mut state: State<_, I, N> = (rest, ([c, s, zero, zero], sens));
    let mut from = starts.map(
        |Start {
             tau,
             radius,
             arclength,
             ..
         }| (tau, radius, arclength),
    );
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
        let one = T::of(1.0);
        let (scales, rho) = if TAPER {
            let taper = T::pack(rods.map(|rod| rod.taper));
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
        K::answer(
            &rods[i],
            &starts[i],
            &rod.map(|x| x[i]),
            &sens.map(|x| x[i]),
        )
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
