//! Parts of row batches as bytes for the shaders: push angles, base points, and the steps of their trajectories.

use super::Precision;
use super::base_point::{GpuBasePoint, GpuStart, Scalar, halves};
use super::pending::BatchPart;
use crate::engine::RowBatch;
use std::ops::Range;

/// Number of shader invocations per workgroup; every device allows this many.
pub const WORKGROUP: u32 = 32;

/// Alignment of a buffer range in groups: every device takes multiples of 256 bytes.
const ALIGNED: usize = 256 / size_of::<[u32; 4]>();

/// Packs signed push angles, in radians, as bytes for the shaders. Each is two numbers of `precision`, `[high, low]` of [`halves`], which
/// together hold the angle.
pub fn pushes(precision: Precision, pushes: &[f64]) -> Vec<u8> {
    fn bytes<T: Scalar>(pushes: &[f64]) -> Vec<u8> {
        let pushes: Vec<[T; 2]> = pushes.iter().map(|push| halves(*push)).collect();
        bytemuck::cast_slice(&pushes).to_vec()
    }
    match precision {
        Precision::F32 => bytes::<f32>(pushes),
        Precision::F64 => bytes::<f64>(pushes),
    }
}

/// Base points of a batch as bytes, in dispatches.
#[derive(Debug, Default)]
pub struct Packed {
    /// Number of packed cells.
    pub cells: usize,
    /// Index after the last packed base point in the batch.
    pub base_points_end: usize,
    /// Groups of cells of one base point, `[group]`; those of a dispatch begin at a multiple of [`ALIGNED`].
    pub groups: Vec<[u32; 4]>,
    /// Ranges of [`Packed::groups`]: one for each dispatch.
    pub dispatches: Vec<Range<usize>>,
    /// Bytes of the base points ([`GpuBasePoint`]), one after the other.
    pub base_points: Vec<u8>,
    /// Bytes of the starts of the steps ([`GpuStart`]) of the base points' trajectories, with equal room in each dispatch.
    pub starts: Vec<u8>,
}

impl Packed {
    /// Packs a `part` of a batch for shaders of this precision.
    pub fn new(precision: Precision, batch: &RowBatch, part: BatchPart) -> Self {
        let most_steps = precision.most_steps();
        match precision {
            Precision::F32 => packed::<f32>(batch, part, most_steps),
            Precision::F64 => packed::<f64>(batch, part, most_steps),
        }
    }

    /// Ends the dispatch whose groups begin with `first_group`, with `room` bytes for its steps.
    fn close(&mut self, first_group: usize, room: usize) {
        self.dispatches.push(first_group..self.groups.len());
        self.starts.resize(self.dispatches.len() * room, 0);
        let aligned = self.groups.len().next_multiple_of(ALIGNED);
        self.groups.resize(aligned, [0; 4]);
    }
}

/// Packs a `part` of a batch into dispatches with room for `most_steps` each.
fn packed<T: Scalar>(batch: &RowBatch, part: BatchPart, most_steps: usize) -> Packed {
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
        let base = &batch.base_points[at];
        let steps = base.trajectory.steps as usize;
        if steps_here + steps > most_steps {
            packed.close(first_group, room);
            (first_group, steps_here) = (packed.groups.len(), 0);
        }
        // A dispatch has fewer steps, and a batch fewer cells, than `u32` can count.
        let one = GpuBasePoint::<T>::new(batch.rod(base), base, steps_here as u32);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::gpu::pending::PendingBatch;
    use crate::engine::{BasePoint, BaseTrajectory};
    use crate::engine::{SideColumns, WhiskerSide};
    use crate::rod::{Rod, Side, Units};
    use crate::sheet::Sheet;
    use crate::shooting::FirstVariation;
    use crate::shooting::batch::{Method, StepStart};
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
            strain: 1.0,
        };
        let sides = [WhiskerSide::new(columns, units, sheet)];
        let base = |&(steps, cells): &(u32, u32)| BasePoint {
            rod: 0,
            tau: 0.5,
            load: 1.0,
            push: 0.1,
            state: FirstVariation::default(),
            load_per_w: 1.0,
            row: Default::default(),
            cells: 0..cells,
            trajectory: BaseTrajectory {
                steps,
                ..BaseTrajectory::default()
            },
        };
        let count = all.iter().map(|(steps, _)| *steps as usize).sum();
        let start = |radius| StepStart {
            radius: radius as f64,
            ..StepStart::default()
        };
        RowBatch {
            base_points: all.iter().map(base).collect(),
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
