//! Push angles and cells as bytes, as `shaders/nystrom8.wgsl` and `shaders/cells.wgsl` have them.

use super::Precision;
use super::asked::Part;
use super::base_point::{Packed, packed};
use super::bytes::{Scalar, bytes, halves};
use crate::engine::{CellDifference, Outcome, Question};
use crate::plan::STATE_CHANNELS;
use bytemuck::{Pod, Zeroable};

/// What buffers hold, for shaders of one precision.
#[derive(Debug)]
pub struct BufferLayout {
    /// Bytes of a push angle.
    pub push: usize,
    /// Bytes of a cell.
    pub cell: usize,
    /// Push angles to bytes.
    pub pushes: fn(&[f64]) -> Vec<u8>,
    /// A part of a question to bytes, with room for so many steps: [`packed`].
    pub packed: fn(&Question, Part, usize) -> Packed,
    /// Cells from bytes, appended.
    pub cells: fn(&[u8], &mut Vec<CellDifference>),
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
            cells: |bytes, cells| {
                let each = bytes.chunks_exact(size_of::<GpuCell>());
                cells.extend(each.map(|cell| {
                    CellDifference::from(bytemuck::pod_read_unaligned::<GpuCell>(cell))
                }));
            },
        }
    }
}

/// The codes that the shaders write, from 0. A kernel that writes nothing leaves zeros, which are no solution.
pub const OUTCOMES: [(&str, Outcome); 5] = [
    ("NOT_FINITE", Outcome::NotFinite),
    ("SOLVED", Outcome::Solved),
    ("NEAR_EDGE", Outcome::NearEdge),
    ("FAR", Outcome::Far),
    ("MISSED", Outcome::Missed),
];

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct GpuCell {
    numbers: [f32; STATE_CHANNELS.len()],
    residual: f32,
    outcome: u32,
    /// Shaders write four numbers at a time.
    unused: u32,
}

impl From<GpuCell> for CellDifference {
    // Whatever the shader says, a number that is not finite is not a solution.
    fn from(cell: GpuCell) -> Self {
        let is_finite = cell.numbers.iter().all(|x| x.is_finite()) && cell.residual.is_finite();
        let outcome = OUTCOMES
            .get(cell.outcome as usize)
            .filter(|_| is_finite)
            .map_or(Outcome::NotFinite, |&(_, outcome)| outcome);
        Self {
            numbers: cell.numbers,
            residual: cell.residual,
            outcome,
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
            let mut cells = Vec::new();
            (BufferLayout::of(Precision::F32).cells)(bytemuck::bytes_of(&cell), &mut cells);
            assert_eq!(cells[0].outcome, outcome);
        }
    }
}
