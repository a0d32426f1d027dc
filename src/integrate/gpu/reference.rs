//! References as bytes, with the steps of their trajectories: structs of `shaders/nystrom8.wgsl` and `shaders/cells.wgsl`.

use super::bytes::{Scalar, bytes, halves, pair};
use crate::integrate::{POWERS, Reference};
use crate::rod::{Rest, Rod, arclength};
use crate::shooting::{REST_TERMS, Resolution, StateDerivative, StepStart, step_starts};
use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;

/// Terms of a row's polynomials in the shaders: without a constant, which the reference has itself.
pub const ROW_POWERS: usize = POWERS - 1;

/// Terms of the Jacobian's polynomials there: Newton's last step needs five digits.
pub const JACOBIAN_TERMS: usize = 4 * 8;

/// References, ready for a dispatch.
#[derive(Debug)]
pub struct Packed {
    /// Cells of all of them.
    pub cells: usize,
    /// The references.
    pub references: Vec<u8>,
    /// The steps of their trajectories.
    pub starts: Vec<u8>,
}

/// The trajectory of a reference.
struct Trip {
    steps: u32,
    /// How far bending has turned the base.
    bent: f64,
}

/// The references of one thread at a time.
const TOGETHER: usize = 64;

/// The `references` on `rods`, in steps of this `resolution`.
pub fn packed<T: Scalar>(rods: &[Rod], resolution: Resolution, references: &[Reference]) -> Packed {
    let parts = references.par_chunks(TOGETHER).map(|references| {
        let mut starts = Vec::new();
        let trips = references.iter().map(|reference| {
            let rod = &rods[reference.rod as usize];
            let Reference { tau, load, .. } = *reference;
            let steps = resolution.steps(rod, tau, load);
            let bent = step_starts(rod, tau, load, steps, &mut starts);
            Trip { steps, bent }
        });
        let trips: Vec<Trip> = trips.collect();
        (trips, bytes(starts.iter().map(GpuStart::<T>::from)))
    });
    let parts: Vec<(Vec<Trip>, Vec<u8>)> = parts.collect();
    let mut packed = Packed {
        cells: 0,
        references: Vec::with_capacity(references.len() * size_of::<GpuReference<T>>()),
        starts: Vec::with_capacity(parts.iter().map(|(_, starts)| starts.len()).sum()),
    };
    let mut first_step = 0;
    let trips = parts.iter().flat_map(|(trips, _)| trips);
    for (reference, trip) in references.iter().zip(trips) {
        let rod = &rods[reference.rod as usize];
        let packed_one = GpuReference::<T>::new(rod, reference, packed.cells, first_step, trip);
        let bytes = bytemuck::bytes_of(&packed_one);
        packed.references.extend_from_slice(bytes);
        packed.cells += reference.cells.len();
        first_step += trip.steps;
    }
    for (_, starts) in &parts {
        packed.starts.extend_from_slice(starts);
    }
    packed
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
pub struct GpuStart<T> {
    pub radius: T,
    pub arclength: T,
    pub tangent: [T; 2],
    pub position: [T; 2],
    pub bent: T,
    pub rest: [T; 2],
    pub rest_turn: [T; REST_TERMS],
}

impl<T: Scalar> From<&StepStart> for GpuStart<T> {
    fn from(start: &StepStart) -> Self {
        Self {
            radius: T::of(start.radius),
            arclength: T::of(start.arclength),
            tangent: pair(start.tangent),
            position: pair(start.position),
            bent: T::of(start.bent),
            rest: pair(start.rest),
            rest_turn: start.rest_turn.map(T::of),
        }
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
pub struct GpuReference<T> {
    pub tau: T,
    pub load: T,
    pub radius: T,
    pub arclength: T,
    pub rest: [T; 2],
    pub to_tip: T,
    pub to_pole: [T; 2],
    pub position: [T; 2],
    pub tangent: [T; 2],
    pub by_tau: [T; 4],
    pub by_load: [T; 4],
    pub bent: T,
    pub energy: T,
    pub push: [T; 2],
    pub per_way: T,
    pub push_by_way: [T; ROW_POWERS],
    pub tau_by_way: [T; ROW_POWERS],
    pub resting_by_way: [T; ROW_POWERS],
    pub jacobian: [T; JACOBIAN_TERMS],
    pub rod: u32,
    pub first_cell: u32,
    pub first_push: u32,
    pub steps: u32,
    pub first_step: u32,
    pub unused: u32,
}

impl<T: Scalar> GpuReference<T> {
    fn new(
        rod: &Rod,
        reference: &Reference,
        first_cell: usize,
        first_step: u32,
        trip: &Trip,
    ) -> Self {
        let Reference {
            tau,
            load,
            push,
            state,
            ..
        } = reference;
        let s = arclength(rod, *tau);
        let full = &state.full;
        let numbers =
            |by: &StateDerivative| [by.angle, by.position.x, by.position.y, by.energy].map(T::of);
        let along = |i: usize| std::array::from_fn(|power| T::of(reference.row[power + 1][i]));
        Self {
            tau: T::of(*tau),
            load: T::of(*load),
            radius: T::of(rod.radius(*tau)),
            arclength: T::of(s),
            rest: pair(Rest::parabola_tangent(rod, s)),
            to_tip: T::of(rod.tau_tip() - tau),
            to_pole: pair(rod.to_pole() - full.position),
            position: pair(full.position),
            tangent: pair(full.tangent),
            by_tau: numbers(&state.by_tau),
            by_load: numbers(&state.by_load),
            bent: T::of(trip.bent),
            energy: T::of(if full.force == 0.0 {
                0.0
            } else {
                2.0 * full.energy / full.force
            }),
            push: halves(*push),
            per_way: T::of(reference.per_way),
            push_by_way: along(0),
            tau_by_way: along(1),
            resting_by_way: along(2),
            jacobian: std::array::from_fn(|i| T::of(reference.row[i / 4][3 + i % 4])),
            rod: reference.rod,
            // A call has fewer cells than `u32` can count.
            first_cell: first_cell as u32,
            first_push: reference.cells.start,
            steps: trip.steps,
            first_step,
            unused: 0,
        }
    }
}
