//! Cells as the shaders write them: differences from their base points.

use crate::engine::{BasePoint, Cell, Cells, FORCE, Outcome, RowBatch};
use crate::plan::STATE_CHANNELS;
use crate::rod::{Rod, arclength};
use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use std::ops::Range;

/// Size in bytes of a cell as the shaders write it.
pub const CELL_BYTES: usize = size_of::<GpuCell>();

/// Outcomes by the codes that the shaders write, from 0, `[code]`. A kernel that writes nothing leaves zeros, which are no solution.
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
        let force = base.state.full.force + force;
        DVec2::new(tau, force / rod.radius(tau).powi(2))
    }
}

/// Writes the cells of some base points of `batch`, which are in `bytes`, into `cells`.
pub fn read_cells(bytes: &[u8], batch: &RowBatch, base_points: Range<usize>, cells: &mut Cells) {
    let bytes = bytes.chunks_exact(CELL_BYTES);
    let mut read = bytes.map(bytemuck::pod_read_unaligned::<GpuCell>);
    for index in base_points {
        let base = &batch.base_points[index];
        let unit_values = &batch.sides[base.rod as usize].unit_values;
        let first = base.trajectory.first_cell;
        for (index, cell) in (first..first + base.cells.len()).zip(&mut read) {
            let mut values = base.trajectory.values;
            for ((value, unit), number) in values.iter_mut().zip(unit_values).zip(cell.numbers) {
                *value += unit * f64::from(number);
            }
            // The force at first touch is 0 up to rounding.
            values[FORCE] = values[FORCE].max(0.0);
            let point = match batch.has_points {
                true => cell.point(batch.rod(base), base),
                false => DVec2::NAN,
            };
            let cell = Cell {
                outcome: cell.outcome(),
                steps: 1,
                residual: cell.residual,
                values: values.map(|value| value as f32),
                point,
            };
            cells.set(index, &cell);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::engine::gpu::Precision;
    use crate::engine::gpu::base_point::{GpuStart, Scalar};
    use crate::engine::gpu::shaders;
    use naga::TypeInner;
    use std::mem::offset_of;

    /// Name, size, and members with their offsets.
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

    fn agrees<T: Scalar>(precision: Precision) {
        let shader = in_shader(precision);
        let members = [
            ("place", offset_of!(GpuStart<T>, place)),
            ("tangents", offset_of!(GpuStart<T>, tangents)),
        ];
        let members = members.map(|(name, offset)| (name.to_owned(), offset));
        let start = (
            "StepStart".to_owned(),
            size_of::<GpuStart<T>>(),
            members.into(),
        );
        assert_eq!(shader.iter().find(|s| s.0 == start.0), Some(&start));
        // The shader writes one number more, which is unused.
        let numbers = shader.iter().find(|s| s.0 == "Cell").unwrap().1;
        assert_eq!(numbers + size_of::<u32>(), CELL_BYTES);
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
