//! Trajectories on the device: any list of rods, contacts and loads, thousands at once.

use super::device::{Device, copy_back};
use super::flight::binding;
use super::packing::{Scalar, WORKGROUP};
use super::{EngineError, Gpu, Precision, shaders};
use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::hash_map::Entry;
use std::ops::Range;
use wgpu::BufferUsages as Usage;
use whiskmap_mechanics::rod::{Effects, Rest, Rod, arclength};
use whiskmap_mechanics::shooting::PlainState;
use whiskmap_mechanics::shooting::batch::{InitialCondition, Method};

/// Maximum number of steps of all trajectories of a submission: tens of milliseconds where `f64` is slow, and enough for every lane elsewhere.
const MOST_STEPS: u64 = 1 << 21;

/// Rod in the layout of the shaders.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuRod<T> {
    taper: T,
    twice_bend: T,
    spiral: [T; 2],
    curvature: [T; 8],
    tangent: [T; 2],
    unused: [T; 2],
}

/// Contact of a trajectory in the layout of the shaders: `tau`, force, radius, arclength, and the unit tangent of a parabola at rest.
type GpuContact<T> = [T; 8];

/// Numbers of a state as the shaders write them: tangent, position, energy, and three others.
const NUMBERS: usize = 8;

impl<T: Scalar> GpuRod<T> {
    fn new(rod: &Rod) -> Self {
        let mut curvature = [T::of(0.0); 8];
        let polynomial = rod.polynomial.iter().flat_map(|own| own.centred());
        for (own, term) in curvature.iter_mut().zip(polynomial) {
            *own = T::of(*term);
        }
        Self {
            taper: T::of(rod.taper),
            twice_bend: T::of(2.0 * rod.bend),
            spiral: rod.spiral.unwrap_or_default().map(T::of),
            curvature,
            tangent: rod.contact_tangent().to_array().map(T::of),
            unused: [T::of(0.0); 2],
        }
    }
}

/// The contact of a trajectory.
fn contact<T: Scalar>(condition: &InitialCondition) -> GpuContact<T> {
    let InitialCondition { rod, tau, load } = *condition;
    let (radius, s) = (rod.radius(tau), arclength(rod, tau));
    let rest = Rest::parabola_tangent(rod, s);
    [
        tau,
        load * radius * radius,
        radius,
        s,
        rest.x,
        rest.y,
        0.0,
        0.0,
    ]
    .map(T::of)
}

/// Returns `Ok` if the device integrates trajectories of whiskers with these effects.
///
/// # Errors
/// The effect that only the CPU integrates.
pub const fn shoots(effects: Effects) -> Result<(), &'static str> {
    if effects.profile {
        Err("trajectories along measured radii are integrated on the CPU")
    } else if effects.gradient {
        Err("trajectories along a modulus gradient are integrated on the CPU")
    } else {
        Ok(())
    }
}

impl Gpu {
    /// Integrates trajectories on the device, in the engine's precision, and returns their states: `[trajectory]`. The effects are those of the
    /// rods and of the method.
    ///
    /// # Errors
    /// [`EngineError::Unsupported`] if a rod has effects that the shader lacks ([`shoots`]); [`EngineError::Device`] when the device fails.
    pub fn shoot(
        &mut self,
        method: Method,
        conditions: &[InitialCondition],
    ) -> Result<Vec<PlainState>, EngineError> {
        let keys = conditions.par_iter().map(|own| {
            let steps = method.resolution.steps(own.rod, own.tau, own.load);
            (method.effects.and(own.rod), steps)
        });
        let keys: Vec<(Effects, u32)> = keys.collect();
        for (effects, _) in &keys {
            shoots(*effects).map_err(|why| EngineError::Unsupported {
                adapter: self.device.info.name.clone(),
                what: format!("shoot: {why}"),
            })?;
        }
        // Neighbours share a kernel, and take equal numbers of steps.
        let mut order: Vec<usize> = (0..conditions.len()).collect();
        order.par_sort_by_key(|index| keys[*index]);
        let mut states = vec![PlainState::default(); conditions.len()];
        self.working(|gpu| {
            for group in order.chunk_by(|a, b| keys[*a].0 == keys[*b].0) {
                let steps: Vec<u32> = group.iter().map(|index| keys[*index].1).collect();
                for part in submissions(&steps) {
                    let (part, steps) = (&group[part.clone()], &steps[part]);
                    let effects = keys[part[0]].0;
                    let found = match gpu.precision {
                        Precision::F32 => gpu.shoot_in::<f32>(effects, conditions, part, steps),
                        Precision::F64 => gpu.shoot_in::<f64>(effects, conditions, part, steps),
                    };
                    for (index, state) in part.iter().zip(found?) {
                        states[*index] = state;
                    }
                }
            }
            Ok(states)
        })
    }

    /// Integrates `part` of the `conditions` in one submission, each in so many `steps`.
    fn shoot_in<T: Scalar>(
        &mut self,
        effects: Effects,
        conditions: &[InitialCondition],
        part: &[usize],
        steps: &[u32],
    ) -> Result<Vec<PlainState>, EngineError> {
        let device = &self.device;
        let pipeline = match self.shooters.entry(effects) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let text = shaders::shoot(self.precision);
                let constants = shaders::effects(effects);
                new.insert(device.pipeline("shoot", &text, &constants)?)
            }
        };
        let mut rods: Vec<(&Rod, GpuRod<T>)> = Vec::new();
        let mut heads = Vec::with_capacity(part.len());
        for (index, steps) in part.iter().zip(steps) {
            let rod = conditions[*index].rod;
            let is_last = |(last, _): &(&Rod, _)| std::ptr::eq(*last, rod);
            if !rods.last().is_some_and(is_last) {
                rods.push((rod, GpuRod::new(rod)));
            }
            // A submission has fewer rods than `u32` can count.
            heads.push([rods.len() as u32 - 1, *steps]);
        }
        let rods: Vec<GpuRod<T>> = rods.into_iter().map(|(_, rod)| rod).collect();
        let contacts = part.par_iter();
        let contacts = contacts.map(|index| contact::<T>(&conditions[*index]));
        let contacts: Vec<GpuContact<T>> = contacts.collect();
        let inputs = [
            bytemuck::cast_slice(&rods),
            bytemuck::cast_slice(&heads),
            bytemuck::cast_slice(&contacts),
        ];
        let found: Vec<[T; NUMBERS]> = submit(device, pipeline, inputs, part.len())?;
        let read = part.par_iter().zip(&contacts).zip(&found);
        let read = read.map(|((index, contact), found)| {
            let [cos, sin, x, y, energy, ..] = found.map(Into::into);
            let (rod, force): (_, f64) = (conditions[*index].rod, contact[1].into());
            let position = DVec2::new(x, y);
            // The shader knows no mount.
            let turn = rod.mount * force * x;
            let tangent = DVec2::from_angle(turn).rotate(DVec2::new(cos, sin));
            let to_pole = rod.to_pole() - position;
            PlainState {
                pole: DVec2::new(tangent.x, -tangent.y).rotate(to_pole),
                tangent,
                position,
                force,
                energy: (0.5 * force * x).mul_add(turn, energy),
            }
        });
        Ok(read.collect())
    }
}

/// Splits trajectories with these `steps` into submissions of at most [`MOST_STEPS`], or of a single trajectory: ranges of their indices.
fn submissions(steps: &[u32]) -> Vec<Range<usize>> {
    let (mut parts, mut from, mut sum) = (Vec::new(), 0, 0);
    for (index, steps) in steps.iter().enumerate() {
        sum += u64::from(*steps);
        if sum > MOST_STEPS && index > from {
            parts.push(from..index);
            (from, sum) = (index, u64::from(*steps));
        }
    }
    if from < steps.len() {
        parts.push(from..steps.len());
    }
    parts
}

/// Runs `pipeline` on `count` invocations with these `inputs`, and returns what it writes for each.
fn submit<O: Pod>(
    device: &Device,
    pipeline: &wgpu::ComputePipeline,
    inputs: [&[u8]; 3],
    count: usize,
) -> Result<Vec<O>, EngineError> {
    let size = (count * size_of::<O>()) as u64;
    let mut buffers = [None, None, None];
    let mut entries = Vec::with_capacity(4);
    for (own, bytes) in buffers.iter_mut().zip(inputs) {
        device.upload("trajectories", own, bytes)?;
    }
    let states = device.buffer("states", size, Usage::STORAGE | Usage::COPY_SRC)?;
    let readback = device.buffer("readback", size, Usage::MAP_READ | Usage::COPY_DST)?;
    for (index, (own, bytes)) in (0..).zip(buffers.iter().flatten().zip(inputs)) {
        entries.push(binding(index, own, Some(bytes.len() as u64)));
    }
    entries.push(binding(3, &states, Some(size)));
    let bindings = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("shoot"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut commands = device.handle.create_command_encoder(&Default::default());
    {
        let mut pass = commands.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        // A submission has fewer groups than `u32` can count.
        pass.dispatch_workgroups(count.div_ceil(WORKGROUP as usize) as u32, 1, 1);
    }
    copy_back(&mut commands, &states, &readback, size);
    let index = device.queue.submit([commands.finish()]);
    device.check()?;
    device.wait(index)?;
    Device::read(&readback, size, bytemuck::pod_collect_to_vec)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_submission_has_few_steps_or_one_trajectory() {
        let most = MOST_STEPS as u32;
        assert!(submissions(&[]).is_empty());
        assert_eq!(submissions(&[1, most]), [0..1, 1..2]);
        let parts = submissions(&[most - 1, 1, 1, most, most + 9, 5, most - 5, 1]);
        assert_eq!(parts, [0..2, 2..3, 3..4, 4..5, 5..7, 7..8]);
    }
}
