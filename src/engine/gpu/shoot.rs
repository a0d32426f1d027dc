//! Trajectories on the device: any list of rods, contacts and loads, thousands at once.

use super::pace::Pace;
use super::packing::{Scalar, WORKGROUP};
use super::submission::Buffers;
use super::{EngineError, Gpu, IN_FLIGHT, Precision, shaders};
use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::collections::hash_map::Entry;
use std::ops::Range;
use std::time::Instant;
use whiskmap_mechanics::rod::{Effects, Rod};
use whiskmap_mechanics::shooting::PlainState;
use whiskmap_mechanics::shooting::batch::{InitialCondition, Method};
use whiskmap_mechanics::shooting::contact::arc;

/// Number of neighbouring trajectories whose states a thread reads at once.
const READ_AT_ONCE: usize = 4096;

/// Number of steps of a trajectory from which on a submission has fewer trajectories than its pace: usual ones have 4 to 30.
const MANY_STEPS: usize = 64;

/// Rod in the layout of the shaders.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuRod<T> {
    taper: T,
    twice_bend: T,
    spiral: [T; 2],
    curvature: [T; 8],
    tangent: [T; 2],
    gradient: T,
    /// The [`arc`] of a parabola's slope at the base.
    arc_at_base: T,
    /// Numbers of a [`StepRule`](whiskmap_mechanics::shooting::StepRule), and an unused one.
    steps: [T; 4],
}

impl<T: Scalar> GpuRod<T> {
    fn new(rod: &Rod, method: Method) -> Self {
        let mut curvature = [T::of(0.0); 8];
        let polynomial = rod.polynomial.iter().flat_map(|polynomial| polynomial.centred());
        for (coefficient, term) in curvature.iter_mut().zip(polynomial) {
            *coefficient = T::of(*term);
        }
        let rule = method.resolution.rule(rod);
        Self {
            taper: T::of(rod.taper),
            twice_bend: T::of(2.0 * rod.bend),
            spiral: rod.spiral.unwrap_or_default().map(T::of),
            curvature,
            tangent: rod.contact_tangent().to_array().map(T::of),
            gradient: T::of(rod.gradient),
            arc_at_base: T::of(arc(rod.slope)),
            steps: [rule.least, rule.bend, rule.fastest, 0.0].map(T::of),
        }
    }
}

/// State in the layout of the shaders: tangent, position, energy, force.
type GpuState<T> = [T; 6];

/// Returns `Ok` if the device integrates trajectories of whiskers with these effects.
///
/// # Errors
/// The effect that only the CPU integrates.
pub const fn shoots(effects: Effects) -> Result<(), &'static str> {
    match effects.profile {
        true => Err("trajectories along measured radii are integrated on the CPU"),
        false => Ok(()),
    }
}

/// Trajectories on the device whose states are not read yet.
struct Volley {
    /// Indices of the trajectories in their list.
    of: Range<usize>,
    submitted: Instant,
    index: wgpu::SubmissionIndex,
    buffers: Buffers,
}

impl Gpu {
    /// Integrates trajectories on the device, in the engine's precision, and returns their states: `[trajectory]`. The effects are those of the
    /// rods and of the method. The list of a thread pool's thread is read on all threads of the pool.
    ///
    /// # Errors
    /// [`EngineError::Unsupported`] if a rod has effects that the shader lacks ([`shoots`]); [`EngineError::Device`] when the device fails.
    pub fn shoot(
        &mut self,
        method: Method,
        conditions: &[InitialCondition],
    ) -> Result<Vec<PlainState>, EngineError> {
        self.shoot_with(self.precision, method, conditions)
    }

    /// Integrates trajectories in `precision`, which the device must have.
    pub(super) fn shoot_with(
        &mut self,
        precision: Precision,
        method: Method,
        conditions: &[InitialCondition],
    ) -> Result<Vec<PlainState>, EngineError> {
        let mut kinds: Vec<Effects> = Vec::new();
        for of_rod in conditions.chunk_by(is_same_rod) {
            let effects = method.effects.and(of_rod[0].rod);
            shoots(effects).map_err(|why| EngineError::Unsupported {
                adapter: self.device.info.name.clone(),
                what: format!("shoot: {why}"),
            })?;
            if !kinds.contains(&effects) {
                kinds.push(effects);
            }
        }
        self.working(|gpu| {
            // The usual list is not copied.
            if let [effects] = kinds[..] {
                return gpu.shoot_kind((precision, effects), method, conditions);
            }
            let mut states = vec![PlainState::default(); conditions.len()];
            for effects in kinds {
                let is_kind = |index: &usize| method.effects.and(conditions[*index].rod) == effects;
                let of: Vec<usize> = (0..conditions.len()).filter(is_kind).collect();
                let of_kind: Vec<_> = of.iter().map(|index| conditions[*index]).collect();
                let found = gpu.shoot_kind((precision, effects), method, &of_kind)?;
                for (index, found) in of.into_iter().zip(found) {
                    states[index] = found;
                }
            }
            Ok(states)
        })
    }

    /// Integrates trajectories of rods with equal effects, by the `kernel` of a precision and these effects.
    fn shoot_kind(
        &mut self,
        kernel: (Precision, Effects),
        method: Method,
        conditions: &[InitialCondition],
    ) -> Result<Vec<PlainState>, EngineError> {
        match kernel.0 {
            Precision::F32 => self.shoot_in::<f32>(kernel, method, conditions),
            Precision::F64 => self.shoot_in::<f64>(kernel, method, conditions),
        }
    }

    fn shoot_in<T: Scalar>(
        &mut self,
        kernel: (Precision, Effects),
        method: Method,
        conditions: &[InitialCondition],
    ) -> Result<Vec<PlainState>, EngineError> {
        let nothing = PlainState::default();
        let mut states = match is_in_pool() {
            // Each thread touches a part of the new memory.
            true => rayon::iter::repeat_n(nothing, conditions.len()).collect(),
            false => vec![nothing; conditions.len()],
        };
        let (mut sent, mut flying) = (0, VecDeque::new());
        loop {
            while flying.len() < IN_FLIGHT && sent < conditions.len() {
                let volley = self.fire::<T>(kernel, method, conditions, sent)?;
                sent = volley.of.end;
                flying.push_back(volley);
            }
            let Some(volley) = flying.pop_front() else {
                return Ok(states);
            };
            self.device.wait(volley.index)?;
            let now = Instant::now();
            let of = volley.of;
            if let Some((_, pace)) = self.shooters.get_mut(&kernel) {
                let started = volley.submitted.max(self.idle_since);
                pace.learn(of.len(), of.end == conditions.len(), now - started);
            }
            self.idle_since = now;
            let part = (&conditions[of.clone()], &mut states[of]);
            volley.buffers.read(|bytes| read::<T>(bytes, part))?;
            self.shoot_buffers.push(volley.buffers);
        }
    }

    /// Submits the trajectories of a list `from` an index on: as many as one submission may have.
    fn fire<T: Scalar>(
        &mut self,
        kernel: (Precision, Effects),
        method: Method,
        conditions: &[InitialCondition],
        from: usize,
    ) -> Result<Volley, EngineError> {
        let device = &self.device;
        let (pipeline, pace) = match self.shooters.entry(kernel) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let text = shaders::shoot(kernel.0);
                let constants = shaders::effects(kernel.1);
                let pipeline = device.pipeline("shoot", &text, &constants)?;
                let groups = device.handle.limits().max_compute_workgroups_per_dimension;
                let bytes = size_of::<GpuState<T>>();
                let pace = Pace::new(device.most_bytes(), bytes, groups, WORKGROUP);
                new.insert((pipeline, pace))
            }
        };
        let most = conditions.len().min(from + pace.cells);
        let count = fitting(method, &conditions[from..most], MANY_STEPS * pace.cells);
        let of = from..from + count;
        let conditions = &conditions[of.clone()];
        let (mut rods, mut rod_of) = (Vec::new(), Vec::with_capacity(conditions.len()));
        for of_rod in conditions.chunk_by(is_same_rod) {
            // A submission has fewer rods than `u32` can count.
            rod_of.extend(std::iter::repeat_n(rods.len() as u32, of_rod.len()));
            rods.push(GpuRod::<T>::new(of_rod[0].rod, method));
        }
        let point = |condition: &InitialCondition| [condition.tau, condition.load].map(T::of);
        let points: Vec<[T; 2]> = conditions.iter().map(point).collect();
        let inputs: [&[u8]; 3] = [
            bytemuck::cast_slice(&rods),
            bytemuck::cast_slice(&rod_of),
            bytemuck::cast_slice(&points),
        ];
        let mut buffers = self.shoot_buffers.pop().unwrap_or_default();
        let submitted = Instant::now();
        let sizes = [conditions.len(), size_of::<GpuState<T>>()];
        let index = buffers.submit(device, pipeline, &inputs, "states", sizes)?;
        Ok(Volley { of, submitted, index, buffers })
    }
}

/// Returns true if two trajectories are of one rod.
fn is_same_rod(a: &InitialCondition, b: &InitialCondition) -> bool {
    std::ptr::eq(a.rod, b.rod)
}

/// Returns how many of the first `conditions` surely take at most this number of `steps` together: one at least.
fn fitting(method: Method, conditions: &[InitialCondition], steps: usize) -> usize {
    let (mut count, mut left) = (0, steps);
    for of_rod in conditions.chunk_by(is_same_rod) {
        // The number of steps grows with contact and load.
        let largest = of_rod.iter().fold([0.0; 2], |[tau, load]: [f64; 2], other| {
            [tau.max(other.tau), load.max(other.load.abs())]
        });
        let [tau, load] = largest;
        let each = method.resolution.steps(of_rod[0].rod, tau, load).max(1) as usize;
        let fits = of_rod.len().min(left / each);
        (count, left) = (count + fits, left - fits * each);
        if fits < of_rod.len() {
            break;
        }
    }
    count.max(1)
}

/// Returns true on a thread of a pool. Others, such as an engine's thread, work alone.
fn is_in_pool() -> bool {
    rayon::current_thread_index().is_some()
}

/// Writes the states whose `bytes` the shader wrote for some conditions.
fn read<T: Scalar>(bytes: &[u8], (conditions, states): (&[InitialCondition], &mut [PlainState])) {
    let size = size_of::<GpuState<T>>();
    let read = |states: &mut [PlainState], conditions: &[InitialCondition], bytes: &[u8]| {
        let found = bytes.chunks_exact(size).zip(conditions);
        for (state, (found, condition)) in states.iter_mut().zip(found) {
            let found: GpuState<T> = bytemuck::pod_read_unaligned(found);
            *state = state_of(condition.rod, found.map(Into::into));
        }
    };
    if !is_in_pool() {
        read(states, conditions, bytes);
        return;
    }
    let parts = states.par_chunks_mut(READ_AT_ONCE);
    let parts = parts.zip(conditions.par_chunks(READ_AT_ONCE));
    parts
        .zip(bytes.par_chunks(READ_AT_ONCE * size))
        .for_each(|((states, conditions), bytes)| read(states, conditions, bytes));
}

/// Returns the state of a trajectory of `rod` from the numbers that the shader `found`. The mount turns the base here; the shader has none.
fn state_of(rod: &Rod, found: GpuState<f64>) -> PlainState {
    let [cos, sin, x, y, energy, force] = found;
    let position = DVec2::new(x, y);
    let turn = rod.mount * force * x;
    let tangent = match turn {
        0.0 => DVec2::new(cos, sin),
        _ => DVec2::from_angle(turn).rotate(DVec2::new(cos, sin)),
    };
    let to_pole = rod.to_pole() - position;
    PlainState {
        pole: DVec2::new(tangent.x, -tangent.y).rotate(to_pole),
        tangent,
        position,
        force,
        energy: (0.5 * force * x).mul_add(turn, energy),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A list with extreme loads is sent in small parts, and never in none.
    #[test]
    fn a_submission_has_few_steps() {
        let rods = [Rod::default(), Rod::default()];
        let method = Method::fine();
        let at = |rod: usize, load| InitialCondition { rod: &rods[rod], tau: 0.5, load };
        let [few, many] =
            [1.0, 1e6].map(|load| method.resolution.steps(&rods[0], 0.5, load) as usize);
        assert!(many > 100 * few);
        let mild = [at(0, 1.0), at(0, -1.0), at(1, 1.0)];
        let mixed = [at(0, 1.0), at(0, 1.0), at(1, -1e6), at(1, 1e6)];
        let counts = |list: &[InitialCondition], steps| fitting(method, list, steps);
        assert_eq!(counts(&mild, 3 * few), 3);
        assert_eq!(counts(&mild, 3 * few - 1), 2);
        assert_eq!(counts(&mild, 0), 1);
        assert_eq!(counts(&mixed, many), 2);
        assert_eq!(counts(&mixed, 2 * few + many), 3);
        assert_eq!(counts(&mixed[2..], many - 1), 1);
    }
}
