//! Cells as the shaders write them: one plane for each number of a cell.

use crate::classify::Outcome;
use crate::engine::{Cells, RowBatch};
use crate::plan::Channels;
use glam::DVec2;
use std::ops::Range;

/// Outcomes by the negative number that the shaders write in place of a residual. A kernel that writes nothing leaves zeros, which are no
/// solution.
pub const OUTCOMES: [(&str, f32, Outcome); 2] =
    [("NEAR_EDGE", -1.0, Outcome::NearEdge), ("MISSED", -2.0, Outcome::Missed)];

/// Returns the number of planes of a map with these `channels`: residuals, values of channels of a state, and for strains contact and load as two
/// numbers each.
fn planes(channels: Channels) -> usize {
    let states = channels.states().into_iter().filter(|is_wanted| *is_wanted);
    1 + states.count() + if channels.has_strain() { 4 } else { 0 }
}

/// Returns the bytes of a cell in all planes of a map with these `channels`.
pub fn cell_bytes(channels: Channels) -> usize {
    planes(channels) * size_of::<f32>()
}

/// The outcome of a cell with this `residual`; a cell with a number that is not finite is no solution.
fn outcome(residual: f32, is_finite: bool) -> Outcome {
    if residual > 0.0 && is_finite {
        return Outcome::Solved;
    }
    let mut coded = OUTCOMES.iter().filter(|(_, code, _)| *code == residual);
    coded.next().map_or(Outcome::NotFinite, |(.., outcome)| *outcome)
}

/// Writes the cells of some `runs` of `batch`, whose planes are in `bytes`, into `cells`.
pub fn read_cells(bytes: &[u8], batch: &RowBatch, runs: &[Range<usize>], cells: &mut Cells) {
    let size = bytes.len() / planes(batch.channels);
    let mut from = 0;
    for place in runs {
        let to = from + place.len() * size_of::<f32>();
        let mut parts = bytes.chunks_exact(size.max(1)).map(|plane| &plane[from..to]);
        let mut copy = |column: &mut [f32]| {
            if let Some(part) = parts.next() {
                bytemuck::cast_slice_mut(column).copy_from_slice(part);
            }
        };
        let residuals = &mut cells.residual[place.clone()];
        copy(residuals);
        let mut is_finite = residuals.iter().all(|residual| residual.is_finite());
        let columns = cells.values.iter_mut().filter_map(|column| column.get_mut(place.clone()));
        for column in columns {
            copy(column);
            is_finite &= column.iter().all(|value| value.is_finite());
        }
        if let Some(points) = cells.points.get_mut(place.clone()) {
            let mut numbers = [(); 4].map(|()| vec![0.0_f32; points.len()]);
            numbers.iter_mut().for_each(|part| copy(part));
            for (i, point) in points.iter_mut().enumerate() {
                let [tau, tau_rest, load, load_rest] =
                    numbers.each_ref().map(|part| f64::from(part[i]));
                *point = DVec2::new(tau + tau_rest, load + load_rest);
                is_finite &= point.is_finite();
            }
        }
        for index in place.clone() {
            let residual = cells.residual[index];
            let values = cells.values.iter().filter_map(|column| column.get(index));
            let is_finite = is_finite
                || residual.is_finite()
                    && values.into_iter().all(|value| value.is_finite())
                    && cells.points.get(index).is_none_or(|point| point.is_finite());
            let outcome = outcome(residual, is_finite);
            cells.outcome[index] = outcome;
            if outcome != Outcome::Solved {
                cells.residual[index] = f32::NAN;
            }
        }
        from = to;
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::engine::gpu::Precision;
    use crate::engine::gpu::packing::{GpuRow, Scalar};
    use crate::engine::gpu::shaders;
    use naga::TypeInner;
    use std::mem::offset_of;

    fn agrees<T: Scalar>(precision: Precision) {
        let module = naga::front::wgsl::parse_str(&shaders::cells(precision)).unwrap();
        let is_row = |found: &&naga::Type| found.name.as_deref() == Some("Row");
        let row = module.types.iter().map(|(_, found)| found).find(is_row);
        let Some(TypeInner::Struct { members, span }) = row.map(|found| &found.inner) else {
            panic!("no struct Row");
        };
        let offsets =
            members.iter().map(|member| (member.name.as_deref().unwrap(), member.offset as usize));
        macro_rules! offsets {
            ($($member:ident)+) => { [$((stringify!($member), offset_of!(GpuRow<T>, $member))),+] };
        }
        let wanted =
            offsets!(end place distance slope curvature residual to_tip tip_tie tip_radius);
        assert!(offsets.eq(wanted));
        assert_eq!(*span as usize, size_of::<GpuRow<T>>());
    }

    #[test]
    fn shaders_and_rust_agree_on_every_offset() {
        agrees::<f32>(Precision::F32);
        agrees::<f64>(Precision::F64);
    }

    #[test]
    fn a_cell_that_is_not_finite_or_not_written_is_no_solution() {
        for (residual, is_finite, wanted) in [
            (1e-8, true, Outcome::Solved),
            (1e-8, false, Outcome::NotFinite),
            (f32::NAN, false, Outcome::NotFinite),
            (0.0, true, Outcome::NotFinite),
            (-9.0, true, Outcome::NotFinite),
            (-1.0, true, Outcome::NearEdge),
            (-2.0, false, Outcome::Missed),
        ] {
            assert_eq!(outcome(residual, is_finite), wanted);
        }
    }
}
