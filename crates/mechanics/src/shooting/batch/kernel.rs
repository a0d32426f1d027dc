//! Kernels, each specialised for one set of effects, without branches on effects.

use super::block::Block;
use super::block_key::BlockKey;
use super::gather::{Conditions, Contacts, Gather, GatherMaterial, lanes, numbers};
use super::{FEW_KERNELS, Method, OutputSet};
use crate::numerics::{Lanes, LanesTask, SimdTask, WIDTH};
use crate::rod::Effects;
use crate::rod::radius_and_arclength;
use crate::shooting::contact::Contact;
use crate::shooting::mount::in_mount;
use crate::shooting::sensitivity::{Arrival, SensitivitySet};
use crate::shooting::{Bent, Graded, Measured, Polynomial, Spiral, Straight, Uniform};
use std::marker::PhantomData;

/// Task that integrates the trajectories of a block.
pub struct Trajectories<'a, O> {
    key: BlockKey,
    block: &'a Block<'a>,
    outputs: PhantomData<O>,
}

impl<'a, O> Trajectories<'a, O> {
    /// Creates the task for the trajectories of `block`, whose conditions all have this `key`.
    pub const fn new(key: BlockKey, block: &'a Block<'a>) -> Self {
        Self { key, block, outputs: PhantomData }
    }
}

impl<O: OutputSet> SimdTask for Trajectories<'_, O> {
    type Output = [O; WIDTH];

    #[inline(always)]
    fn run<T: Lanes>(self) -> Self::Output {
        if const { T::LANES == 1 } {
            let outputs = self.computed::<O::OnOneLane, f64>();
            return std::array::from_fn(|lane| outputs[lane].into());
        }
        self.computed::<O, T>()
    }
}

impl<O> Trajectories<'_, O> {
    /// The output set `K` of the trajectories.
    #[inline(always)]
    fn computed<K: OutputSet, T: Lanes>(&self) -> [K; WIDTH] {
        let Self { key, block, .. } = self;
        if key.effects.profile {
            return block.in_parts::<T::Narrow, _>(|conditions| {
                along_profile::<K, T::Narrow>(block.method, key, conditions)
            });
        }
        block.in_parts::<T, _>(|conditions| by_effects::<K, T>(block.method, key, conditions))
    }
}

/// Outputs of the kernel for the effects of the `key`, without a profile.
#[inline(always)]
fn by_effects<O: OutputSet, T: Lanes>(
    method: Method,
    key: &BlockKey,
    conditions: &Conditions,
) -> [O; WIDTH] {
    /// Runs the kernel for a rest shape, a material and a set of derivatives, on a rod that changes along its length or not.
    macro_rules! kernel {
        ($rest:ty, $material:ty, $set:ident, $advances:literal) => {
            T::outlined(Kernel::<O, O::$set<T>, $rest, $material, $advances> {
                method,
                key,
                conditions,
                of: PhantomData,
            })
        };
    }
    let Effects { curvature, spiral, polynomial, gradient, .. } = key.effects;
    // On one lane a cylinder is a cone of taper 0: the bits are equal, and fewer kernels are compiled.
    if const { T::LANES > 1 && !FEW_KERNELS } && !key.effects.advances() {
        return if curvature {
            kernel!(Bent<T>, Uniform, General, false)
        } else {
            kernel!(Straight, Uniform, Similar, false)
        };
    }
    if polynomial || FEW_KERNELS && spiral {
        return if gradient || FEW_KERNELS {
            kernel!(Polynomial<T>, Graded<T>, General, true)
        } else {
            kernel!(Polynomial<T>, Uniform, General, true)
        };
    }
    match (spiral, curvature, gradient) {
        (true, _, true) => kernel!(Spiral<T>, Graded<T>, General, true),
        (true, _, false) => kernel!(Spiral<T>, Uniform, General, true),
        (false, true, true) => kernel!(Bent<T>, Graded<T>, General, true),
        (false, true, false) => kernel!(Bent<T>, Uniform, General, true),
        (false, false, true) => kernel!(Straight, Graded<T>, General, true),
        (false, false, false) => kernel!(Straight, Uniform, Similar, true),
    }
}

/// Outputs of the kernel for the effects of the `key` along a profile, by collocation.
#[inline(always)]
fn along_profile<O: OutputSet, T: Lanes>(
    method: Method,
    key: &BlockKey,
    conditions: &Conditions,
) -> [O; WIDTH] {
    macro_rules! kernel {
        ($rest:ty) => {
            T::outlined(Kernel::<O, O::General<T>, $rest, Measured<T>, true> {
                method,
                key,
                conditions,
                of: PhantomData,
            })
        };
    }
    if key.effects.polynomial || FEW_KERNELS && key.effects.spiral {
        return kernel!(Polynomial<T>);
    }
    match (key.effects.spiral, key.effects.curvature || FEW_KERNELS) {
        (true, _) => kernel!(Spiral<T>),
        (false, true) => kernel!(Bent<T>),
        (false, false) => kernel!(Straight),
    }
}

/// Task that integrates as many trajectories as there are lanes.
struct Kernel<'a, O, S, I, C, const ADVANCES: bool> {
    method: Method,
    key: &'a BlockKey,
    conditions: &'a Conditions<'a>,
    of: PhantomData<(O, S, I, C)>,
}

impl<O, S, T, I, C, const ADVANCES: bool> LanesTask<T> for Kernel<'_, O, S, I, C, ADVANCES>
where
    O: OutputSet,
    S: SensitivitySet<T, AtBase = <O::General<T> as SensitivitySet<T>>::AtBase>,
    T: Lanes,
    I: Gather<T>,
    C: GatherMaterial<T>,
{
    type Output = [O; WIDTH];

    #[inline(always)]
    fn run(self) -> [O; WIDTH] {
        let Self { method, key, conditions, .. } = self;
        let tau: T = lanes(conditions, |condition| condition.tau);
        let load: T = lanes(conditions, |condition| condition.load);
        let taper: T = lanes(conditions, |condition| condition.rod.taper);
        let [radius, s] = radius_and_arclength(taper, tau);
        let (intrinsic, at_rest, [curvature, curvature_slope]) = I::gather(conditions, s);
        let (zero, one) = (T::of(0.0), T::of(1.0));
        // See `Rod::contact_tangent`.
        let friction: T = lanes(conditions, |condition| condition.rod.friction);
        let cos = one / friction.mul_add(friction, one).sqrt();
        let contact = Contact {
            radius,
            force: load * radius * radius,
            tangent: [cos, friction * cos],
            stiffness: C::stiffness(conditions, radius, s),
            curvature,
            curvature_slope,
        };
        let [c, sin] = contact.tangent;
        let rod = [c, sin, zero, zero, zero];
        let contacts = Contacts {
            conditions,
            resolution: method.resolution,
            steps: key.steps,
            taper,
            tau,
            radius,
            s,
            force: contact.force,
        };
        let start = (at_rest, (rod, S::start(&contact)));
        let mut observer = O::Observer::<T>::default();
        let (_, (rod, carried)) =
            C::to_base::<I, S, ADVANCES>(&contacts, intrinsic, start, &mut observer);
        let mount = numbers(conditions, |condition| condition.rod.mount);
        let (rod, carried) = if mount == [0.0; WIDTH] {
            (rod, carried)
        } else {
            in_mount::<T, S>(T::pack(mount), contact.force, rod, carried)
        };
        let arrival = Arrival { contact, taper, rod };
        let pole: T = lanes(conditions, |condition| condition.rod.pole);
        // See `Rod::to_pole`.
        let to_pole = [pole * contact.tangent[1], -pole * contact.tangent[0]];
        let at_base = S::at_base(&arrival, carried);
        O::outputs(&arrival, to_pole, at_base, (conditions, observer))
    }
}
