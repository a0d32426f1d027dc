//! Trajectories on the device: any list of rods, contacts and loads, thousands at once.

use super::packing::Scalar;
use super::{EngineError, Gpu, Precision, shaders};
use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::hash_map::Entry;
use std::ops::Range;
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
    gradient: T,
    unused: T,
}

impl<T: Scalar> GpuRod<T> {
    fn new(rod: &Rod) -> Self {
        let mut curvature = [T::of(0.0); 8];
        let polynomial = rod
            .polynomial
            .iter()
            .flat_map(|polynomial| polynomial.centred());
        for (coefficient, term) in curvature.iter_mut().zip(polynomial) {
            *coefficient = T::of(*term);
        }
        Self {
            taper: T::of(rod.taper),
            twice_bend: T::of(2.0 * rod.bend),
            spiral: rod.spiral.unwrap_or_default().map(T::of),
            curvature,
            tangent: rod.contact_tangent().to_array().map(T::of),
            gradient: T::of(rod.gradient),
            unused: T::of(0.0),
        }
    }
}

/// Contact in the layout of the shaders: `tau`, radius, arclength, an unused number, and the unit tangent of a parabola at rest.
type GpuContact<T> = [T; 6];

/// State in the layout of the shaders: tangent, position, energy, rotation by bending.
type GpuState<T> = [T; 6];

/// Neighbouring trajectories of a list from one contact of one rod. They take the same number of steps.
struct Fan {
    /// Indices of the trajectories in the list.
    of: Range<usize>,
    effects: Effects,
    steps: u32,
}

impl Fan {
    /// Returns the fans of `conditions`, in order.
    fn all(method: Method, conditions: &[InitialCondition]) -> Vec<Self> {
        let mut end = 0;
        let fans: Vec<Range<usize>> = conditions
            .chunk_by(|a, b| std::ptr::eq(a.rod, b.rod) && a.tau == b.tau)
            .map(|fan| {
                end += fan.len();
                end - fan.len()..end
            })
            .collect();
        results(fans.len(), |index| {
            let of = fans[index].clone();
            let fan = &conditions[of.clone()];
            let (rod, tau) = (fan[0].rod, fan[0].tau);
            // The number of steps grows with the load.
            let load = fan
                .iter()
                .fold(0.0, |most: f64, condition| most.max(condition.load.abs()));
            Self {
                of,
                effects: method.effects.and(rod),
                steps: method.resolution.steps(rod, tau, load),
            }
        })
        .into_iter()
        .flat_map(Self::parts)
        .collect()
    }

    /// Divides this fan into fans of at most [`MOST_STEPS`].
    fn parts(self) -> impl Iterator<Item = Self> {
        // A trajectory has far fewer steps than a submission.
        let most = (MOST_STEPS / u64::from(self.steps.max(1))).max(1) as usize;
        let Self { of, effects, steps } = self;
        of.clone().step_by(most).map(move |from| Self {
            of: from..of.end.min(from + most),
            effects,
            steps,
        })
    }
}

/// Returns the results of `work` for `count` indices, on all threads of the pool of this thread. A thread of no pool, such as an engine's thread,
/// works alone.
fn results<O: Send>(count: usize, work: impl Fn(usize) -> O + Send + Sync) -> Vec<O> {
    match rayon::current_thread_index() {
        Some(_) => (0..count).into_par_iter().map(work).collect(),
        None => (0..count).map(work).collect(),
    }
}

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

impl Gpu {
    /// Integrates trajectories on the device, in the engine's precision, and returns their states: `[trajectory]`. The effects are those of the
    /// rods and of the method. Neighbours of one rod and one contact are sent and stepped together.
    ///
    /// # Errors
    /// [`EngineError::Unsupported`] if a rod has effects that the shader lacks ([`shoots`]); [`EngineError::Device`] when the device fails.
    pub fn shoot(
        &mut self,
        method: Method,
        conditions: &[InitialCondition],
    ) -> Result<Vec<PlainState>, EngineError> {
        let mut fans = Fan::all(method, conditions);
        for fan in &fans {
            shoots(fan.effects).map_err(|why| EngineError::Unsupported {
                adapter: self.device.info.name.clone(),
                what: format!("shoot: {why}"),
            })?;
        }
        // Neighbours share a kernel, and take equal numbers of steps.
        fans.sort_by_key(|fan| (fan.effects, fan.steps));
        let mut states = vec![PlainState::default(); conditions.len()];
        self.working(|gpu| {
            for group in fans.chunk_by(|a, b| a.effects == b.effects) {
                for part in submissions(group) {
                    let part = (conditions, &group[part]);
                    match gpu.precision {
                        Precision::F32 => gpu.shoot_in::<f32>(part, &mut states)?,
                        Precision::F64 => gpu.shoot_in::<f64>(part, &mut states)?,
                    }
                }
            }
            Ok(states)
        })
    }

    /// Integrates some fans of the `conditions` with equal effects in one submission.
    fn shoot_in<T: Scalar>(
        &mut self,
        (conditions, fans): (&[InitialCondition], &[Fan]),
        states: &mut [PlainState],
    ) -> Result<(), EngineError> {
        let pipeline = match self.shooters.entry(fans[0].effects) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let text = shaders::shoot(self.precision);
                let constants = shaders::effects(fans[0].effects);
                new.insert(self.device.pipeline("shoot", &text, &constants)?)
            }
        };
        let contacts = results(fans.len(), |fan| {
            let InitialCondition { rod, tau, .. } = conditions[fans[fan].of.start];
            let (radius, s) = (rod.radius(tau), arclength(rod, tau));
            let rest = Rest::parabola_tangent(rod, s);
            [tau, radius, s, 0.0, rest.x, rest.y]
        });
        let (mut last, mut rods): (Option<&Rod>, Vec<GpuRod<T>>) = (None, Vec::new());
        let mut heads = Vec::with_capacity(fans.len());
        let count = fans.iter().map(|fan| fan.of.len()).sum();
        let mut contact_of: Vec<u32> = Vec::with_capacity(count);
        for (contact, fan) in (0..).zip(fans) {
            let rod = conditions[fan.of.start].rod;
            if !last.is_some_and(|last| std::ptr::eq(last, rod)) {
                rods.push(GpuRod::new(rod));
                last = Some(rod);
            }
            // A submission has fewer rods and contacts than `u32` can count.
            heads.push([rods.len() as u32 - 1, fan.steps]);
            contact_of.extend(std::iter::repeat_n(contact, fan.of.len()));
        }
        let shots = || {
            let fans = fans.iter().zip(&contacts);
            fans.flat_map(|(fan, contact): (&Fan, &[f64; 6])| {
                let square = contact[1] * contact[1];
                let force = move |index: usize| (index, conditions[index].load * square);
                fan.of.clone().map(force)
            })
        };
        let rounded: Vec<GpuContact<T>> =
            contacts.iter().map(|contact| contact.map(T::of)).collect();
        let mut forces: Vec<T> = Vec::with_capacity(count);
        forces.extend(shots().map(|(_, force)| T::of(force)));
        let inputs: [&[u8]; 5] = [
            bytemuck::cast_slice(&rods),
            bytemuck::cast_slice(&heads),
            bytemuck::cast_slice(&rounded),
            bytemuck::cast_slice(&contact_of),
            bytemuck::cast_slice(&forces),
        ];
        let size = size_of::<GpuState<T>>();
        let read = |bytes: &[u8]| {
            for (found, (index, force)) in bytes.chunks_exact(size).zip(shots()) {
                let found: GpuState<T> = bytemuck::pod_read_unaligned(found);
                states[index] = state(conditions[index].rod, force, found.map(Into::into));
            }
        };
        let (device, buffers) = (&self.device, &mut self.shoot_buffers);
        let index = buffers.submit(device, pipeline, &inputs, "states", [count, size])?;
        device.wait(index)?;
        buffers.read(read)
    }
}

/// Returns the state of a trajectory of `rod` under a signed `force` from the numbers that the shader `found`. The mount turns the base here; the
/// shader has none.
fn state(rod: &Rod, force: f64, found: GpuState<f64>) -> PlainState {
    let [cos, sin, x, y, energy, _] = found;
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

/// Splits fans of at most [`MOST_STEPS`] into submissions of as many: ranges of their indices.
fn submissions(fans: &[Fan]) -> Vec<Range<usize>> {
    let (mut parts, mut from, mut sum) = (Vec::new(), 0, 0);
    for (index, fan) in fans.iter().enumerate() {
        let steps = u64::from(fan.steps) * fan.of.len() as u64;
        sum += steps;
        if sum > MOST_STEPS && index > from {
            parts.push(from..index);
            (from, sum) = (index, steps);
        }
    }
    if from < fans.len() {
        parts.push(from..fans.len());
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_submission_has_few_steps() {
        let most = MOST_STEPS as u32;
        let parts = |steps: &[u32]| {
            let fans = steps.iter().map(|steps| fan(1, *steps));
            submissions(&fans.collect::<Vec<_>>())
        };
        assert!(parts(&[]).is_empty());
        assert_eq!(parts(&[1, most]), [0..1, 1..2]);
        let parts = parts(&[most - 1, 1, 1, most, most + 9, 5, most - 5, 1]);
        assert_eq!(parts, [0..2, 2..3, 3..4, 4..5, 5..7, 7..8]);
    }

    #[test]
    fn large_fans_are_divided() {
        let ranges = |count, steps| fan(count, steps).parts().map(|part| part.of).collect();
        let most = MOST_STEPS as usize / 16;
        let parts: Vec<Range<usize>> = ranges(2 * most + 1, 16);
        assert_eq!(parts, [0..most, most..2 * most, 2 * most..2 * most + 1]);
        let whole: Vec<Range<usize>> = ranges(most, 16);
        assert_eq!((whole.len(), whole[0].clone()), (1, 0..most));
    }

    fn fan(count: usize, steps: u32) -> Fan {
        Fan {
            of: 0..count,
            effects: Effects::default(),
            steps,
        }
    }

    /// Fans of neighbours take the steps of the largest load.
    #[test]
    fn neighbours_at_one_contact_are_a_fan() {
        let rods = [Rod::default(), Rod::default()];
        let at = |rod: usize, tau, load| InitialCondition {
            rod: &rods[rod],
            tau,
            load,
        };
        let list = [
            at(0, 0.5, 1.0),
            at(0, 0.5, -8.0),
            at(0, 0.6, 1.0),
            at(1, 0.6, 1.0),
            at(0, 0.5, 1.0),
        ];
        let method = Method::fine();
        let fans = Fan::all(method, &list);
        let ranges: Vec<Range<usize>> = fans.iter().map(|fan| fan.of.clone()).collect();
        assert_eq!(ranges, [0..2, 2..3, 3..4, 4..5]);
        let steps = |load| method.resolution.steps(&rods[0], 0.5, load);
        assert_eq!((fans[0].steps, fans[3].steps), (steps(8.0), steps(1.0)));
        assert!(steps(8.0) > steps(1.0));
    }
}
