//! References as bytes, with the steps of their trajectories: structs of `shaders/nystrom8.wgsl` and `shaders/cells.wgsl`.

use super::Precision;
use super::bytes::{Scalar, halves};
use super::pending::BatchPart;
use crate::engine::{BasePoint, BaseTrajectory, MOST_TRAJECTORY_STEPS, POWERS, RowBatch};
use crate::rod::{Rest, Rod, arclength};
use crate::shooting::StateDerivative;
use crate::shooting::batch::StepStart;
use bytemuck::{Pod, Zeroable};
use std::mem::offset_of;
use std::ops::Range;

/// Invocations per workgroup; every device allows this many.
pub const WORKGROUP: u32 = 32;

/// Powers of a row's polynomials in the shaders, from the first on, in whole quads.
const ROW_POWERS: usize = POWERS.next_multiple_of(4);

/// Powers of the Jacobian's polynomials there: Newton's last step needs five digits.
const JACOBIAN_POWERS: usize = 8;

const _: () = assert!(
    MOST_TRAJECTORY_STEPS as usize <= Precision::F64.most_steps(),
    "a dispatch has room for every trajectory"
);

const _: () = assert!(
    POWERS == 12 && JACOBIAN_POWERS == 8,
    "shaders/cells.wgsl writes them out"
);

/// Base points of a batch as bytes, in dispatches.
#[derive(Debug, Default)]
pub struct Packed {
    /// Number of cells.
    pub cells: usize,
    /// End of the base points in the batch.
    pub base_points_end: usize,
    /// Groups of cells of one base point; those of a dispatch begin at a multiple of [`ALIGNED`].
    pub groups: Vec<[u32; 4]>,
    /// Groups of each dispatch.
    pub dispatches: Vec<Range<usize>>,
    /// The base points.
    pub base_points: Vec<u8>,
    /// Starts of the steps of their trajectories, with equal room in each dispatch.
    pub starts: Vec<u8>,
}

/// Alignment of a buffer range in groups: every device takes multiples of 256 bytes.
const ALIGNED: usize = 256 / size_of::<[u32; 4]>();

/// Packs a `part` of a batch into dispatches with room for `most_steps` each.
pub fn packed<T: Scalar>(batch: &RowBatch, part: BatchPart, most_steps: usize) -> Packed {
    let room = most_steps * size_of::<GpuStart<T>>();
    let mut packed = Packed {
        base_points_end: part.base_points.end,
        ..Packed::default()
    };
    let count = part.base_points.len();
    packed
        .base_points
        .reserve(count * size_of::<GpuBasePoint<T>>());
    let mut starts = batch.starts[part.starts].iter();
    let (mut first_group, mut steps_here) = (0, 0);
    for (index, at) in (0..).zip(part.base_points) {
        let (base, trajectory) = (&batch.base_points[at], &batch.trajectories[at]);
        let steps = trajectory.steps as usize;
        if steps_here + steps > most_steps {
            packed.close(first_group, room);
            (first_group, steps_here) = (packed.groups.len(), 0);
        }
        // A dispatch has fewer steps, and a batch fewer cells, than `u32` can count.
        let one = GpuBasePoint::<T>::new(batch.rod(base), base, steps_here as u32, trajectory);
        packed
            .base_points
            .extend_from_slice(bytemuck::bytes_of(&one));
        for start in starts.by_ref().take(steps) {
            let start = GpuStart::<T>::from(start);
            packed.starts.extend_from_slice(bytemuck::bytes_of(&start));
        }
        for push in base.cells.clone().step_by(WORKGROUP as usize) {
            let cells = WORKGROUP.min(base.cells.end - push);
            packed
                .groups
                .push([index, push, packed.cells as u32, cells]);
            packed.cells += cells as usize;
        }
        steps_here += steps;
    }
    packed.close(first_group, room);
    packed
}

impl Packed {
    /// Closes the dispatch whose groups begin with `first_group`, with room for its steps in so many bytes.
    fn close(&mut self, first_group: usize, room: usize) {
        self.dispatches.push(first_group..self.groups.len());
        self.starts.resize(self.dispatches.len() * room, 0);
        let aligned = self.groups.len().next_multiple_of(ALIGNED);
        self.groups.resize(aligned, [0; 4]);
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
pub struct GpuStart<T> {
    pub place: [T; 4],
    pub tangents: [T; 4],
}

impl<T: Scalar> From<&StepStart> for GpuStart<T> {
    fn from(start: &StepStart) -> Self {
        let StepStart { tangent, rest, .. } = start;
        Self {
            place: [start.radius, start.arclength, start.bent, start.across].map(T::of),
            tangents: [tangent.x, tangent.y, rest.x, rest.y].map(T::of),
        }
    }
}

/// Quads of numbers, in the order in which shaders read them.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
pub struct GpuBasePoint<T> {
    /// `tau`, load, radius, arclength.
    contact: [T; 4],
    /// Taper, bend, and an Euler spiral's numbers.
    rod: [T; 4],
    /// The pole's centre from the base, and the base from the contact.
    places: [T; 4],
    /// The tangent, how far bending has turned it, and twice the energy over the force.
    base: [T; 4],
    /// cos and sin of the contact's tangent at rest, from the contact to the tip in `tau`, and the load over the way along the row, which
    /// goes with `load tau^2`.
    rest: [T; 4],
    /// d(theta, X, Y) at the base, and of the energy, by `tau`.
    by_tau: [T; 4],
    /// d(theta, X, Y) at the base, and of the energy, by load.
    by_load: [T; 4],
    /// The push angle, what is left of it, the steps, and the first of them.
    push: [T; 4],
    /// Taylor's polynomials of the row by the way from here: push angle, `tau`, and direction of the point at rest as far from the base, less
    /// their own.
    push_by_way: [T; ROW_POWERS],
    tau_by_way: [T; ROW_POWERS],
    resting_by_way: [T; ROW_POWERS],
    /// d(ln D, phi) by `tau` and by load, four numbers for each power.
    jacobian: [[T; 4]; JACOBIAN_POWERS],
}

/// Where the shaders find what they read of a reference, in quads, and how many quads it has.
pub const PLACES: [(&str, usize); 13] = {
    macro_rules! places {
        ($($name:literal $member:ident)+) => {
            [
                $(($name, offset_of!(GpuBasePoint<f32>, $member) / size_of::<[f32; 4]>()),)+
                ("REFERENCE_QUADS", size_of::<GpuBasePoint<f32>>() / size_of::<[f32; 4]>()),
            ]
        };
    }
    places!(
        "CONTACT" contact "ROD" rod "PLACES" places "BASE" base "REST" rest "BY_TAU" by_tau "BY_LOAD" by_load "PUSH" push
        "PUSH_BY_WAY" push_by_way "TAU_BY_WAY" tau_by_way "RESTING_BY_WAY" resting_by_way "JACOBIAN" jacobian
    )
};

impl<T: Scalar> GpuBasePoint<T> {
    fn new(rod: &Rod, base: &BasePoint, first_step: u32, trajectory: &BaseTrajectory) -> Self {
        let BasePoint {
            tau, load, state, ..
        } = base;
        let s = arclength(rod, *tau);
        let full = &state.full;
        let numbers =
            |by: &StateDerivative| [by.angle, by.position.x, by.position.y, by.energy].map(T::of);
        let powers = |i: usize| {
            std::array::from_fn(|power| {
                let term = base.row.get(power + 1);
                term.map_or(T::of(0.0), |term| T::of(term[i]))
            })
        };
        let to_pole = rod.to_pole() - full.position;
        let energy = match full.force {
            0.0 => 0.0,
            force => 2.0 * full.energy / force,
        };
        let rest = Rest::parabola_tangent(rod, s);
        let [k0, k1] = rod.spiral.unwrap_or_default();
        let [high, low] = halves(base.push);
        let steps = [trajectory.steps, first_step].map(|count| T::of(count.into()));
        Self {
            contact: [*tau, *load, rod.radius(*tau), s].map(T::of),
            rod: [rod.taper, rod.bend, k0, k1].map(T::of),
            places: [to_pole.x, to_pole.y, full.position.x, full.position.y].map(T::of),
            base: [full.tangent.x, full.tangent.y, trajectory.bent, energy].map(T::of),
            rest: [rest.x, rest.y, rod.tau_tip() - tau, base.per_way].map(T::of),
            by_tau: numbers(&state.by_tau),
            by_load: numbers(&state.by_load),
            push: [high, low, steps[0], steps[1]],
            push_by_way: powers(0),
            tau_by_way: powers(1),
            resting_by_way: powers(2),
            jacobian: std::array::from_fn(|power| {
                std::array::from_fn(|i| T::of(base.row[power][3 + i]))
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::gpu::pending::PendingBatch;
    use crate::engine::{SideColumns, WhiskerSide};
    use crate::rod::{Side, Units};
    use crate::sheet::Sheet;
    use crate::shooting::FirstVariation;
    use crate::shooting::batch::Method;
    use std::sync::Arc;

    /// Base points with so many steps and cells.
    fn batch(all: &[(u32, u32)]) -> RowBatch {
        let (method, rod) = (Method::fine(), Rod::default());
        let sheet = Sheet::new(method, &rod, Side::Cb, &[0.5]);
        let columns = Arc::new(SideColumns::new(&[], Side::Cb, 0));
        let units = Units {
            length_mm: 1.0,
            force_un: 1.0,
            moment_nnm: 1.0,
        };
        let sides = [WhiskerSide::new(columns, units, sheet)];
        let base = |&(_, cells): &(u32, u32)| BasePoint {
            rod: 0,
            tau: 0.5,
            load: 1.0,
            push: 0.1,
            state: FirstVariation::default(),
            per_way: 1.0,
            row: Default::default(),
            cells: 0..cells,
        };
        let trajectory = |&(steps, _): &(u32, u32)| BaseTrajectory {
            steps,
            ..BaseTrajectory::default()
        };
        let count = all.iter().map(|(steps, _)| *steps as usize).sum();
        let start = |radius| StepStart {
            radius: radius as f64,
            ..StepStart::default()
        };
        RowBatch {
            base_points: all.iter().map(base).collect(),
            trajectories: all.iter().map(trajectory).collect(),
            starts: (0..count).map(start).collect(),
            ..RowBatch::new(method, sides.into(), [].into(), [])
        }
    }

    /// Every cell is in one group, every step is where its dispatch looks for it, and dispatches begin where devices can.
    #[test]
    fn parts_of_a_batch_are_packed_without_loss() {
        let all: Vec<(u32, u32)> = (0..100).map(|i| (1 + i % 7, 1 + i * 13 % 90)).collect();
        let batch = Arc::new(batch(&all));
        let cells: u32 = all.iter().map(|(_, cells)| cells).sum();
        for (most_cells, most_steps) in [(1, 8), (500, 16), (usize::MAX, 64), (usize::MAX, 4096)] {
            let mut pending = PendingBatch::new(Arc::clone(&batch));
            let (mut written, mut starts, mut first) = (0, Vec::new(), 0);
            while pending.is_waiting() {
                let part = pending.next(most_cells, 5 * most_steps);
                let packed = packed::<f32>(&batch, part.clone(), most_steps);
                let room = most_steps * size_of::<GpuStart<f32>>();
                assert_eq!(packed.starts.len(), packed.dispatches.len() * room);
                let mut next = 0;
                for (number, groups) in packed.dispatches.iter().enumerate() {
                    assert!(!groups.is_empty() && groups.start % ALIGNED == 0);
                    let steps = &packed.starts[number * room..(number + 1) * room];
                    let steps: &[GpuStart<f32>] = bytemuck::cast_slice(steps);
                    let mut before = None;
                    for &[index, _, cell, count] in &packed.groups[groups.clone()] {
                        assert_eq!(cell, next);
                        next += count;
                        if before.replace(index) != Some(index) {
                            let size = size_of::<GpuBasePoint<f32>>();
                            let base = &packed.base_points[index as usize * size..][..size];
                            let base: GpuBasePoint<f32> = bytemuck::pod_read_unaligned(base);
                            let [_, _, count, from] = base.push;
                            let own = &steps[from as usize..][..count as usize];
                            starts.extend(own.iter().map(|start| start.place[0]));
                        }
                    }
                }
                assert_eq!(packed.cells, next as usize);
                assert_eq!(part.base_points.start, first);
                first = part.base_points.end;
                assert_eq!(packed.base_points_end, first);
                written += next;
            }
            assert_eq!(written, cells);
            let wanted = batch.starts.iter().map(|start| start.radius as f32);
            assert!(starts.into_iter().eq(wanted));
        }
    }
}
