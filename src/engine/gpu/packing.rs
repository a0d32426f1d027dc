//! Rows of batches as bytes for the shaders: push angles, and the expansions of rows around their ends.

use super::Precision;
use crate::engine::row::functions;
use crate::engine::{RowBatch, SideColumns};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use std::sync::Arc;
use whiskmap_mechanics::numerics::Real;
use whiskmap_mechanics::numerics::inverse::{TOGETHER, groups};

/// Number of shader invocations per workgroup; every device allows this many.
pub const WORKGROUP: u32 = 64;

/// Scalar type of the shaders: `f32` or `f64`.
pub trait Scalar: Real + Pod + Into<f64> + Send + Sync {}

impl<T: Real + Pod + Into<f64> + Send + Sync> Scalar for T {}

/// Returns `number` as the sum of two numbers `[high, low]`: rounded to the shaders' scalar, and the rounded remainder.
fn halves<T: Scalar>(number: f64) -> [T; 2] {
    let high = T::of(number);
    [high, T::of(number - high.into())]
}

/// Numbers of a run of cells, in the layout of the shaders' `Row`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
pub struct GpuRow<T> {
    /// Magnitude of the push angle at the end of the row as [`halves`], in radians.
    pub end: [T; 2],
    /// Argument of the expansions at the end.
    pub place: T,
    /// Distance of the pole, in whisker lengths.
    pub distance: T,
    /// The push angle left to the end is `slope left + curvature left^2` at the end and at first touch, where `left` is the argument left.
    pub slope: T,
    pub curvature: T,
    /// Bound on the residual of states of the row, in whisker lengths.
    pub residual: T,
    /// Contact coordinate `tau` at the end less `tau` at the tip.
    pub to_tip: T,
    /// Difference of `tau` within which a contact is at the tip, and the radius there, by which a residual is divided.
    pub tip_tie: T,
    pub tip_radius: T,
}

/// Rows of a batch as bytes for the shaders.
#[derive(Debug, Default)]
pub struct Packed {
    /// Number of packed cells.
    pub cells: usize,
    /// Runs of packed cells as ranges of the cells of the batch, in their order: `[run]`. A run is of neighbouring cells of a row before its end.
    pub runs: Vec<Range<usize>>,
    /// For each run, the indices of its first packed cell, of its first push angle, and of its first coefficients, and their number.
    pub heads: Vec<[u32; 4]>,
    /// Bytes of the numbers of each run: see `Row` in `shaders/cells.wgsl`.
    pub rows: Vec<u8>,
    /// Bytes of the coefficients of the runs: `[power][group][function]`, the values at the row's end first. Groups of four functions without one
    /// that is wanted are left out.
    pub terms: Vec<u8>,
    /// Bytes of the push angles of the columns of the rows: magnitudes as [`halves`], in radians.
    pub pushes: Vec<u8>,
}

impl Packed {
    /// Packs some `rows` of a batch for shaders of this precision.
    pub fn new(precision: Precision, batch: &RowBatch, rows: Range<usize>) -> Self {
        match precision {
            Precision::F32 => packed::<f32>(batch, rows, precision.near_touch()),
            Precision::F64 => packed::<f64>(batch, rows, precision.near_touch()),
        }
    }
}

fn packed<T: Scalar>(batch: &RowBatch, rows: Range<usize>, near_touch: f64) -> Packed {
    let mut packed = Packed::default();
    let groups: Vec<usize> = groups(&functions(batch.channels)).collect();
    let width = TOGETHER * groups.len();
    let mut terms: Vec<T> = Vec::new();
    let mut pushes: Vec<[T; 2]> = Vec::new();
    // Whiskers share their columns: for each, the index of the first push angle.
    let mut shared: Vec<(&Arc<SideColumns>, usize)> = Vec::new();
    for index in rows {
        let row = &batch.rows[index];
        let Some(Some(expansion)) = batch.expansions.get(index) else {
            continue;
        };
        let side = &batch.sides[row.side];
        let columns = &side.columns;
        let known = shared.iter().find(|(known, _)| Arc::ptr_eq(known, columns));
        let first_push = known.map_or(pushes.len(), |(_, first)| *first);
        if known.is_none() {
            shared.push((columns, first_push));
            pushes.extend(columns.pushes.iter().map(|push| halves(*push)));
        }
        let first = terms.len() / width;
        // Differences from the end, where the push angle may be flat, keep their digits in `f32`. The expansions are of the differences over the
        // difference of the argument.
        let end = expansion.inverse.end;
        let (at_end, quotient) = expansion.inverse.functions.quotient(end);
        let ([slope, ..], [mean, ..]) = (quotient.at(end), quotient.at(0.0));
        for numbers in std::iter::once(&at_end).chain(&quotient.coefficients) {
            let wanted = groups.iter().flat_map(|first| &numbers[*first..][..TOGETHER]);
            terms.extend(wanted.map(|number| T::of(*number)));
        }
        let [tip, tip_radius] = side.sheet.tip;
        let numbers = GpuRow {
            end: halves(at_end[0]),
            place: T::of(end),
            distance: T::of(side.sheet.rows[row.row].pole_distance),
            slope: T::of(slope),
            curvature: T::of((mean - slope) / end),
            residual: T::of(expansion.residual),
            to_tip: T::of(at_end[1] - tip),
            tip_tie: T::of(side.sheet.tip_tie()),
            tip_radius: T::of(tip_radius),
        };
        let mut from = row.first_cell;
        let before = row.columns_before(expansion.end_push, &columns.pushes);
        let near = near_touch * expansion.end_push;
        let first_column = columns.pushes.partition_point(|push| *push < near);
        for (range, columns) in row.columns.iter().zip(before) {
            let columns = columns.start.max(first_column)..columns.end;
            if columns.is_empty() {
                from += range.len();
                continue;
            }
            // A submission has fewer cells and coefficients, and a row fewer columns, than `u32` can count.
            packed.heads.push([
                packed.cells as u32,
                (first_push + columns.start) as u32,
                first as u32,
                (terms.len() / width - first) as u32,
            ]);
            packed.rows.extend_from_slice(bytemuck::bytes_of(&numbers));
            let start = from + columns.start - range.start;
            packed.runs.push(start..start + columns.len());
            packed.cells += columns.len();
            from += range.len();
        }
    }
    packed.pushes = bytemuck::cast_slice(&pushes).to_vec();
    packed.terms = bytemuck::cast_slice(&terms).to_vec();
    packed
}
