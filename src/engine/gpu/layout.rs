//! Push angles and cells as bytes, as `shaders/nystrom8.wgsl` and `shaders/cells.wgsl` have them.

use super::Precision;
use super::base_point::{Packed, packed};
use super::bytes::{Scalar, bytes, halves};
use super::pending::BatchPart;
use crate::engine::{BasePoint, Cells, FORCE, Outcome, RowBatch};
use crate::plan::STATE_CHANNELS;
use crate::rod::{Rod, arclength};
use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use std::ops::Range;

/// What buffers hold, for shaders of one precision.
#[derive(Debug)]
pub struct BufferLayout {
    /// Bytes of a push angle.
    pub push: usize,
    /// Bytes of a cell.
    pub cell: usize,
    /// Push angles to bytes.
    pub pushes: fn(&[f64]) -> Vec<u8>,
    /// A part of a batch to bytes, with room for so many steps: [`packed`].
    pub packed: fn(&RowBatch, BatchPart, usize) -> Packed,
}

impl BufferLayout {
    /// The layout for shaders of this precision.
    pub const fn of(precision: Precision) -> Self {
        match precision {
            Precision::F32 => Self::with::<f32>(),
            Precision::F64 => Self::with::<f64>(),
        }
    }

    const fn with<T: Scalar>() -> Self {
        Self {
            push: size_of::<[T; 2]>(),
            cell: size_of::<GpuCell>(),
            pushes: |pushes| bytes(pushes.iter().map(|push| halves::<T>(*push))),
            packed: packed::<T>,
        }
    }
}

/// The codes that the shaders write, from 0. A kernel that writes nothing leaves zeros, which are no solution.
pub const OUTCOMES: [(&str, Outcome); 5] = [
    ("NOT_FINITE", Outcome::NotFinite),
    ("SOLVED", Outcome::Solved),
    ("NEAR_EDGE", Outcome::NearEdge),
    ("OUTSIDE_TRUST", Outcome::OutsideTrust),
    ("MISSED", Outcome::Missed),
];

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct GpuCell {
    /// Differences from the base point, in the order of [`STATE_CHANNELS`], in whisker lengths, radians and `E I_base/L_w^2`.
    numbers: [f32; STATE_CHANNELS.len()],
    residual: f32,
    outcome: u32,
    /// Shaders write four numbers at a time.
    unused: u32,
}

impl GpuCell {
    /// The outcome; a cell with a number that is not finite is no solution.
    fn outcome(&self) -> Outcome {
        let is_finite = self.numbers.iter().all(|x| x.is_finite()) && self.residual.is_finite();
        let coded = OUTCOMES.get(self.outcome as usize).filter(|_| is_finite);
        coded.map_or(Outcome::NotFinite, |&(_, outcome)| outcome)
    }

    /// `(tau, load)` on `rod`, beside the base point `base`.
    fn point(&self, rod: &Rod, base: &BasePoint) -> DVec2 {
        let [arc, _, force, ..] = self.numbers.map(f64::from);
        let tau = rod.tau(arclength(rod, base.tau) + arc);
        DVec2::new(
            tau,
            (base.state.full.force + force) / rod.radius(tau).powi(2),
        )
    }
}

/// Writes the cells of some base points of `batch`, which are in `bytes`, into `cells`.
pub fn read_cells(bytes: &[u8], batch: &RowBatch, base_points: Range<usize>, cells: &mut Cells) {
    let mut bytes = bytes;
    for index in base_points {
        let (base, trajectory) = (&batch.base_points[index], &batch.trajectories[index]);
        let (own, rest) = bytes.split_at(base.cells.len() * size_of::<GpuCell>());
        bytes = rest;
        let own: Vec<GpuCell> = bytemuck::pod_collect_to_vec(own);
        let into = trajectory.first_cell..trajectory.first_cell + own.len();
        for (outcome, cell) in cells.outcome[into.clone()].iter_mut().zip(&own) {
            *outcome = cell.outcome();
        }
        cells.steps[into.clone()].fill(1);
        for (residual, cell) in cells.residual[into.clone()].iter_mut().zip(&own) {
            *residual = cell.residual;
        }
        let unit_values = &batch.sides[base.rod as usize].unit_values;
        for (i, column) in cells.values.iter_mut().enumerate() {
            let Some(column) = column.get_mut(into.clone()) else {
                continue;
            };
            let (known, unit) = (trajectory.values[i], unit_values[i]);
            // The force at first touch is 0 but for rounding.
            let least = if i == FORCE { 0.0 } else { f64::NEG_INFINITY };
            for (value, cell) in column.iter_mut().zip(&own) {
                *value = (known + unit * f64::from(cell.numbers[i])).max(least) as f32;
            }
        }
        if let Some(points) = cells.points.get_mut(into) {
            let rod = batch.rod(base);
            for (point, cell) in points.iter_mut().zip(&own) {
                *point = cell.point(rod, base);
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::engine::gpu::base_point::GpuStart;
    use crate::engine::gpu::shaders;
    use naga::TypeInner;
    use std::mem::offset_of;

    /// Name, size and members, in the eyes of the shader and of Rust.
    type Struct = (String, usize, Vec<(String, usize)>);

    fn in_shader(precision: Precision) -> Vec<Struct> {
        let module = naga::front::wgsl::parse_str(&shaders::cells(precision)).unwrap();
        let structs = module.types.iter().filter_map(|(_, found)| {
            let TypeInner::Struct { members, span } = &found.inner else {
                return None;
            };
            let members = members.iter();
            let members = members.map(|m| (m.name.clone().unwrap(), m.offset as usize));
            Some((found.name.clone()?, *span as usize, members.collect()))
        });
        structs.collect()
    }

    macro_rules! in_rust {
        ($type:ty, $name:literal, $($member:ident)+) => {
            (
                $name.to_owned(),
                size_of::<$type>(),
                vec![$((stringify!($member).to_owned(), offset_of!($type, $member))),+],
            )
        };
    }

    fn agrees<T: Scalar>(precision: Precision) {
        let shader = in_shader(precision);
        let rust = in_rust!(GpuStart<T>, "StepStart", place tangents);
        assert_eq!(shader.iter().find(|s| s.0 == rust.0), Some(&rust));
        // Of the last numbers that the shader writes one is none.
        let numbers = shader.iter().find(|s| s.0 == "Cell").unwrap().1;
        assert_eq!(numbers + size_of::<u32>(), size_of::<GpuCell>());
        assert_eq!(offset_of!(GpuCell, unused), numbers);
    }

    #[test]
    fn shaders_and_rust_agree_on_every_offset() {
        agrees::<f32>(Precision::F32);
        agrees::<f64>(Precision::F64);
    }

    #[test]
    fn a_cell_that_is_not_finite_or_not_written_is_no_solution() {
        for (first, code, outcome) in [
            (1.0, 1, Outcome::Solved),
            (f32::NAN, 1, Outcome::NotFinite),
            (1.0, 9, Outcome::NotFinite),
            (0.0, 0, Outcome::NotFinite),
        ] {
            let cell = GpuCell {
                numbers: [first; STATE_CHANNELS.len()],
                residual: 0.0,
                outcome: code,
                unused: 0,
            };
            assert_eq!(cell.outcome(), outcome);
        }
    }
}
